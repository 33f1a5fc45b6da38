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
#include "atmosphere/time_place/geodesy.h"

namespace alpenglow {

using atmosphere::kRadiansPerDegree;
using atmosphere::RequireInRange;

namespace {

Direction Towards(double elevation_deg, double azimuth_deg) {
  const glm::dvec3 unit =
      atmosphere::EnuFromAngles(elevation_deg * kRadiansPerDegree, azimuth_deg * kRadiansPerDegree)
          .xyz;
  return {unit.x, unit.y, unit.z};
}

/// Returns the air of the atmosphere on the sphere that osculates the ellipsoid at the place.
atmosphere::BendingAir AirAt(const Atmosphere& atmosphere, const Place& place) {
  const atmosphere::Medium& medium = atmosphere.medium();
  return atmosphere::GentleAirOf(
      medium, atmosphere::OsculatingRadius(medium, atmosphere::CheckedPlace(place).latitude_rad()));
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
  RequireInRange(sun.distance_au, kNearestSun_au, kFarthestSun_au, "sun.distance_au");
  RequireInRange(sun.angular_radius_deg, kSmallestSun_deg, kLargestSun_deg,
                 "sun.angular_radius_deg");
  RequireInRange(sun.lower_for_air_deg, -90.0, 90.0, "sun.lower_for_air_deg");
}

Direction SunInSky::ToSun() const {
  RequireValid(*this);
  return Towards(elevation_deg, azimuth_deg);
}

Direction SunInSky::ToSunForAir() const {
  RequireValid(*this);
  return Towards(atmosphere::SunForAir(*this).elevation_deg, azimuth_deg);
}

Sunlight::Sunlight(const SunInSky& sun)
    : to_sun(sun.ToSun()),
      to_sun_for_air(sun.ToSunForAir()),
      distance_au(sun.distance_au),
      angular_radius_deg(sun.angular_radius_deg) {}

SunInSky SunAt(const Place& place, const UtcTime& time, const Atmosphere& atmosphere) {
  return atmosphere::ApparentSunAt(atmosphere::CheckedPlace(place), RequireValid(time),
                                   AirAt(atmosphere, place));
}

MoonInSky MoonAt(const Place& place, const UtcTime& time, const Atmosphere& atmosphere) {
  return atmosphere::ApparentMoonAt(atmosphere::CheckedPlace(place), RequireValid(time),
                                    AirAt(atmosphere, place));
}

std::optional<UtcTime> SunEventTime(std::string_view event, const Place& place,
                                    const UtcTime& around) {
  const std::optional<atmosphere::SunEvent> known = atmosphere::SunEventFromName(event);
  if (!known) {
    throw InputError("\"" + std::string(event) +
                     "\" is no event of the sun; use noon, sunrise, sunset, or civil-, nautical- "
                     "or astronomical-dawn or -dusk");
  }
  return atmosphere::FindSunEvent(*known, atmosphere::CheckedPlace(place), RequireValid(around));
}

}  // namespace alpenglow
