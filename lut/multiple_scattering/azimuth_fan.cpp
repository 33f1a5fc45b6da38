// SPDX-License-Identifier: MIT
#include "lut/multiple_scattering/azimuth_fan.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "atmosphere/math/constants.h"
#include "lut/multiple_scattering/azimuth_fan_kernel.h"
#include "lut/multiple_scattering/moment_grid.h"
#include "lut/multiple_scattering/spherical_harmonics.h"
#include "lut/tables/table_axes.h"

namespace alpenglow::lut {
namespace {

constexpr std::size_t kLanes = 4;
constexpr int kTableCells = 4096;

}  // namespace

/// Arguments of a call, and the position of the sun at every sample for every azimuth.
struct AzimuthFan::Line {
  const RaySamples<float>& samples;
  std::size_t directions;
  // Index: [sample * directions + direction]. `sun_sine`, the sine of the sun's zenith angle, is
  // filled for polarised light only.
  std::vector<float> position, twilight, cosine, sun_sine;
};

AzimuthFan::AzimuthFan(const MultipleScattering& light)
    : light_(light),
      stride_((light.bands() + kLanes - 1) / kLanes * kLanes),
      chi_mie_(MieLegendreCoefficients(light.medium(), light.options().degree)),
      twilight_(TwilightAtNodes(light.grid())) {
  if (const std::size_t bands = light.bands(); stride_ != bands) {
    padded_.resize(light.values().size() / bands * stride_);
    for (std::size_t i = 0; i < light.values().size(); ++i)
      padded_[i / bands * stride_ + i % bands] = light.values()[i];
  }
  for (int i = 0; i <= kTableCells; ++i) {
    const double mu_s = 2.0 * i / kTableCells - 1.0;
    position_of_mu_s_.push_back(static_cast<float>(MultipleScattering::SunCoordinate(mu_s) *
                                                   (light.options().sun_angles - 1)));
    twilight_of_mu_s_.push_back(TwilightOf(light.grid(), mu_s));
  }
  for (std::size_t sun = 0; sun < light.grid().suns; ++sun)
    sun_sine_.push_back(SunSine(MuSOfNode(light.grid(), sun)));
}

const float* AzimuthFan::Values() const {
  return padded_.empty() ? light_.values().data() : padded_.data();
}

// Adds the light of four bands. If the medium has fewer bands left, the remaining lanes repeat its
// last band.
void AzimuthFan::AddBlock(const Line& line, std::size_t first_band, std::span<float> light) const {
  const Medium& medium = light_.medium();
  const MultipleScatteringOptions& options = light_.options();
  const RaySamples<float>& samples = line.samples;
  const std::size_t bands = light_.bands();
  const bool polarised = medium.polarised;
  const std::size_t node_floats = light_.channels() * stride_;
  const auto suns = static_cast<std::size_t>(options.sun_angles);
  const auto orders = static_cast<std::size_t>(options.degree) + 1;
  const double top_km = medium.atmosphere_height_m / kMetresPerKilometre;
  const AzimuthFanKernel& kernel = Kernel<AzimuthFanKernel>();
  std::vector<float> rows((suns + 2) * orders * kLanes);
  for (std::size_t s = 0; s < samples.count; ++s) {
    const float* position = &line.position[s * line.directions];
    const auto [least, most] = std::minmax_element(position, position + line.directions);
    // Range of nodes that the taps read, at least four. Node -1 and the node after the last one are
    // added below.
    const int low = std::clamp(static_cast<int>(*least) - 1, 0, options.sun_angles - 4);
    const int high = std::clamp(static_cast<int>(*most) + 2, low + 3, options.sun_angles - 1);

    std::array<float, (kMaxMoments + kTensorMoments) * kLanes> factors;
    const Moments legendre = LegendreTerms(options.degree, samples.mu[s]);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::size_t band = std::min(first_band + lane, bands - 1);
      const auto per_km = [band](const std::vector<double>& per_m) {
        return static_cast<float>(per_m[band] * kMetresPerKilometre);
      };
      const float rayleigh = per_km(medium.rayleigh_scattering_per_m);
      const float tau = rayleigh * samples.view_rayleigh[s] +
                        per_km(medium.mie_extinction_per_m) * samples.view_mie[s] +
                        per_km(medium.ozone_absorption_per_m) * samples.view_ozone[s];
      const float seen = samples.weight[s] * std::exp(-tau);
      const float molecules = seen * rayleigh * samples.rayleigh_density[s];
      const float aerosol = seen * per_km(medium.mie_scattering_per_m) * samples.mie_density[s];
      const float chi2 = RayleighChi2(medium, band);
      for (std::size_t l = 0; l < orders; ++l) {
        const float rayleigh_chi = l == 0 ? 1.0F : l == 2 && !polarised ? chi2 : 0.0F;
        const float source =
            molecules * rayleigh_chi + aerosol * static_cast<float>(chi_mie_[l * bands + band]);
        for (std::size_t m = 0; m <= l; ++m) {
          const std::size_t i = l * (l + 1) / 2 + m;
          factors[i * kLanes + lane] = source * legendre[i];
        }
      }
      for (std::size_t m = 0; m < kTensorMoments; ++m) {
        factors[(light_.moments() + m) * kLanes + lane] =
            molecules * chi2 * legendre[MomentIndex(2, static_cast<int>(m))];
      }
    }

    const CubicTaps taps = TapsAt(
        std::sqrt(std::clamp(double{samples.altitude[s]} / top_km, 0.0, 1.0)), options.altitudes);
    FanContraction contraction{};
    contraction.suns = static_cast<std::size_t>(high - low + 1);
    contraction.sun_stride = node_floats;
    contraction.moment_stride = stride_;
    contraction.degree = options.degree;
    contraction.tensor = polarised ? light_.moments() : 0;
    contraction.factors = factors.data();
    contraction.rows = &rows[orders * kLanes];
    for (std::size_t a = 0; a < 4; ++a) {
      contraction.weights[a] = taps.weight[a];
      contraction.nodes[a] = Values() +
                             (taps.node[a] * suns + static_cast<std::size_t>(low)) * node_floats +
                             first_band;
    }
    kernel.contract(contraction);
    for (std::size_t sun = 0; sun < contraction.suns; ++sun) {
      const float twilight = twilight_[static_cast<std::size_t>(low) + sun];
      const float sine = sun_sine_[static_cast<std::size_t>(low) + sun];
      float* row = contraction.rows + sun * orders * kLanes;
      for (std::size_t k = 0; k < orders * kLanes; ++k)
        row[k] /= twilight * SinePowerOf(light_.grid(), k / kLanes, sine);
    }

    const std::size_t width = orders * kLanes;
    float* before = rows.data();
    float* after = &rows[(contraction.suns + 1) * width];
    for (std::size_t k = 0; k < width; ++k) {
      before[k] =
          shared::BeyondEnd<float>(before[width + k], before[2 * width + k], before[3 * width + k]);
      after[k] = shared::BeyondEnd<float>((after - width)[k], (after - 2 * width)[k],
                                          (after - 3 * width)[k]);
    }
    kernel.gather({line.directions, position, &line.twilight[s * line.directions],
                   &line.cosine[s * line.directions],
                   polarised ? &line.sun_sine[s * line.directions] : nullptr, low - 1,
                   high - low + 3, options.degree, rows.data(), light.data()});
  }
}

std::vector<float> AzimuthFan::InscatterAlong(const RaySamples<float>& samples, const ViewRay& ray,
                                              std::span<const float> nus) const {
  const AzimuthFanKernel& kernel = Kernel<AzimuthFanKernel>();
  Line line{samples,
            nus.size(),
            std::vector<float>(samples.count * nus.size()),
            std::vector<float>(samples.count * nus.size()),
            std::vector<float>(samples.count * nus.size()),
            std::vector<float>(light_.medium().polarised ? samples.count * nus.size() : 0)};
  const double radius_km = light_.medium().planet_radius_m / kMetresPerKilometre;
  const double observer_km = radius_km + std::max(ray.altitude_m, 0.0) / kMetresPerKilometre;
  for (std::size_t s = 0; s < samples.count; ++s) {
    const double distance_km =
        samples.extent.begin_m / kMetresPerKilometre + double{samples.distance[s]};
    kernel.find_suns({nus.size(), nus.data(), static_cast<float>(observer_km * ray.mu_s),
                      static_cast<float>(distance_km),
                      static_cast<float>(1.0 / (radius_km + double{samples.altitude[s]})),
                      samples.mu[s], position_of_mu_s_.data(), twilight_of_mu_s_.data(),
                      static_cast<float>(kTableCells), &line.position[s * nus.size()],
                      &line.twilight[s * nus.size()], &line.cosine[s * nus.size()],
                      line.sun_sine.empty() ? nullptr : &line.sun_sine[s * nus.size()]});
  }
  const std::size_t bands = light_.bands();
  std::vector<float> all(nus.size() * bands);
  std::vector<float> block;
  for (std::size_t band = 0; band < bands; band += kLanes) {
    const std::size_t lanes = std::min(kLanes, bands - band);
    block.assign(kLanes * nus.size(), 0.0F);
    AddBlock(line, band, block);
    for (std::size_t k = 0; k < nus.size(); ++k)
      std::copy_n(&block[kLanes * k], lanes, &all[k * bands + band]);
  }
  return all;
}

}  // namespace alpenglow::lut
