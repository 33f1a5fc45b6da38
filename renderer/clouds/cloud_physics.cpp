// SPDX-License-Identifier: MIT
#include "renderer/clouds/cloud_physics.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "atmosphere/base/error.h"
#include "renderer/clouds/portable_functions.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {
namespace {

constexpr double kWaterDensity = 1000.0;      // kg m^-3
constexpr double kIceDensity = 917.0;         // kg m^-3
constexpr double kStandardGravity = 9.80665;  // m s^-2
constexpr double kDryGas = 287.05;            // J kg^-1 K^-1
constexpr double kAirHeat = 1005.0;           // c_p, J kg^-1 K^-1
constexpr double kVaporRatio = 0.622;         // molar masses of water and dry air
constexpr double kLevelStep_m = 5.0;

/// Returns the latent heat of vaporisation [J/kg] (Bolton 1980, equation 2).
double LatentHeat(double temperature_K) { return 2.501e6 - 2370.0 * (temperature_K - 273.15); }

/// Returns the mixing ratio of saturated air.
double SaturationRatio(const BaseAir& air) {
  const double celsius = air.temperature_K - 273.15;
  const double vapor_Pa =
      611.2 * PortableExp2(17.67 * celsius / (celsius + 243.5) / std::numbers::ln2);
  return kVaporRatio * vapor_Pa / (air.pressure_Pa - vapor_Pa);
}

/// Returns the cube root of x > 0, to the last bits: a Newton step after a power.
double CubeRoot(double x) {
  const double root = PortablePower(x, 1.0 / 3.0);
  return root - (root - x / (root * root)) / 3.0;
}

double SphereExtinction(double content_kg_per_m3, double density_kg_per_m3, double radius_um) {
  if (content_kg_per_m3 <= 0.0) return 0.0;
  return 1.5 * content_kg_per_m3 / (density_kg_per_m3 * 1e-6 * radius_um);
}

}  // namespace

BaseAir StandardBaseAir(double altitude_m) {
  RequireInRange(altitude_m, -500.0, 11000.0, "altitude_m");
  constexpr double kLapse = 6.5e-3;  // K/m
  const double temperature = 288.15 - kLapse * altitude_m;
  return {temperature,
          101325.0 * PortablePower(temperature / 288.15, kStandardGravity / (kDryGas * kLapse))};
}

double CondensationRate_kg_per_m4(const BaseAir& air) {
  RequireInRange(air.temperature_K, 200.0, 320.0, "temperature_K");
  RequireInRange(air.pressure_Pa, 1e4, 1.1e5, "pressure_Pa");
  const double heat = LatentHeat(air.temperature_K);
  const double ratio = SaturationRatio(air);
  const double gas = kDryGas * air.temperature_K;
  const double dry = kStandardGravity / kAirHeat;
  const double saturated =
      kStandardGravity * (1.0 + heat * ratio / gas) /
      (kAirHeat + heat * heat * ratio * kVaporRatio / (gas * air.temperature_K));
  return air.pressure_Pa / gas * kAirHeat / heat * (dry - saturated);
}

double DropletRadius_um(double water_kg_per_m3, double number_per_m3, double k) {
  if (water_kg_per_m3 <= 0.0) return 0.0;
  return 1e6 *
         CubeRoot(0.75 * water_kg_per_m3 / (std::numbers::pi * kWaterDensity * k * number_per_m3));
}

double WaterExtinction_per_m(double water_kg_per_m3, double radius_um) {
  return SphereExtinction(water_kg_per_m3, kWaterDensity, radius_um);
}

double IceExtinction_per_m(double ice_kg_per_m3, double radius_um) {
  return SphereExtinction(ice_kg_per_m3, kIceDensity, radius_um);
}

CloudLevel DropletLevel(const DropletOptions& options, double altitude_m) {
  CloudLevel level;
  const double height = altitude_m - options.base_altitude_m;
  if (height <= 0.0) return level;
  level.water_kg_per_m3 = options.adiabatic_fraction * options.condensation_kg_per_m4 * height;
  const double radius =
      DropletRadius_um(level.water_kg_per_m3, 1e6 * options.number_per_cm3, options.k);
  level.extinction_per_m = WaterExtinction_per_m(level.water_kg_per_m3, radius);
  level.effective_radius_um = std::max(radius, level.effective_radius_um);
  return level;
}

CloudColumn::CloudColumn(double bottom_m, double step_m, std::vector<CloudLevel> levels)
    : bottom_m_(bottom_m), per_step_(1.0 / step_m), levels_(std::move(levels)) {
  ALPENGLOW_ENSURE(levels_.size(), >=, std::size_t{2});
}

CloudColumn CloudColumn::Times(double factor) const {
  CloudColumn column = *this;
  for (CloudLevel& level : column.levels_) {
    level.water_kg_per_m3 *= factor;
    level.extinction_per_m *= factor;
  }
  return column;
}

double CloudColumn::LargestBetween_per_m(double low_m, double high_m) const {
  double largest = std::max(Extinction_per_m(low_m), Extinction_per_m(high_m));
  const auto last = static_cast<double>(levels_.size() - 1);
  const double from = std::clamp(std::ceil((low_m - bottom_m_) * per_step_), 0.0, last);
  const double to = std::clamp(std::floor((high_m - bottom_m_) * per_step_), 0.0, last);
  for (double i = from; i <= to; i += 1.0) {
    largest = std::max(largest, levels_[static_cast<std::size_t>(i)].extinction_per_m);
  }
  return largest;
}

CloudColumn DropletColumn(const DropletOptions& options, double top_m) {
  std::vector<CloudLevel> levels;
  const int count =
      2 + std::max(0, static_cast<int>((top_m - options.base_altitude_m) / kLevelStep_m));
  for (int i = 0; i < count + 1; ++i) {
    levels.push_back(DropletLevel(options, options.base_altitude_m + kLevelStep_m * i));
  }
  return {options.base_altitude_m, kLevelStep_m, std::move(levels)};
}

CloudColumn IceColumn(double ice_kg_per_m3, double radius_um) {
  const CloudLevel level{ice_kg_per_m3, radius_um, IceExtinction_per_m(ice_kg_per_m3, radius_um)};
  return {0.0, 1.0, {level, level}};
}

}  // namespace alpenglow::renderer
