// SPDX-License-Identifier: MIT
#include "renderer/illumination/sky_irradiance_gradient.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "lut/sky/sky_view.h"

namespace alpenglow::renderer {
namespace {

// A coarse table of the sky is sufficient, because only means over half of the sky are computed
// from it.
constexpr SkyViewSize kCoarseSky{.sky_rows = 20, .ground_rows = 5, .azimuths = 9, .ray_nodes = 8};
constexpr std::size_t kSkyRows = 48;     // equal steps in the sine of the elevation
constexpr std::size_t kSkyColumns = 24;  // over half a turn from the azimuth of the sun

/// A part of the sky on one side of the sun, and its mirror image on the other side.
struct SkyPart {
  glm::vec3 towards, mirrored;  // unit: towards the sun, to its side, upwards
  std::array<float, 4> light;   // radiance times solid angle
};

std::vector<SkyPart> PartsOf(const SkyView& sky) {
  constexpr auto kSolidAngle = static_cast<float>(kPi / (kSkyRows * kSkyColumns));
  std::vector<double> azimuths;
  for (std::size_t i = 0; i < kSkyColumns; ++i)
    azimuths.push_back(kPi * (static_cast<double>(i) + 0.5) / kSkyColumns);
  const SkyAzimuths columns(sky, azimuths);
  std::vector<float> radiance(kSkyColumns * sky.stride());
  std::vector<SkyPart> parts;
  for (std::size_t row = 0; row < kSkyRows; ++row) {
    const double z = (static_cast<double>(row) + 0.5) / kSkyRows, flat = std::sqrt(1.0 - z * z);
    sky.FillRow(std::acos(z), columns, radiance);
    for (std::size_t column = 0; column < kSkyColumns; ++column) {
      const double x = flat * std::cos(azimuths[column]), y = flat * std::sin(azimuths[column]);
      SkyPart part{{x, y, z}, {x, -y, z}, {}};
      for (std::size_t band = 0; band < sky.bands(); ++band)
        part.light[band] = kSolidAngle * radiance[column * sky.stride() + band];
      parts.push_back(part);
    }
  }
  return parts;
}

std::array<float, 4> IrradianceOn(const std::vector<SkyPart>& parts, const glm::vec3& normal) {
  std::array<float, 4> sum{};
  for (const SkyPart& part : parts) {
    const float falls = std::max(glm::dot(normal, part.towards), 0.0F) +
                        std::max(glm::dot(normal, part.mirrored), 0.0F);
    for (std::size_t band = 0; band < sum.size(); ++band) sum[band] += falls * part.light[band];
  }
  return sum;
}

// Returns the irradiance on the slope with these components of the normal. Beyond all slopes it
// extrapolates the trend at the rim.
std::array<float, 4> NodeAt(const std::vector<SkyPart>& parts, float sunward, float up) {
  const float radius = std::hypot(sunward, up);
  const auto at = [&](float share) {
    const float x = share * sunward, z = share * up;
    return IrradianceOn(parts, {x, std::sqrt(std::max(1.0F - x * x - z * z, 0.0F)), z});
  };
  if (radius <= 1.0F) return at(1.0F);
  constexpr float kInside = 0.9F, kLeast = 0.1F;
  const std::array<float, 4> rim = at(1.0F / radius), inside = at(kInside / radius);
  std::array<float, 4> beyond{};
  for (std::size_t band = 0; band < beyond.size(); ++band)
    beyond[band] =
        std::max(rim[band] + (radius - 1.0F) / (1.0F - kInside) * (rim[band] - inside[band]),
                 kLeast * rim[band]);
  return beyond;
}

}  // namespace

SkyIrradianceGradient::SkyIrradianceGradient(const SingleScattering<float>& air,
                                             const MultipleScattering& multiple_scattering,
                                             double altitude_m, double mu_s) {
  ALPENGLOW_ENSURE(air.bands(), <=, std::size_t{4});
  const std::vector<SkyPart> parts =
      PartsOf(SkyView(air, multiple_scattering, altitude_m, mu_s, kCoarseSky));
  for (std::size_t row = 0; row < kRows; ++row) {
    for (std::size_t column = 0; column < kColumns; ++column) {
      const float sunward = static_cast<float>(column) / 4.0F - 1.0F;
      nodes[row * kColumns + column] = NodeAt(parts, sunward, static_cast<float>(row) / 4.0F);
    }
  }
}

std::array<float, 4> SkyIrradianceGradient::On(double n_up, double n_sunward) const {
  const auto u = static_cast<float>(shared::UnoccludedSkyColumn(n_sunward));
  const auto v = static_cast<float>(shared::UnoccludedSkyRow(n_up));
  const auto column = std::min(static_cast<std::size_t>(u), kColumns - 2);
  const auto row = std::min(static_cast<std::size_t>(v), kRows - 2);
  const float right = u - static_cast<float>(column), above = v - static_cast<float>(row);
  const auto* low = &nodes[row * kColumns + column];
  const auto* high = low + kColumns;
  std::array<float, 4> light{};
  for (std::size_t band = 0; band < light.size(); ++band)
    light[band] = std::lerp(std::lerp(low[0][band], low[1][band], right),
                            std::lerp(high[0][band], high[1][band], right), above);
  return light;
}

}  // namespace alpenglow::renderer
