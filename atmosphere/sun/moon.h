// SPDX-License-Identifier: MIT
// Where the moon stands, how the sun lights it, and when it rises.
#pragma once

#include <optional>
#include <string_view>

#include "atmosphere/sun/bent_ray.h"
#include "atmosphere/sun/geodesy.h"
#include "atmosphere/sun/time.h"

namespace alpenglow::atmosphere {

/// Mean radius of the moon, IAU working group on cartographic coordinates (Archinal et al. 2018).
inline constexpr double kMoonRadius_m = 1737400.0;

/// The moon seen from a place, without refraction (topocentric, apparent).
struct MoonPosition {
  double elevation_rad;       // above the horizontal plane of the ellipsoid
  double azimuth_rad;         // [0, 2 pi), from north over east
  double distance_m;          // of its centre from the place
  double angular_radius_rad;  // of the disk
  Vector<Ecef> direction;     // unit vector from the place to the moon

  Vector<Ecef> to_sun;     // unit vector from the moon to the sun
  double sun_distance_au;  // of the moon from the sun
  double phase_angle_rad;  // at the moon, between sun and place: 0 at full moon, pi at new moon
  double bright_limb_rad;  // position angle of the middle of the bright limb on the sky, from the
                           // celestial north pole over east, [0, 2 pi)
  double lower_for_air_rad = 0.0;  // as of SunPosition (sun.h)

  /// Of the disk, by area, [0, 1].
  [[nodiscard]] double IlluminatedFraction() const;
};

/// Position of the moon. ELP/MPP02 (moon_orbit.h; within an arcsecond and 3 km 1950-2100 where
/// delta-T is known, of which a second is half an arcsecond), IAU 2006/2000A precession-nutation,
/// light time, aberration and parallax.
[[nodiscard]] MoonPosition MoonAt(const GeodeticPosition& place, const UtcInstant& instant);
/// As above with TT - UT1 given [s].
[[nodiscard]] MoonPosition MoonAt(const GeodeticPosition& place, const UtcInstant& instant,
                                  double delta_t_s);

/// The moon where refraction shows it from the place's height, as ApparentSunAt (sun.h). Only its
/// elevation and lower_for_air_rad are others than those of MoonAt.
[[nodiscard]] MoonPosition ApparentMoonAt(const GeodeticPosition& place, const UtcInstant& instant);
/// The same, in any air that bends gently.
[[nodiscard]] MoonPosition ApparentMoonAt(const GeodeticPosition& place, const UtcInstant& instant,
                                          const BendingAir& air);

/// The next instant after `after` at which the upper limb, refracted, appears over the sea horizon
/// seen from the place's height (dip), or vanishes below it; nothing when it does not happen within
/// 30 days: a month has days of moonrise everywhere but within half a degree of the poles. Error of
/// the search below 0.1 s.
[[nodiscard]] std::optional<UtcInstant> NextMoonrise(const GeodeticPosition& place,
                                                     const UtcInstant& after);
[[nodiscard]] std::optional<UtcInstant> NextMoonset(const GeodeticPosition& place,
                                                    const UtcInstant& after);
/// The next instant after `after` at which the centre passes the meridian on the upper side. Error of
/// the search below 0.1 s.
[[nodiscard]] UtcInstant NextMoonTransit(const GeodeticPosition& place, const UtcInstant& after);

/// What the moon does.
enum class MoonEvent { kMoonrise, kMoonset, kMoonTransit };

/// "moonrise", "moonset", "moon-transit"; nothing for another name.
[[nodiscard]] std::optional<MoonEvent> MoonEventFromName(std::string_view name);

/// The next instant after `after`, as the three functions above.
[[nodiscard]] std::optional<UtcInstant> NextMoonEvent(MoonEvent event,
                                                      const GeodeticPosition& place,
                                                      const UtcInstant& after);

}  // namespace alpenglow::atmosphere
