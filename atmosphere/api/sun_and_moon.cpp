// SPDX-License-Identifier: MIT
#include <alpenglow/sun_and_moon.h>

#include <alpenglow/errors.h>

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <optional>

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

/// Returns the air of the atmosphere on the sphere that osculates the ellipsoid at the place. The last
/// one is kept: it takes as long as a position of the sun.
atmosphere::BendingAir AirAt(const Atmosphere& atmosphere, const Place& place) {
  struct Kept {
    Atmosphere of;
    double latitude_rad;
    atmosphere::BendingAir air;
  };
  thread_local std::optional<Kept> kept;
  const double latitude_rad = atmosphere::CheckedPlace(place).latitude_rad();
  const atmosphere::Medium& medium = atmosphere.medium();
  if (!kept || &kept->of.medium() != &medium || kept->latitude_rad != latitude_rad) {
    kept.emplace(
        Kept{atmosphere, latitude_rad,
             atmosphere::GentleAirOf(medium, atmosphere::OsculatingRadius(medium, latitude_rad))});
  }
  return kept->air;
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

Direction MoonInSky::ToMoon() const { return DirectionFromAngles(elevation_deg, azimuth_deg); }

Direction MoonInSky::ToMoonForAir() const {
  return DirectionFromAngles(std::clamp(elevation_deg - lower_for_air_deg, -90.0, 90.0),
                             azimuth_deg);
}

Spectrum MoonIrradiance(const MoonInSky& moon, const Atmosphere& atmosphere) {
  RequireInRange(moon.angular_radius_deg, 0.0, kLargestSun_deg, "moon.angular_radius_deg");
  RequireInRange(moon.phase_angle_deg, 0.0, 180.0, "moon.phase_angle_deg");
  RequireInRange(moon.sun_distance_au, kNearestSun_au, kFarthestSun_au, "moon.sun_distance_au");
  const atmosphere::MoonPosition position{moon, {}};
  const std::span<const double> wavelengths_nm = atmosphere.wavelengths_nm();
  Spectrum irradiance(wavelengths_nm.size());
  for (std::size_t band = 0; band < wavelengths_nm.size(); ++band) {
    irradiance[band] =
        static_cast<float>(atmosphere::MoonIrradiance(position, 1.0, wavelengths_nm[band]));
  }
  return irradiance;
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

std::vector<SunInSky> SunsAt(const Place& place, std::span<const UtcTime> times,
                             const Atmosphere& atmosphere) {
  const Place eye = atmosphere::CheckedPlace(place);
  const atmosphere::BendingAir air = AirAt(atmosphere, place);
  std::vector<SunInSky> suns(times.size());
  oneapi::tbb::parallel_for(std::size_t{0}, times.size(), [&](std::size_t i) {
    suns[i] = atmosphere::ApparentSunAt(eye, RequireValid(times[i]), air);
  });
  return suns;
}

MoonInSky MoonAt(const Place& place, const UtcTime& time, const Atmosphere& atmosphere) {
  return atmosphere::ApparentMoonAt(atmosphere::CheckedPlace(place), RequireValid(time),
                                    AirAt(atmosphere, place));
}

namespace {

atmosphere::SunEvent EventNamed(std::string_view event) {
  if (const auto known = atmosphere::SunEventFromName(event)) return *known;
  throw InputError("\"" + std::string(event) +
                   "\" is no event of the sun; use noon, sunrise, sunset, or civil-, nautical- "
                   "or astronomical-dawn or -dusk");
}

}  // namespace

std::optional<UtcTime> SunEventTime(std::string_view event, const Place& place,
                                    const UtcTime& around) {
  return atmosphere::FindSunEvent(EventNamed(event), atmosphere::CheckedPlace(place),
                                  RequireValid(around));
}

std::vector<std::optional<UtcTime>> SunEventTimes(std::string_view event, const Place& place,
                                                  std::span<const UtcTime> around) {
  const atmosphere::SunEvent known = EventNamed(event);
  const Place eye = atmosphere::CheckedPlace(place);
  std::vector<std::optional<UtcTime>> times(around.size());
  oneapi::tbb::parallel_for(std::size_t{0}, around.size(), [&](std::size_t i) {
    times[i] = atmosphere::FindSunEvent(known, eye, RequireValid(around[i]));
  });
  return times;
}

}  // namespace alpenglow
