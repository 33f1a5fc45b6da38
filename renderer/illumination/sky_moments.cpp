// SPDX-License-Identifier: MIT
#include "renderer/illumination/sky_moments.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "lut/multiple_scattering/spherical_harmonics.h"

namespace alpenglow::renderer {
namespace {

// Returns the integrals of Y_l0 over the lower half of the sphere.
Moments OverLowerHalf(int degree) {
  Moments sum{};
  const GaussRule& rule = GaussLegendre(8);
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    const Moments at = LegendreTerms(degree, -static_cast<float>(rule.node[i]));
    for (int l = 0; l <= degree; ++l) {
      sum[MomentIndex(l, 0)] +=
          static_cast<float>(2.0 * kPi * rule.weight[i]) * at[MomentIndex(l, 0)];
    }
  }
  return sum;
}

}  // namespace

SkyMoments::SkyMoments(const MultipleScattering& multiple_scattering, const glm::dvec3& up,
                       const glm::dvec3& to_light, std::vector<double> altitudes_m)
    : up_(up),
      to_light_(to_light),
      mu_s_(std::clamp(glm::dot(up, to_light), -1.0, 1.0)),
      degree_(multiple_scattering.options().degree),
      bands_(multiple_scattering.bands()),
      altitudes_m_(std::move(altitudes_m)) {
  const double top = multiple_scattering.medium().atmosphere_height_m;
  for (const double altitude : altitudes_m_) {
    values_.push_back(multiple_scattering.ValuesAt(std::sqrt(std::clamp(altitude / top, 0.0, 1.0)),
                                                   MultipleScattering::SunCoordinate(mu_s_)));
  }
}

SkyMoments SkyMoments::WithoutGround(const Spectrum& radiance) const {
  SkyMoments less = *this;
  const Moments half = OverLowerHalf(degree_);
  for (std::vector<float>& values : less.values_) {
    for (int l = 0; l <= degree_; ++l) {
      for (std::size_t band = 0; band < bands_; ++band) {
        values[MomentIndex(l, 0) * bands_ + band] -= half[MomentIndex(l, 0)] * radiance[band];
      }
    }
  }
  return less;
}

std::vector<Spectrum> SkyMoments::Towards(const glm::dvec3& look,
                                          const std::vector<double>& chi) const {
  const auto mu = static_cast<float>(std::clamp(glm::dot(look, up_), -1.0, 1.0));
  const auto nu = static_cast<float>(std::clamp(glm::dot(look, to_light_), -1.0, 1.0));
  Moments factor =
      SphericalHarmonics(degree_, mu, AzimuthCosine(mu, static_cast<float>(mu_s_), nu));
  for (int l = 0; l <= degree_; ++l) {
    for (int m = 0; m <= l; ++m) {
      factor[MomentIndex(l, m)] *= static_cast<float>(chi[static_cast<std::size_t>(l)]);
    }
  }
  std::vector<Spectrum> light;
  for (const std::vector<float>& values : values_) {
    Spectrum& sum = light.emplace_back(bands_);
    for (std::size_t i = 0; i < MomentCount(degree_); ++i) {
      for (std::size_t band = 0; band < bands_; ++band) {
        sum[band] += factor[i] * values[i * bands_ + band];
      }
    }
    for (std::size_t band = 0; band < bands_; ++band) sum[band] = std::max(sum[band], 0.0F);
  }
  return light;
}

Spectrum SkyMoments::At(const std::vector<Spectrum>& of_altitudes, double altitude_m) const {
  const auto above = std::upper_bound(altitudes_m_.begin(), altitudes_m_.end(), altitude_m);
  if (above == altitudes_m_.begin()) return of_altitudes.front();
  if (above == altitudes_m_.end()) return of_altitudes.back();
  const auto high = static_cast<std::size_t>(above - altitudes_m_.begin());
  const double share =
      (altitude_m - altitudes_m_[high - 1]) / (altitudes_m_[high] - altitudes_m_[high - 1]);
  return static_cast<float>(1.0 - share) * of_altitudes[high - 1] +
         static_cast<float>(share) * of_altitudes[high];
}

}  // namespace alpenglow::renderer
