// SPDX-License-Identifier: MIT
#include <alpenglow/sun_and_moon.h>

#include <alpenglow/errors.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "atmosphere/api/conversions.h"
#include "atmosphere/astronomy/moon.h"
#include "atmosphere/astronomy/sun.h"
#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/medium/medium.h"
#include "atmosphere/refraction/observer_refraction.h"
#include "atmosphere/refraction/refracted_view.h"

namespace alpenglow {

using atmosphere::kRadiansPerDegree;
using atmosphere::RequireInRange;

namespace {

constexpr int kUnixEpochModifiedJulianDay = 40587;

Direction Towards(double elevation_deg, double azimuth_deg) {
  const glm::dvec3 unit = atmosphere::DirectionFromAngles(elevation_deg * kRadiansPerDegree,
                                                          azimuth_deg * kRadiansPerDegree)
                              .xyz;
  return {unit.x, unit.y, unit.z};
}

/// Returns the air of the atmosphere on the sphere that osculates the ellipsoid at the place.
atmosphere::BendingAir AirAt(const Atmosphere& atmosphere, const Place& place) {
  const atmosphere::Medium& medium = atmosphere.medium();
  return atmosphere::GentleAirOf(
      medium, atmosphere::OsculatingRadius(medium, GeodeticFromPlace(place).latitude_rad));
}

}  // namespace

Direction DirectionFromAngles(double elevation_deg, double azimuth_deg) {
  RequireInRange(elevation_deg, -90.0, 90.0, "elevation_deg");
  RequireInRange(azimuth_deg, -360.0, 360.0, "azimuth_deg");
  return Towards(elevation_deg, azimuth_deg);
}

void RequireFinite(double value, std::string_view name) {
  if (!std::isfinite(value))
    throw InputError(fmt::format("{} is {}; it must be finite", name, value));
}

void RequireValid(const SunInSky& sun) {
  RequireInRange(sun.elevation_deg, -90.0, 90.0, "sun.elevation_deg");
  RequireInRange(sun.azimuth_deg, -360.0, 360.0, "sun.azimuth_deg");
  RequireInRange(sun.distance_au, 5e-3, 1e5, "sun.distance_au");
  RequireInRange(sun.angular_radius_deg, 1e-6, 90.0, "sun.angular_radius_deg");
  RequireInRange(sun.lower_for_air_deg, -90.0, 90.0, "sun.lower_for_air_deg");
}

atmosphere::GeodeticPosition GeodeticFromPlace(const Place& place) {
  return atmosphere::PlaceFromDegrees(place.latitude_deg, place.longitude_deg, place.height_m);
}

atmosphere::UtcInstant InstantFromTime(UtcTime time) {
  const auto day = std::chrono::floor<std::chrono::days>(time);
  constexpr auto kFirst = std::chrono::year(atmosphere::kFirstYear) / std::chrono::January / 1;
  constexpr auto kLast = std::chrono::year(atmosphere::kLastYear) / std::chrono::December / 31;
  if (day < std::chrono::sys_days(kFirst) || day > std::chrono::sys_days(kLast)) {
    throw InputError(
        fmt::format("time lies {} days after 1970-01-01; its year must lie in [{}, {}]",
                    day.time_since_epoch().count(), atmosphere::kFirstYear, atmosphere::kLastYear));
  }
  return {kUnixEpochModifiedJulianDay + static_cast<int>(day.time_since_epoch().count()),
          std::chrono::duration<double>(time - day).count()};
}

UtcTime TimeFromInstant(const atmosphere::UtcInstant& instant) {
  const std::chrono::days day(instant.modified_julian_day - kUnixEpochModifiedJulianDay);
  return UtcTime(day) + std::chrono::microseconds(std::llround(1e6 * instant.second_of_day));
}

UtcTime TimeFromText(std::string_view text, const std::string& zone) {
  return TimeFromInstant(
      atmosphere::ParseInstant(text, zone.empty() ? std::nullopt : std::optional(zone)));
}

std::string TextFromTime(UtcTime time) { return atmosphere::FormatUtc(InstantFromTime(time)); }

Direction SunInSky::ToSun() const {
  RequireValid(*this);
  return Towards(elevation_deg, azimuth_deg);
}

double ElevationForAir_deg(const SunInSky& sun) {
  return std::clamp(sun.elevation_deg - sun.lower_for_air_deg, -90.0, 90.0);
}

Direction SunInSky::ToSunForAir() const {
  RequireValid(*this);
  return Towards(ElevationForAir_deg(*this), azimuth_deg);
}

SunInSky SunAt(const Place& place, UtcTime time, const Atmosphere& atmosphere) {
  const atmosphere::SunPosition sun = atmosphere::ApparentSunAt(
      GeodeticFromPlace(place), InstantFromTime(time), AirAt(atmosphere, place));
  return {sun.elevation_rad / kRadiansPerDegree, sun.azimuth_rad / kRadiansPerDegree,
          sun.distance_au, sun.angular_radius_rad / kRadiansPerDegree,
          sun.lower_for_air_rad / kRadiansPerDegree};
}

MoonInSky MoonAt(const Place& place, UtcTime time, const Atmosphere& atmosphere) {
  const atmosphere::MoonPosition moon = atmosphere::ApparentMoonAt(
      GeodeticFromPlace(place), InstantFromTime(time), AirAt(atmosphere, place));
  return {moon.elevation_rad / kRadiansPerDegree,
          moon.azimuth_rad / kRadiansPerDegree,
          moon.distance_m,
          moon.angular_radius_rad / kRadiansPerDegree,
          moon.phase_angle_rad / kRadiansPerDegree,
          moon.IlluminatedFraction()};
}

std::optional<UtcTime> SunEventTime(std::string_view event, const Place& place, UtcTime around) {
  const std::optional<atmosphere::SunEvent> known = atmosphere::SunEventFromName(event);
  if (!known) {
    throw InputError("\"" + std::string(event) +
                     "\" is no event of the sun; use noon, sunrise, sunset, or civil-, nautical- "
                     "or astronomical-dawn or -dusk");
  }
  const std::optional<atmosphere::UtcInstant> instant =
      atmosphere::FindSunEvent(*known, GeodeticFromPlace(place), InstantFromTime(around));
  if (!instant) return std::nullopt;
  return TimeFromInstant(*instant);
}

}  // namespace alpenglow
