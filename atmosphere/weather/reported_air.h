// SPDX-License-Identifier: MIT
// The air in the weather of a report: density from temperature, dew point and pressure, haze from the
// visibility.
//
// The pressure at the station follows from QNH as in an altimeter: by the standard atmosphere between the
// sea and the station (ICAO Doc 7488). Density is that of moist air,
//
//   rho = p / (R_d T_v),   T_v = T / (1 - 0.378 e / p),   e = 611.2 Pa exp(17.62 t / (243.12 C + t)),
//
// with the vapour pressure e at the dew point t in degrees Celsius over water (WMO-No. 8, Guide to
// Instruments and Methods of Observation, annex 4.B). The coefficients of the molecules are scaled with
// rho relative to the standard atmosphere at the station, and their scale heights with T_v, so that
// the column above the station is that of the pressure.
#pragma once

#include <optional>

#include "atmosphere/medium/medium.h"
#include "atmosphere/weather/metar.h"

namespace alpenglow::atmosphere {

/// Below this visibility there is fog (WMO-No. 306).
inline constexpr double kVisibilityOfFog_m = 1000.0;

/// Returns whether the station is in fog: it reports FG, or less visibility than fog has.
[[nodiscard]] bool IsInFog(const MetarReport& report);

struct StationAir {
  double pressure_pa, virtual_temperature_k, density_kg_per_m3;
};

/// Returns the air at a station. Values that the report lacks are those of the standard atmosphere
/// there; without a dew point the air is dry.
/// @param station_m  height of the station above the sea, [-500, 6000].
[[nodiscard]] StationAir AirAtStation(const MetarReport& report, double station_m);

/// Returns the height above the station at which rising air forms clouds [m]: 125 m for each kelvin
/// between temperature and dew point (Espy's rule; within 4 % of the adiabatic level of moist air from 0
/// to 35 degrees Celsius and spreads up to 20 K). Empty without both values.
[[nodiscard]] std::optional<double> CondensationLevel_m(const MetarReport& report);

/// Returns the medium with the density of the report, and with the haze of its visibility unless the
/// station is in fog: Koschmieder's visibility at 550 nm and at the station is the reported one within 1e-9. A
/// visibility that is a limit ("9999": 10 km or more) changes only aerosol that contradicts it. The
/// column of the molecules above the station follows the pressure within 1e-4, for stations up to
/// 3000 m. Throws InputError if the visibility needs aerosol and the medium has none, or less than a thousandth of
/// it.
[[nodiscard]] Medium InReportedAir(Medium medium, const MetarReport& report, double station_m);

}  // namespace alpenglow::atmosphere
