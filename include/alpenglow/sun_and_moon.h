// SPDX-License-Identifier: MIT
/// @file
/// Positions of the sun and the moon at a place and time, and the times of sunrise and twilight.
#pragma once

#include <numbers>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <alpenglow/atmosphere.h>
#include <alpenglow/export.h>
#include <alpenglow/geometry.h>
#include <alpenglow/place_time.h>
#include <alpenglow/spectrum.h>

namespace ALPENGLOW_EXPORT alpenglow {

/// The sun as seen from a place. Its default is a sun in the south at its mean distance. Functions
/// throw InputError that names a member out of its range.
struct SunInSky {
  double elevation_deg = 45.0;         ///< of the centre, with refraction, in [-90, 90]
  double azimuth_deg = 180.0;          ///< clockwise from north, in [-360, 360]
  double distance_au = 1.0;            ///< from the place, in [0.005, 100000]
  double angular_radius_deg = 0.2666;  ///< of the disk, in [0.000001, 90]
  /// The air is lit by a sun that stands lower by this angle [degrees], in [-90, 90], but at most at
  /// the nadir or the zenith: refraction bends rays less before they reach high air than before they
  /// reach the observer.
  double lower_for_air_deg = 0.0;

  /// Returns the direction in which the sun is visible: for its disk and for light on surfaces.
  [[nodiscard]] Direction ToSun() const;
  /// Returns the direction of the sun that lights the air: for Sky.
  [[nodiscard]] Direction ToSunForAir() const;

  /// Returns the elevation [rad].
  [[nodiscard]] constexpr double elevation_rad() const { return elevation_deg * kRadiansPerDegree; }
  /// Returns the azimuth [rad].
  [[nodiscard]] constexpr double azimuth_rad() const { return azimuth_deg * kRadiansPerDegree; }
  /// Returns the angular radius [rad].
  [[nodiscard]] constexpr double angular_radius_rad() const {
    return angular_radius_deg * kRadiansPerDegree;
  }

 private:
  static constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;
};

/// The sun as the light of a Sky. It is made from a SunInSky, or from a direction, in which a sun
/// at its mean distance stands. Functions throw InputError that names a member out of its range.
struct Sunlight {
  Direction to_sun;          ///< in which it is seen: for its disk and for light on surfaces
  Direction to_sun_for_air;  ///< of the sun that lights the air, see SunInSky::lower_for_air_deg
  double distance_au = 1.0;  ///< in [0.005, 100000]; light falls with its square
  double angular_radius_deg = 0.2666;  ///< of the disk, in [0.000001, 90]

  /// Makes the light of a sun at its mean distance.
  Sunlight(const Direction& direction)  // NOLINT: as directions are written
      : to_sun(direction), to_sun_for_air(direction) {}
  /// Makes the light of a sun. Throws InputError for a member out of range.
  Sunlight(const SunInSky& sun);  // NOLINT: as above
};

/// The moon as seen from a place.
struct MoonInSky {
  double elevation_deg = 0.0;         ///< of the centre, with refraction
  double azimuth_deg = 0.0;           ///< clockwise from north
  double distance_m = 0.0;            ///< from the place to the centre
  double angular_radius_deg = 0.0;    ///< of the disk
  double phase_angle_deg = 0.0;       ///< 0 at full moon, 180 at new moon
  double illuminated_fraction = 0.0;  ///< of the disk, by area, in [0, 1]
  double sun_distance_au = 1.0;       ///< of the moon from the sun
  double lower_for_air_deg = 0.0;     ///< as of SunInSky

  /// Returns the direction in which the moon is visible.
  [[nodiscard]] Direction ToMoon() const;
  /// Returns the direction of the moon that lights the air: for Sky.
  [[nodiscard]] Direction ToMoonForAir() const;

  /// Returns the elevation [rad].
  [[nodiscard]] constexpr double elevation_rad() const { return elevation_deg * kRadiansPerDegree; }
  /// Returns the azimuth [rad].
  [[nodiscard]] constexpr double azimuth_rad() const { return azimuth_deg * kRadiansPerDegree; }
  /// Returns the angular radius [rad].
  [[nodiscard]] constexpr double angular_radius_rad() const {
    return angular_radius_deg * kRadiansPerDegree;
  }
  /// Returns the phase angle [rad].
  [[nodiscard]] constexpr double phase_angle_rad() const {
    return phase_angle_deg * kRadiansPerDegree;
  }

 private:
  static constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;
};

/// Returns the sun as seen from a place, with the refraction of an atmosphere. Without refraction
/// the direction is within 2 arcseconds of the NREL Solar Position Algorithm (asserted by
/// sun_test). Series are tabulated by time: within 1e-9 radians of their sums (asserted by
/// ephemeris_tables_test). It takes two microseconds, and a millisecond for the first instant
/// of 16 days. Throws InputError for a place out of range and a year outside [1900, 2100].
[[nodiscard]] SunInSky SunAt(const Place& place, const UtcTime& time,
                             const Atmosphere& atmosphere = {});

/// Returns SunAt() of many instants, computed on all processors. Throws InputError as SunAt() does.
[[nodiscard]] std::vector<SunInSky> SunsAt(const Place& place, std::span<const UtcTime> times,
                                           const Atmosphere& atmosphere = {});

/// Returns the moon as seen from a place, with the refraction of an atmosphere. Throws InputError
/// for a place out of range and a year outside [1900, 2100].
[[nodiscard]] MoonInSky MoonAt(const Place& place, const UtcTime& time,
                               const Atmosphere& atmosphere = {});

/// Returns the irradiance of the moon above the air, over that of the sun at its mean distance [1]. The
/// light of a Sky under the moon is its light for the direction MoonInSky::ToMoonForAir(), times this,
/// band by band.
[[nodiscard]] Spectrum MoonIrradiance(const MoonInSky& moon, const Atmosphere& atmosphere = {});

/// Returns the time of an event on the local solar day that contains `around`, or std::nullopt if
/// it does not happen on that day, as in polar night. Error of the search: below 0.1 s (asserted by
/// sun_events_test). Throws InputError for an unknown name, a place out of range and a year outside
/// [1900, 2100].
/// @param event  "noon", "sunrise", "sunset", or "civil-", "nautical-" or "astronomical-" before
///   "dawn" or "dusk".
/// @param place  of the observer; its height lowers the horizon.
/// @param around  any time of the day.
[[nodiscard]] std::optional<UtcTime> SunEventTime(std::string_view event, const Place& place,
                                                  const UtcTime& around);

/// Returns SunEventTime() of many days, computed on all processors. Throws InputError as
/// SunEventTime() does.
[[nodiscard]] std::vector<std::optional<UtcTime>> SunEventTimes(std::string_view event,
                                                                const Place& place,
                                                                std::span<const UtcTime> around);

}  // namespace alpenglow
