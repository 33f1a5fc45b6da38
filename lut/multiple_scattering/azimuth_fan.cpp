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
      scattering_(ScatteringMedium(light.medium(), light.options())),
      twilight_(TwilightAtNodes(light.grid())) {
  if (const std::size_t bands = light.bands(); stride_ != bands) {
    const std::vector<float>& values = light.smooth();
    padded_.resize(values.size() / bands * stride_);
    for (std::size_t i = 0; i < values.size(); ++i)
      padded_[i / bands * stride_ + i % bands] = values[i];
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
  return padded_.empty() ? light_.smooth().data() : padded_.data();
}

// Returns the light that each moment and component of the tensor at a sample sends to the eye, in
// four bands. If the medium has fewer bands left, the remaining lanes repeat its last band.
AzimuthFan::Factors AzimuthFan::FactorsAt(const RaySamples<float>& samples, std::size_t s,
                                          std::size_t first_band) const {
  const Medium& medium = scattering_.medium;
  const std::size_t bands = light_.bands();
  const auto orders = static_cast<std::size_t>(light_.options().degree) + 1;
  const Moments legendre = LegendreTerms(light_.options().degree, samples.mu[s]);
  Factors factors;
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
      const float rayleigh_chi = l == 0 ? 1.0F : l == 2 && !medium.polarised ? chi2 : 0.0F;
      const float source = molecules * rayleigh_chi +
                           aerosol * static_cast<float>(scattering_.chi[l * bands + band]);
      for (std::size_t m = 0; m <= l; ++m) {
        const std::size_t i = l * (l + 1) / 2 + m;
        factors[i * kLanes + lane] = source * legendre[i];
      }
    }
    for (std::size_t m = 0; m < kTensorMoments; ++m) {
      factors[(MomentCount(light_.options().degree) + m) * kLanes + lane] =
          molecules * chi2 * legendre[MomentIndex(2, static_cast<int>(m))];
    }
  }
  return factors;
}

// Finds the light of a sample per cos(m phi) at a range of sun nodes, in the rows after the first;
// the first and the last row are those of a node beyond each end.
void AzimuthFan::FillRows(const RaySamples<float>& samples, std::size_t s, std::size_t first_band,
                          const SunRange& suns, float* rows) const {
  const MultipleScatteringOptions& options = light_.options();
  const std::size_t node_floats = light_.channels() * stride_;
  const std::size_t width = (static_cast<std::size_t>(options.degree) + 1) * kLanes;
  const auto low = static_cast<std::size_t>(suns.low);
  const double top_km = light_.medium().atmosphere_height_m / kMetresPerKilometre;
  const Factors factors = FactorsAt(samples, s, first_band);
  const CubicTaps taps = TapsAt(
      std::sqrt(std::clamp(double{samples.altitude[s]} / top_km, 0.0, 1.0)), options.altitudes);
  FanContraction contraction{};
  contraction.suns = static_cast<std::size_t>(suns.high - suns.low + 1);
  contraction.sun_stride = node_floats;
  contraction.moment_stride = stride_;
  contraction.degree = options.degree;
  contraction.tensor = light_.medium().polarised ? MomentCount(light_.options().degree) : 0;
  contraction.factors = factors.data();
  contraction.rows = rows + width;
  for (std::size_t a = 0; a < 4; ++a) {
    const std::size_t node = taps.node[a] * light_.grid().suns + low;
    contraction.weights[a] = taps.weight[a];
    contraction.nodes[a] = Values() + node * node_floats + first_band;
  }
  Kernel<AzimuthFanKernel>().contract(contraction);
  for (std::size_t sun = 0; sun < contraction.suns; ++sun) {
    float* row = contraction.rows + sun * width;
    for (std::size_t k = 0; k < width; ++k)
      row[k] /= twilight_[low + sun] * SinePowerOf(light_.grid(), k / kLanes, sun_sine_[low + sun]);
  }
  float* after = rows + (contraction.suns + 1) * width;
  for (std::size_t k = 0; k < width; ++k) {
    rows[k] = shared::BeyondEnd<float>(rows[width + k], rows[2 * width + k], rows[3 * width + k]);
    after[k] = shared::BeyondEnd<float>((after - width)[k], (after - 2 * width)[k],
                                        (after - 3 * width)[k]);
  }
}

// Adds the light of four bands.
void AzimuthFan::AddBlock(const Line& line, std::size_t first_band, std::span<float> light) const {
  const int degree = light_.options().degree, last = light_.options().sun_angles - 1;
  const AzimuthFanKernel& kernel = Kernel<AzimuthFanKernel>();
  std::vector<float> rows((light_.grid().suns + 2) * static_cast<std::size_t>(degree + 1) * kLanes);
  for (std::size_t s = 0; s < line.samples.count; ++s) {
    const std::size_t first = s * line.directions;
    const float* position = &line.position[first];
    const auto [least, most] = std::minmax_element(position, position + line.directions);
    // Range of nodes that the taps read, at least four, before a node is added at each end.
    const int low = std::clamp(static_cast<int>(*least) - 1, 0, last - 3);
    const SunRange suns{low, std::clamp(static_cast<int>(*most) + 2, low + 3, last)};
    FillRows(line.samples, s, first_band, suns, rows.data());
    kernel.gather({line.directions, position, &line.twilight[first], &line.cosine[first],
                   line.sun_sine.empty() ? nullptr : &line.sun_sine[first], suns.low - 1,
                   suns.high - suns.low + 3, degree, rows.data(), light.data()});
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
