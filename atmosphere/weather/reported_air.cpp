// SPDX-License-Identifier: MIT
#include "atmosphere/weather/reported_air.h"

#include <fmt/format.h>

#include <cmath>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/medium/medium_presets.h"
#include "atmosphere/medium/standard_air.h"

namespace alpenglow::atmosphere {
namespace {

constexpr double kZeroCelsius_k = 273.15;

/// Returns the pressure at a station whose altimeters show its height with this setting (QNH).
double StationPressure_pa(double qnh_pa, double station_m) {
  // In the standard atmosphere p^(R_d L / g) falls linearly with height, with the lapse rate L.
  constexpr double kLapse_k_per_m = 0.0065;
  constexpr double kExponent = kGasOfAir_J_per_kg_K * kLapse_k_per_m / kStandardGravity_m_per_s2;
  const double standard = std::pow(StandardAirAt(station_m).pressure_pa, kExponent);
  const double drop = std::pow(kStandardPressure_pa, kExponent) - standard;
  return std::pow(std::pow(qnh_pa, kExponent) - drop, 1.0 / kExponent);
}

double VapourPressure_pa(double dew_point_c) {
  return 611.2 * std::exp(17.62 * dew_point_c / (243.12 + dew_point_c));
}

/// Returns the height of a layer of the density at an altitude with the column above it [m].
double HeightOfMolecules_m(const Medium& medium, double altitude_m) {
  return MoleculeColumn_m(medium, altitude_m) / MoleculeDensity(medium, altitude_m);
}

Medium WithScaleHeights(Medium medium, double factor) {
  medium.rayleigh_scale_height_m *= factor;
  medium.rayleigh_deficit.scale_height_m *= factor;
  return medium;
}

/// Returns the medium with molecules `factor` times as dense at an altitude, and `stretch` times as
/// high above it.
Medium WithMolecules(const Medium& medium, double factor, double stretch, double altitude_m) {
  // Scale heights stretch the layer at altitude 0 exactly, and above it almost.
  constexpr int kCorrections = 5;
  const double wanted_m = stretch * HeightOfMolecules_m(medium, altitude_m);
  Medium result = medium;
  for (int step = 0; step < kCorrections; ++step)
    result =
        WithScaleHeights(std::move(result), wanted_m / HeightOfMolecules_m(result, altitude_m));
  const double at_zero =
      factor * MoleculeDensity(medium, altitude_m) / MoleculeDensity(result, altitude_m);
  for (double& value : result.rayleigh_scattering_per_m) value *= at_zero;
  return result;
}

Medium InReportedDensity(Medium medium, const MetarReport& report, double station_m) {
  if (!report.temperature.air_c && !report.pressure_pa) return medium;
  const StationAir air = AirAtStation(report, station_m);
  const StandardAir standard = StandardAirAt(station_m);
  return WithMolecules(medium, air.density_kg_per_m3 / standard.density_kg_per_m3,
                       air.virtual_temperature_k / standard.temperature_k,
                       std::max(station_m, 0.0));
}

/// Returns whether a visibility of the medium agrees with the reported one.
bool Agrees(const ReportedVisibility& reported, double visibility_m) {
  if (reported.bound == VisibilityBound::kAtLeast) return visibility_m >= reported.distance_m;
  if (reported.bound == VisibilityBound::kAtMost) return visibility_m <= reported.distance_m;
  return visibility_m == reported.distance_m;
}

Medium InReportedHaze(Medium medium, const ReportedVisibility& visibility, double station_m) {
  if (Agrees(visibility, VisibilityAt(medium, station_m, 0.0))) return medium;
  if (AerosolAt550_per_m(medium) == 0.0) {
    throw InputError(fmt::format(
        "the visibility is {} m, and the air has no aerosol: its visibility is {:.0f} m",
        visibility.distance_m, VisibilityAt(medium, station_m, 0.0)));
  }
  const double factor = AerosolForVisibility(medium, visibility.distance_m, station_m);
  medium = Changed(std::move(medium), {.aerosol = factor, .ozone_du = {}, .ground_albedo = {}});
  const double reached_m = VisibilityAt(medium, station_m, 0.0);
  if (reached_m > (1.0 + 1e-9) * visibility.distance_m) {
    throw InputError(
        fmt::format("the visibility is {} m, and {:g} times the aerosol of the air leaves {:.0f} m",
                    visibility.distance_m, factor, reached_m));
  }
  return medium;
}

}  // namespace

bool IsInFog(const MetarReport& report) {
  if (!report.fog.empty()) return true;
  const auto& visibility = report.visibility;
  return visibility && visibility->distance_m < kVisibilityOfFog_m &&
         visibility->bound != VisibilityBound::kAtLeast;
}

StationAir AirAtStation(const MetarReport& report, double station_m) {
  const StandardAir standard = StandardAirAt(station_m);
  const double pressure_pa = report.pressure_pa ? StationPressure_pa(*report.pressure_pa, station_m)
                                                : standard.pressure_pa;
  const double temperature_k = report.temperature.air_c ? kZeroCelsius_k + *report.temperature.air_c
                                                        : standard.temperature_k;
  const std::optional<double> dew_point_c = report.temperature.dew_point_c;
  const double vapour_pa = dew_point_c ? VapourPressure_pa(*dew_point_c) : 0.0;
  const double virtual_k = temperature_k / (1.0 - 0.378 * vapour_pa / pressure_pa);
  return {pressure_pa, virtual_k, pressure_pa / (kGasOfAir_J_per_kg_K * virtual_k)};
}

std::optional<double> CondensationLevel_m(const MetarReport& report) {
  constexpr double kMetresPerKelvin = 125.0;
  const auto& [air_c, dew_point_c] = report.temperature;
  if (!air_c || !dew_point_c) return std::nullopt;
  return kMetresPerKelvin * (*air_c - *dew_point_c);
}

Medium InReportedAir(Medium medium, const MetarReport& report, double station_m) {
  const Medium before = medium;
  medium = InReportedDensity(std::move(medium), report, station_m);
  if (report.visibility && !IsInFog(report))
    medium = InReportedHaze(std::move(medium), *report.visibility, station_m);
  if (medium == before) return medium;
  if (!medium.name.starts_with("custom"))
    medium.name = fmt::format("custom (from {})", medium.name);
  Validate(medium);
  return medium;
}

}  // namespace alpenglow::atmosphere
