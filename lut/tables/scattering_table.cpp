// SPDX-License-Identifier: MIT
#include "lut/tables/scattering_table.h"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "lut/cli/program.h"
#include "lut/tables/table_axes.h"

namespace alpenglow::lut {
namespace {

// Sampling of the texels: errors of the integral stay far below those of the interpolation.
constexpr Sampling kTexelSampling{.nodes = 16, .split_ozone = true, .dark_samples = false};

// Keeps rays that graze the ground on their side of the horizon: a thousand rounding errors, a
// millimetre of perigee at most.
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

// Returns the sun axis of the azimuth table.
SunAxis AxisFrom(double lowest_mu_s) { return {-0.05, 0.04, lowest_mu_s}; }

// Fourth root and fourth power.
float Root(float value) { return std::sqrt(std::sqrt(std::max(value, 0.0F))); }
float Power(float root) { return root * root * (root * root); }

}  // namespace

double LowestUsefulSun(const Medium& medium) {
  const double dip =
      std::asin(-shared::HorizonCosine<double>(medium.atmosphere_height_m, medium.planet_radius_m));
  return -std::sin(std::min(3.0 * dip, std::asin(1.0)));
}

ScatteringTable::ScatteringTable(const Medium& medium, const ScatteringTableOptions& options,
                                 const std::function<void()>& row_done)
    : ScatteringTable(medium, options, std::vector<float>(RequireSize(medium, options.size))) {
  tbb::parallel_for(std::size_t{0}, Rows(size_), [&](std::size_t row) {
    if (Interrupted()) return;
    FillRow(row);
    row_done();
  });
  ThrowIfInterrupted();
}

ScatteringTable::ScatteringTable(const Medium& medium, const ScatteringTableOptions& options,
                                 std::vector<float> texels)
    : air_(medium),
      size_(options.size),
      lowest_mu_s_(RequireLowestSun(medium, options.lowest_mu_s)),
      axes_(options.axes),
      radius_km_(medium.planet_radius_m / kMetresPerKilometre),
      top_km_(medium.atmosphere_height_m / kMetresPerKilometre),
      texels_(std::move(texels)) {
  if (const std::size_t expected = RequireSize(medium, size_); texels_.size() != expected) {
    throw InputError(fmt::format("single scattering table: {} values; its size needs {}",
                                 texels_.size(), expected));
  }
  const auto wrong = std::find_if_not(texels_.begin(), texels_.end(),
                                      [](float value) { return value >= 0.0F && value <= 1.0F; });
  if (wrong != texels_.end()) RequireInRange(*wrong, 0.0, 1.0, "single scattering texel");
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
  ray.mu_s = SunCosineOfTexel(mu_s);
  if (axes_ == ScatteringAxes::kAzimuth) {
    const double sines = std::sqrt(
        std::max((1.0 - ray.mu) * (1.0 + ray.mu) * (1.0 - ray.mu_s) * (1.0 + ray.mu_s), 0.0));
    ray.nu =
        std::clamp(ray.mu * ray.mu_s + sines * std::cos(kPi * UnitOf(nu, size_.nu)), -1.0, 1.0);
    return ray;
  }
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
      std::copy_n(light.rayleigh.values().begin(), bands, texel);
      std::copy_n(light.mie.values().begin(), bands, texel + bands);
      if (axes_ == ScatteringAxes::kAzimuth) {
        std::transform(texel, texel + 2 * bands, texel, Root);
      }
    }
  }
}

double ScatteringTable::SunCosineOfTexel(std::size_t mu_s) const {
  const double unit = UnitOf(mu_s, size_.mu_s);
  if (axes_ == ScatteringAxes::kBruneton) {
    return shared::SunCosineFromUnit<double>(unit, lowest_mu_s_, top_km_, radius_km_);
  }
  return AxisFrom(lowest_mu_s_).MuS(unit);
}

CubicTaps ScatteringTable::SunTaps(double mu_s) const {
  if (axes_ == ScatteringAxes::kBruneton) {
    const auto at = AxisPosition::FromUnit(
        shared::UnitFromSunCosine<double>(mu_s, lowest_mu_s_, top_km_, radius_km_), size_.mu_s);
    return {{at.low, at.low + 1}, {at.Weight(0), at.Weight(1)}};
  }
  return TapsAt(AxisFrom(lowest_mu_s_).Coordinate(mu_s), static_cast<int>(size_.mu_s));
}

CubicTaps ScatteringTable::AngleTaps(const Start& start, double nu) const {
  if (axes_ == ScatteringAxes::kBruneton) {
    const auto at = AxisPosition::FromUnit(shared::UnitFromScatteringCosine<double>(nu), size_.nu);
    return {{at.low, at.low + 1}, {at.Weight(0), at.Weight(1)}};
  }
  const double sines = std::sqrt(
      std::max((1.0 - start.mu) * (1.0 + start.mu) * (1.0 - start.mu_s) * (1.0 + start.mu_s), 0.0));
  // If the azimuth is undefined, all texels hold one value.
  const double cosine = sines > 0.0 ? shared::AzimuthCosine(start.mu, start.mu_s, nu, sines) : 1.0;
  const auto at = AxisPosition::FromUnit(std::acos(cosine) / kPi, size_.nu);
  CubicTaps taps{{}, CatmullRom(at.fraction)};
  // Beyond both ends of the axis the light is mirrored.
  const std::size_t last = size_.nu - 1;
  taps.node = {at.low == 0 ? 1 : at.low - 1, at.low, at.low + 1,
               at.low + 2 > last ? last - 1 : at.low + 2};
  return taps;
}

double ScatteringTable::LengthOf(bool ground, double altitude_km, double mu_unit) const {
  using namespace shared;
  return ground ? altitude_km +
                      mu_unit * (HorizonDistance<double>(altitude_km, radius_km_) - altitude_km)
                : top_km_ - altitude_km +
                      mu_unit * SkyDistanceRange<double>(altitude_km, top_km_, radius_km_);
}

ScatteringTable::PlaneTaps ScatteringTable::TapsByLength(const Start& start) const {
  using namespace shared;
  // Each half of the mu axis is a separate axis; the lower one runs backwards.
  const std::size_t half = size_.mu / 2;
  const double mu_unit =
      start.ground ? UnitFromGroundCosine<double>(start.altitude_km, start.mu, radius_km_)
                   : UnitFromSkyCosine<double>(start.altitude_km, start.mu, top_km_, radius_km_);
  const double r_unit = UnitFromAltitude<double>(start.altitude_km, top_km_, radius_km_);
  const auto linear = AxisPosition::FromUnit(r_unit, size_.altitudes);
  const auto m = AxisPosition::FromUnit(mu_unit, half);
  CubicTaps r{{linear.low, linear.low + 1}, {linear.Weight(0), linear.Weight(1)}};
  // The axis is cubic only where all neighbours have a length. Rays to the ground from the ground,
  // and rays on the top, have none.
  if (axes_ == ScatteringAxes::kAzimuth && !start.ground && linear.low + 3 < size_.altitudes)
    r = TapsAt(r_unit, static_cast<int>(size_.altitudes));
  const double here = LengthOf(start.ground, start.altitude_km, mu_unit);
  PlaneTaps taps{};
  for (std::size_t up_m = 0; up_m < 2; ++up_m) {
    const double x = UnitOf(m.low + up_m, half);
    std::array<double, 4> there{};
    float known = 0.0F;
    for (std::size_t k = 0; k < 4; ++k) {
      if (r.weight[k] == 0.0F) continue;
      const double h =
          AltitudeFromUnit<double>(UnitOf(r.node[k], size_.altitudes), top_km_, radius_km_);
      there[k] = LengthOf(start.ground, h, x);
      if (there[k] > kNoLength_km) known += r.weight[k];
    }
    // A texel of length 0 holds 0 and is not valid: its neighbours in altitude replace it.
    for (std::size_t k = 0; k < 4; ++k) {
      if (r.weight[k] == 0.0F || there[k] <= kNoLength_km) continue;
      const auto longer = static_cast<float>(here / there[k]);
      taps[4 * up_m + k] = {start.ground ? half - 1 - (m.low + up_m) : half + m.low + up_m,
                            r.node[k],
                            m.Weight(up_m) * r.weight[k] / known *
                                (axes_ == ScatteringAxes::kAzimuth ? Root(longer) : longer)};
    }
  }
  return taps;
}

ScatteredOnce<float> ScatteringTable::Interpolate(const Start& start, double nu) const {
  const CubicTaps s = SunTaps(start.mu_s);
  const CubicTaps v = AngleTaps(start, nu);
  const std::size_t bands = air_.bands();
  std::array<float, 2 * kMaxBands> sum{};
  for (const PlaneTap& plane : TapsByLength(start)) {
    if (plane.weight == 0.0F) continue;
    for (std::size_t j = 0; j < 4; ++j) {
      if (v.weight[j] == 0.0F) continue;
      for (std::size_t i = 0; i < 4; ++i) {
        const float weight = plane.weight * v.weight[j] * s.weight[i];
        if (weight == 0.0F) continue;
        const float* texel = &texels_[IndexOf(v.node[j], s.node[i], plane.mu, plane.altitude)];
        for (std::size_t c = 0; c < 2 * bands; ++c) sum[c] += weight * texel[c];
      }
    }
  }
  // If the value of a shorter ray is extrapolated to a longer one, the sum may exceed the available
  // light. Between dark and bright texels a cubic may fall below 0.
  ScatteredOnce<float> light{Spectrum(bands), Spectrum(bands)};
  const auto value = [&](float stored) {
    const float positive = std::max(stored, 0.0F);
    return std::min(axes_ == ScatteringAxes::kAzimuth ? Power(positive) : positive, 1.0F);
  };
  for (std::size_t band = 0; band < bands; ++band) {
    light.rayleigh[band] = value(sum[band]);
    light.mie[band] = value(sum[bands + band]);
  }
  return light;
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
    return {Spectrum(air_.bands()), Spectrum(air_.bands())};
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
  const Spectrum transmittance = air_.TransmittanceAlong(ray);
  for (std::size_t band = 0; band < air_.bands(); ++band) {
    const auto rest = [&](float all, float hidden) {
      return std::max(all - transmittance[band] * hidden, 0.0F);
    };
    light.rayleigh[band] = rest(light.rayleigh[band], beyond.rayleigh[band]);
    light.mie[band] = rest(light.mie[band], beyond.mie[band]);
  }
  return light;
}

}  // namespace alpenglow::lut
