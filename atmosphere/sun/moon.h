// SPDX-License-Identifier: MIT
// How much sunlight the moon sends back, by phase and wavelength.
//
// Of the whole disk, A = pi E_moon / (E_sun Omega), by the lunar calibration of ROLO (Kieffer,
// Stone 2005, Astron. J. 129, 2887, equation 10 and table 4):
//
//   ln A = a0 + a1 g + a2 g^2 + a3 g^3 + d1 exp(-g/4.06054) + d2 exp(-g/12.8802)
//          + d3 cos((g + 30.5858)/16.7498)
//
// with the phase angle g in radians in the polynomial and in degrees elsewhere: a curve with an
// opposition surge, of ground that is redder than the sun and bluer in full light. What libration,
// and maria east or west of the terminator, change (6 % in the quarters) is left out.
//
// Where the moon stands, how the sun lights it, and when it rises.
//
// The moon as a disk that the sun lights: how bright it is from place to place, outside the air.
//
// Ground that scatters by Lommel and Seeliger (disk_light.glsl), of a brightness that makes the
// light of the whole disk that of the moon (moon.h): a full moon of 0.3 lux, before the
// air. Beside the sun the earth lights it, whose disk there is (R / d)^2 of a hemisphere, of a
// geometric albedo of 0.37 (Cox 2000, Allen's Astrophysical Quantities, table 12.1), full when the
// moon is new, as a sphere of Lambert:
//
//   E_earth / E_sun = 0.37 (R / d)^2 (sin a' + (pi - a') cos a') / pi,     a' = pi - a
//
// and the moon sends that back as when it is full: earthshine. Maria are left out.
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <string_view>

#include "atmosphere/sun/geodesy.h"
#include "atmosphere/sun/refraction.h"
#include "atmosphere/sun/time.h"

namespace alpenglow::atmosphere {

/// Measured from 1.55 to 97 degrees; beyond, the same curve, within 12 % of that of Krisciunas
/// and Schaefer (1991) from 7 to 145 degrees; it ends at 150.
/// @param wavelength_nm  in [350, 1060], linear between nine filters; beyond as at the ends.
[[nodiscard]] double MoonReflectance(double phase_angle_rad, double wavelength_nm);

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

/// Position of the moon. ELP/MPP02 (ephemeris.h; within an arcsecond and 3 km 1950-2100 where
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

/// Directions in any one frame.
struct MoonDisk {
  glm::dvec3 to_moon;  // unit, to the disk's centre
  glm::dvec3 to_sun;   // unit, from the moon
  double radius_rad;   // angular
  double
      radiance_per_irradiance;  // [1/sr], of LommelSeeliger: by the sun's irradiance at the earth
  double earthshine_per_irradiance = 0.0;  // [1/sr], of the whole disk, even over it
  glm::dvec3 to_moon_for_air{0.0};         // unit, of straight rays that light the air (sun.h)
};

/// At 550 nm. Phase angles over 150 degrees, which were never measured, are as bright a place as
/// 150.
/// @param earth_sun_au  distance of the place from the sun, for whose irradiance the radiance is.
[[nodiscard]] MoonDisk MoonDiskOf(const MoonPosition& moon, const glm::dvec3& to_moon,
                                  const glm::dvec3& to_sun, double earth_sun_au);

/// The moon where the refraction of air that bends gently shows it from a place, in the frame east,
/// north, up there.
[[nodiscard]] MoonDisk ApparentMoonDisk(const GeodeticPosition& place, const UtcInstant& instant,
                                        double earth_sun_au, const BendingAir& air);

/// Radiance [1/sr] outside the air per unit of solar irradiance, in a direction; 0 beside the disk,
/// on its dark side that of earthshine.
[[nodiscard]] double MoonRadiance(const MoonDisk& moon, const glm::dvec3& direction);

/// Irradiance of the whole moon outside the air, per unit of the sun's there, at a wavelength.
[[nodiscard]] double MoonIrradiance(const MoonPosition& moon, double earth_sun_au,
                                    double wavelength_nm);

}  // namespace alpenglow::atmosphere
