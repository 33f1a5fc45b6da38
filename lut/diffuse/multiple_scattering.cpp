// SPDX-License-Identifier: MIT
#include "lut/diffuse/multiple_scattering.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "atmosphere/text/error.h"
#include "lut/diffuse/diffuse_grid.h"
#include "lut/diffuse/successive_orders.h"
#include "lut/table/cubic_taps.h"

namespace alpenglow {

const SunAxis& DiffuseLight::SunNodes() {
  static const SunAxis axis(-0.05, 0.10, -0.55);
  return axis;
}

double DiffuseLight::SunCoordinate(double mu_s) {
  return std::clamp(SunNodes().Coordinate(mu_s), 0.0, 1.0);
}

double DiffuseLight::MuSFromCoordinate(double v) { return SunNodes().MuS(v); }

namespace {

// What the solver and the look-ups take for granted.
const Medium& Checked(const Medium& medium, const DiffuseLightOptions& options) {
  RequireInRange(options.altitudes, 4, 1024, "altitudes");
  RequireInRange(options.sun_angles, 4, 1024, "sun_angles");
  RequireInRange(options.degree, 2, kMaxDegree, "degree");
  RequireInRange(options.azimuth_nodes, 1, static_cast<double>(kMostAzimuths), "azimuth_nodes");
  RequireInRange(options.exact_orders.value_or(1), 1, 1000, "exact_orders");
  Validate(medium);
  if (medium.wavelengths_nm.size() > kMaxBands) {
    throw InputError(
        fmt::format("spectrum.wavelengths_nm has {} values; diffuse light is kept for at most {}",
                    medium.wavelengths_nm.size(), kMaxBands));
  }
  return medium;
}

}  // namespace

DiffuseLight::DiffuseLight(const Medium& medium, const DiffuseLightOptions& options)
    : DiffuseLight(medium, options, SolveSuccessiveOrders(Checked(medium, options), options)) {}

DiffuseLight::DiffuseLight(const Medium& medium, const DiffuseLightOptions& options,
                           SolvedOrders solved)
    : medium_(Checked(medium, options)),
      options_(options),
      bands_(medium.wavelengths_nm.size()),
      orders_(solved.orders),
      converged_(solved.converged),
      values_(std::move(solved.values)) {
  moments_ = MomentCount(options.degree);
  const std::size_t expected = static_cast<std::size_t>(options.altitudes) *
                               static_cast<std::size_t>(options.sun_angles) * channels() * bands_;
  if (values_.size() != expected) {
    throw InputError(
        fmt::format("diffuse light: {} values; its options need {}", values_.size(), expected));
  }
  for (const float value : values_) {
    if (!std::isfinite(value)) throw InputError("diffuse light: a value is not finite");
  }
  grid_ = GridOf(medium_, options_);
  blocks_ = BlocksOf();
  packed_ = Packed();
  packed_sky_ = PackedSky();
}

std::vector<DiffuseBlock> DiffuseLight::BlocksOf() const {
  const AirConstants<float> air = AirIntegrator<float>(medium_).constants();
  const std::vector<double> chi = MieLegendreCoefficients(medium_, options_.degree);
  std::vector<DiffuseBlock> blocks((bands_ + kBlockBands - 1) / kBlockBands);
  for (std::size_t band = 0; band < bands_; ++band) {
    DiffuseBlock& block = blocks[band / kBlockBands];
    const std::size_t lane = band % kBlockBands;
    block.rayleigh[lane] = air.rayleigh[band];
    block.mie_scattering[lane] = air.mie_scattering[band];
    block.mie_extinction[lane] = air.mie_extinction[band];
    block.ozone[lane] = air.ozone[band];
    for (std::size_t l = 0; l <= grid_.degree; ++l)
      block.chi[l][lane] = static_cast<float>(chi[l * bands_ + band]);
  }
  return blocks;
}

AlignedFloats DiffuseLight::Packed() const {
  const std::size_t nodes = grid_.altitudes * grid_.suns;
  const std::size_t stride = kPackedRow[grid_.degree + 1] * 8;
  const std::vector<float> twilight = TwilightAtNodes(grid_);
  AlignedFloats packed(blocks_.size() * nodes * stride);
  for (std::size_t node = 0; node < nodes; ++node) {
    const float* value = &values_[node * channels() * bands_];
    for (std::size_t l = 0; l <= grid_.degree; ++l) {
      for (std::size_t m = 0; m <= l; ++m) {
        for (std::size_t band = 0; band < bands_; ++band, ++value) {
          packed.data()[(band / kBlockBands * nodes + node) * stride + PackedIndex(l, m) +
                        band % kBlockBands] = *value / twilight[node % grid_.suns];
        }
      }
    }
  }
  return packed;
}

std::vector<float> DiffuseLight::PackedSky() const {
  const std::size_t nodes = grid_.altitudes * grid_.suns;
  const std::vector<float> twilight = TwilightAtNodes(grid_);
  std::vector<float> packed(blocks_.size() * nodes * kBlockBands);
  for (std::size_t node = 0; node < nodes; ++node) {
    for (std::size_t band = 0; band < bands_; ++band) {
      packed[(band / kBlockBands * nodes + node) * kBlockBands + band % kBlockBands] =
          values_[(node * channels() + moments_) * bands_ + band] / twilight[node % grid_.suns];
    }
  }
  return packed;
}

double DiffuseLight::AltitudeCoordinate(double altitude_m) const {
  return std::sqrt(std::clamp(altitude_m / medium_.atmosphere_height_m, 0.0, 1.0));
}

template <typename Visit>
void DiffuseLight::VisitNodes(double altitude_coordinate, double mu_s, const Visit& visit) const {
  const CubicTaps row = TapsAt(altitude_coordinate, options_.altitudes);
  const CubicTaps column = SunTaps(grid_, mu_s);
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t s = 0; s < 4; ++s) {
      const float weight = row.weight[a] * column.weight[s];
      if (weight != 0.0F)
        visit(&values_[(row.node[a] * grid_.suns + column.node[s]) * channels() * bands_], weight);
    }
  }
}

Bands<float> DiffuseLight::InscatterAlong(const RaySamples<float>& samples, double nu) const {
  alignas(64) std::array<float, kMaxBands + kBlockBands> light{};
  Kernel<DiffuseKernel>().inscatter(grid_, samples, static_cast<float>(nu), blocks_.data(),
                                    blocks_.size(), packed_.data(), light.data());
  Bands<float> sum(bands_);
  std::copy_n(light.begin(), bands_, sum.value.begin());
  return sum;
}

Bands<float> DiffuseLight::Irradiance(double altitude_m, double mu_s, double normal_mu,
                                      double normal_cos_azimuth) const {
  const CubicTaps row = TapsAt(AltitudeCoordinate(altitude_m), options_.altitudes);
  const double x = (mu_s - SunNodes().centre()) / SunNodes().width();
  const double cell = (std::asinh(x) - static_cast<double>(grid_.first_asinh)) *
                      static_cast<double>(grid_.cells_a_unit);
  const CubicTaps column = TapsAt(cell / (options_.sun_angles - 1), options_.sun_angles);
  const float twilight = TwilightOf(grid_, mu_s);
  SurfacePoint point{{}, {}, static_cast<float>(normal_mu), static_cast<float>(normal_cos_azimuth)};
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t s = 0; s < 4; ++s) {
      point.node[4 * a + s] = static_cast<std::uint32_t>(row.node[a] * grid_.suns + column.node[s]);
      point.weight[4 * a + s] = twilight * row.weight[a] * column.weight[s];
    }
  }
  alignas(64) std::array<float, kMaxBands + kBlockBands> light{};
  Kernel<DiffuseKernel>().irradiance(grid_, point, blocks_.size(), packed_.data(),
                                     packed_sky_.data(), light.data());
  Bands<float> irradiance(bands_);
  std::copy_n(light.begin(), bands_, irradiance.value.begin());
  return irradiance;
}

Bands<float> DiffuseLight::SkyIrradiance(double altitude_m, double mu_s) const {
  Bands<float> irradiance(bands_);
  VisitNodes(AltitudeCoordinate(altitude_m), mu_s, [&](const float* node, float weight) {
    for (std::size_t band = 0; band < bands_; ++band)
      irradiance[band] += weight * node[moments_ * bands_ + band];
  });
  for (std::size_t band = 0; band < bands_; ++band)
    irradiance[band] = std::max(irradiance[band], 0.0F);
  return irradiance;
}

std::vector<float> DiffuseLight::ValuesAt(double altitude_coordinate, double sun_coordinate) const {
  std::vector<float> sum(channels() * bands_, 0.0F);
  VisitNodes(altitude_coordinate, MuSFromCoordinate(sun_coordinate),
             [&](const float* node, float weight) {
               for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += weight * node[i];
             });
  return sum;
}

}  // namespace alpenglow
