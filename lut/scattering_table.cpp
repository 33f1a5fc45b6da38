// SPDX-License-Identifier: MIT
#include "lut/scattering_table.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "atmosphere/error.h"
#include "lut/program.h"
#include "lut/scattering_map.h"
#include "lut/table_size.h"

namespace alpenglow {
namespace {

constexpr double kMetresPerKilometre = 1000.0;

// Of the texels: errors of the integral stay far below those of the interpolation.
constexpr Sampling kTexelSampling{.nodes = 16, .split_ozone = true, .dark_samples = false};

// Keeps rays that graze the ground on their side of it: a thousand roundings, a millimetre of
// perigee at most.
constexpr double kHorizonMargin = 1e-13;

std::size_t RequireSize(const Medium& medium, const ScatteringTableSize& size) {
  Validate(medium);
  if (size.mu % 2 != 0) {
    throw InputError(fmt::format(
        "single scattering table: axis mu has {} texels; it must have an even number", size.mu));
  }
  const std::uint64_t bytes = RequireTableSize(
      "single scattering",
      {{"nu", size.nu, 2}, {"mu_s", size.mu_s, 2}, {"mu", size.mu, 4}, {"r", size.altitudes, 2}},
      2 * medium.wavelengths_nm.size(), medium);
  return static_cast<std::size_t>(bytes) / sizeof(float);
}

double RequireLowestSun(const Medium& medium, const std::optional<double>& lowest_mu_s) {
  return RequireInRange(lowest_mu_s.value_or(LowestUsefulSun(medium)), -1.0, -1e-3,
                        "zenith cosine of the lowest sun of the table");
}

constexpr double kNoLength_km = 1e-9;

double UnitOf(std::size_t index, std::size_t texels) {
  return static_cast<double>(index) / static_cast<double>(texels - 1);
}

}  // namespace

double LowestUsefulSun(const Medium& medium) {
  const double dip =
      std::asin(-shared::HorizonCosine<double>(medium.atmosphere_height_m, medium.planet_radius_m));
  return -std::sin(std::min(3.0 * dip, std::asin(1.0)));
}

ScatteringTable::ScatteringTable(const Medium& medium, const ScatteringTableOptions& options,
                                 Progress* progress)
    : air_(medium),
      size_(options.size),
      lowest_mu_s_(RequireLowestSun(medium, options.lowest_mu_s)),
      radius_km_(medium.planet_radius_m / kMetresPerKilometre),
      top_km_(medium.atmosphere_height_m / kMetresPerKilometre),
      texels_(RequireSize(medium, options.size)) {
  tbb::parallel_for(std::size_t{0}, Rows(size_), [&](std::size_t row) {
    if (Interrupted()) return;
    FillRow(row);
    if (progress != nullptr) progress->Advance();
  });
  ThrowIfInterrupted();
}

ScatteringTable::ScatteringTable(const Medium& medium, const ScatteringTableOptions& options,
                                 std::vector<float> texels)
    : air_(medium),
      size_(options.size),
      lowest_mu_s_(RequireLowestSun(medium, options.lowest_mu_s)),
      radius_km_(medium.planet_radius_m / kMetresPerKilometre),
      top_km_(medium.atmosphere_height_m / kMetresPerKilometre),
      texels_(std::move(texels)) {
  if (const std::size_t expected = RequireSize(medium, size_); texels_.size() != expected) {
    throw InputError(fmt::format("single scattering table: {} values; its size needs {}",
                                 texels_.size(), expected));
  }
  for (const float value : texels_) RequireInRange(value, 0.0, 1.0, "single scattering texel");
}

std::size_t ScatteringTable::IndexOf(std::size_t nu, std::size_t mu_s, std::size_t mu,
                                     std::size_t altitude) const {
  const std::size_t texel = ((altitude * size_.mu + mu) * size_.nu + nu) * size_.mu_s + mu_s;
  return texel * 2 * air_.bands();
}

ViewRay ScatteringTable::RayOfTexel(std::size_t nu, std::size_t mu_s, std::size_t mu,
                                    std::size_t altitude) const {
  using namespace shared;
  const std::size_t half = size_.mu / 2;
  const bool ground = mu < half;
  const double h = AltitudeFromUnit<double>(UnitOf(altitude, size_.altitudes), top_km_, radius_km_);
  const double unit = UnitOf(ground ? half - 1 - mu : mu - half, half);
  const double horizon = HorizonCosine<double>(h, radius_km_);
  ViewRay ray;
  ray.altitude_m = std::min(h * kMetresPerKilometre, medium().atmosphere_height_m);
  ray.mu =
      ground ? std::min(GroundCosineFromUnit<double>(unit, h, radius_km_), horizon - kHorizonMargin)
             : std::max(SkyCosineFromUnit<double>(unit, h, top_km_, radius_km_),
                        horizon + (h > 0.0 ? kHorizonMargin : 0.0));
  ray.mu_s = SunCosineFromUnit<double>(UnitOf(mu_s, size_.mu_s), lowest_mu_s_, top_km_, radius_km_);
  ray.nu = std::clamp(PossibleScatteringCosine<double>(
                          ScatteringCosineFromUnit<double>(UnitOf(nu, size_.nu)), ray.mu, ray.mu_s),
                      -1.0, 1.0);
  return ray;
}

void ScatteringTable::FillRow(std::size_t row) {
  const std::size_t altitude = row / size_.mu;
  const std::size_t mu = row % size_.mu;
  const std::size_t bands = air_.bands();
  for (std::size_t nu = 0; nu < size_.nu; ++nu) {
    for (std::size_t mu_s = 0; mu_s < size_.mu_s; ++mu_s) {
      const ScatteredOnce<float> light =
          air_.Scatter(air_.Sample(RayOfTexel(nu, mu_s, mu, altitude), kTexelSampling));
      float* texel = &texels_[IndexOf(nu, mu_s, mu, altitude)];
      std::copy_n(light.rayleigh.value.begin(), bands, texel);
      std::copy_n(light.mie.value.begin(), bands, texel + bands);
    }
  }
}

ScatteredOnce<float> ScatteringTable::Interpolate(const Start& start, double nu) const {
  using namespace shared;
  // Each half of the mu axis is an axis of its own; the lower one runs backwards.
  const std::size_t half = size_.mu / 2;
  const double mu_unit =
      start.ground ? UnitFromGroundCosine<double>(start.altitude_km, start.mu, radius_km_)
                   : UnitFromSkyCosine<double>(start.altitude_km, start.mu, top_km_, radius_km_);
  const auto r = AxisPosition::FromUnit(
      UnitFromAltitude<double>(start.altitude_km, top_km_, radius_km_), size_.altitudes);
  const auto m = AxisPosition::FromUnit(mu_unit, half);
  const auto v = AxisPosition::FromUnit(UnitFromScatteringCosine<double>(nu), size_.nu);
  const auto s = AxisPosition::FromUnit(
      UnitFromSunCosine<double>(start.mu_s, lowest_mu_s_, top_km_, radius_km_), size_.mu_s);

  const LengthWeights lengths = WeightsByLength(start, mu_unit, r, m);
  const std::size_t bands = air_.bands();
  ScatteredOnce<float> light{Bands<float>(bands), Bands<float>(bands)};
  for (unsigned corner = 0; corner < 16; ++corner) {
    const std::size_t up_s = corner & 1U, up_v = corner >> 1U & 1U;
    const std::size_t up_m = corner >> 2U & 1U, up_r = corner >> 3U & 1U;
    const float weight = s.Weight(up_s) * v.Weight(up_v) * lengths[up_r][up_m];
    const std::size_t mu = start.ground ? half - 1 - (m.low + up_m) : half + m.low + up_m;
    const float* texel = &texels_[IndexOf(v.low + up_v, s.low + up_s, mu, r.low + up_r)];
    for (std::size_t band = 0; band < bands; ++band) {
      light.rayleigh[band] += weight * texel[band];
      light.mie[band] += weight * texel[bands + band];
    }
  }
  // Where a long ray speaks for a longer one, the sum may pass what light there is.
  for (std::size_t band = 0; band < bands; ++band) {
    light.rayleigh[band] = std::min(light.rayleigh[band], 1.0F);
    light.mie[band] = std::min(light.mie[band], 1.0F);
  }
  return light;
}

ScatteringTable::LengthWeights ScatteringTable::WeightsByLength(const Start& start, double mu_unit,
                                                                const AxisPosition& r,
                                                                const AxisPosition& m) const {
  using namespace shared;
  const auto length = [&](double h, double x) {
    return start.ground ? h + x * (HorizonDistance<double>(h, radius_km_) - h)
                        : top_km_ - h + x * SkyDistanceRange<double>(h, top_km_, radius_km_);
  };
  const double here = length(start.altitude_km, mu_unit);
  LengthWeights weights{};
  for (const std::size_t up_m : {0U, 1U}) {
    const double x = UnitOf(m.low + up_m, size_.mu / 2);
    std::array<double, 2> there{};
    for (const std::size_t up_r : {0U, 1U}) {
      there[up_r] = length(
          AltitudeFromUnit<double>(UnitOf(r.low + up_r, size_.altitudes), top_km_, radius_km_), x);
    }
    // A texel of length 0 holds 0 and knows nothing: its neighbour in altitude speaks for both.
    for (const std::size_t up_r : {0U, 1U}) {
      const float share = there[1 - up_r] > kNoLength_km ? r.Weight(up_r) : 1.0F;
      weights[up_r][up_m] = there[up_r] > kNoLength_km
                                ? m.Weight(up_m) * share * static_cast<float>(here / there[up_r])
                                : 0.0F;
    }
  }
  return weights;
}

ScatteringTable::Start ScatteringTable::StartAt(const ViewRay& ray, double distance_m,
                                                bool ground) const {
  using namespace shared;
  const double h = std::max(ray.altitude_m, 0.0) / kMetresPerKilometre;
  if (distance_m == 0.0) return {h, ray.mu, ray.mu_s, ground};
  const double d = distance_m / kMetresPerKilometre;
  const double z = std::clamp(AltitudeAlongRay<double>(h, ray.mu, d, radius_km_), 0.0, top_km_);
  return {z, ZenithCosineAlongRay<double>(h, ray.mu, d, z, radius_km_),
          SunCosineAlongRay<double>(h, ray.mu_s, ray.nu, d, z, radius_km_), ground};
}

ScatteredOnce<float> ScatteringTable::Lookup(const ViewRay& ray) const {
  const RayExtent extent = ExtentOf(ray, medium().planet_radius_m, medium().atmosphere_height_m);
  if (extent.begin_m == extent.end_m) {
    return {Bands<float>(air_.bands()), Bands<float>(air_.bands())};
  }
  if (extent.end == RayEnd::kLength) return LookupSegment(ray, extent);
  return Interpolate(StartAt(ray, extent.begin_m, extent.end == RayEnd::kGround), ray.nu);
}

ScatteredOnce<float> ScatteringTable::LookupSegment(const ViewRay& ray,
                                                    const RayExtent& extent) const {
  ViewRay whole = ray;
  whole.length_m = std::numeric_limits<double>::infinity();
  const bool ground = ExtentOf(whole, medium().planet_radius_m, medium().atmosphere_height_m).end ==
                      RayEnd::kGround;
  ScatteredOnce<float> light = Interpolate(StartAt(ray, extent.begin_m, ground), ray.nu);
  const ScatteredOnce<float> beyond = Interpolate(StartAt(ray, extent.end_m, ground), ray.nu);
  const Bands<float> transmittance = air_.TransmittanceAlong(ray);
  for (std::size_t band = 0; band < air_.bands(); ++band) {
    const auto rest = [&](float all, float hidden) {
      return std::max(all - transmittance[band] * hidden, 0.0F);
    };
    light.rayleigh[band] = rest(light.rayleigh[band], beyond.rayleigh[band]);
    light.mie[band] = rest(light.mie[band], beyond.mie[band]);
  }
  return light;
}

}  // namespace alpenglow
