// SPDX-License-Identifier: MIT
#include <alpenglow/errors.h>
#include <alpenglow/sun_and_moon.h>

#include <cmath>

#include "atmosphere/api/conversions.h"
#include "atmosphere/astronomy/moon.h"
#include "atmosphere/astronomy/sun.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/medium/medium.h"
#include "atmosphere/refraction/observer_refraction.h"
#include "atmosphere/refraction/refracted_view.h"

namespace alpenglow {

using atmosphere::kRadiansPerDegree;

namespace {

constexpr int kUnixEpochModifiedJulianDay = 40587;

/// Returns the air of the atmosphere on the sphere that osculates the ellipsoid at the place. The
/// last result is kept, because testing whether air bends rays gently takes longer than a position.
atmosphere::BendingAir AirAt(const Atmosphere& atmosphere, const Place& place) {
  const atmosphere::Medium& medium = atmosphere.medium();
  atmosphere::BendingAir air = atmosphere::BendingAirOf(medium, atmosphere::kHorizonWavelength_nm);
  if (medium.follows_wgs84) {
    air.planet_radius_m =
        atmosphere::OsculatingRadius(atmosphere::kWgs84, GeodeticFromPlace(place).latitude_rad);
  }
  thread_local atmosphere::BendingAir tested, result;
  if (!atmosphere::IsSame(tested, air)) {
    tested = result = air;
    if (!atmosphere::GentlyBends(air)) result.refractivity = 0.0;
  }
  return result;
}

}  // namespace

Direction DirectionFromAngles(double elevation_deg, double azimuth_deg) {
  const glm::dvec3 unit = atmosphere::DirectionFromAngles(elevation_deg * kRadiansPerDegree,
                                                          azimuth_deg * kRadiansPerDegree)
                              .xyz;
  return {unit.x, unit.y, unit.z};
}

atmosphere::GeodeticPosition GeodeticFromPlace(const Place& place) {
  return atmosphere::PlaceFromDegrees(place.latitude_deg, place.longitude_deg, place.height_m);
}

atmosphere::UtcInstant InstantFromTime(UtcTime time) {
  const auto day = std::chrono::floor<std::chrono::days>(time);
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

Direction SunInSky::ToSun() const { return DirectionFromAngles(elevation_deg, azimuth_deg); }

Direction SunInSky::ToSunForAir() const {
  return DirectionFromAngles(elevation_deg - lower_for_air_deg, azimuth_deg);
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
