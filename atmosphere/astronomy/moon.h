// SPDX-License-Identifier: MIT
// The moon: its reflectance by phase and wavelength, its position and rise, transit and set, and
// its disk as lit by the sun and the earth.
//
// The reflectance of the whole disk, A = pi E_moon / (E_sun Omega), is the lunar calibration of
// ROLO (Kieffer, Stone 2005, Astron. J. 129, 2887, equation 10 and table 4):
//
//   ln A = a0 + a1 g + a2 g^2 + a3 g^3 + d1 exp(-g/4.06054) + d2 exp(-g/12.8802)
//          + d3 cos((g + 30.5858)/16.7498)
//
// with the phase angle g in radians in the polynomial and in degrees elsewhere: a curve with an
// opposition surge, for ground that is redder than the sun and bluer at full moon. The effects of
// libration, and of maria east or west of the terminator (6 % in the quarters), are neglected.
//
// The disk has the radiance of the moon's ground from place to place, outside the air. The ground
// scatters by the law of Lommel and Seeliger (disk_light.glsl), with a brightness for which the
// light of the whole disk is that of the reflectance: a full moon has 0.3 lux, outside the air. In
// addition to the sun, the earth lights the moon: its disk there is (R / d)^2 of a hemisphere, with
// a geometric albedo of 0.37 (Cox 2000, Allen's Astrophysical Quantities, table 12.1), full when
// the moon is new, and with the phase curve of a Lambertian sphere:
//
//   E_earth / E_sun = 0.37 (R / d)^2 (sin a' + (pi - a') cos a') / pi,     a' = pi - a
//
// The moon reflects this light with the reflectance of full moon: earthshine. Maria are neglected.
#pragma once

#include <alpenglow/sun_and_moon.h>

#include <glm/vec3.hpp>
#include <optional>
#include <string_view>

#include "atmosphere/astronomy/light_direction.h"
#include "atmosphere/refraction/refraction.h"
#include "atmosphere/time_place/geodesy.h"
#include "atmosphere/time_place/time.h"

namespace alpenglow::atmosphere {

/// Returns the reflectance of the disk. It was measured from 1.55 to 97 degrees; beyond, the same
/// curve is used, which is within 12 % of that of Krisciunas and Schaefer (1991) from 7 to
/// 145 degrees; it ends at 150.
/// @param wavelength_nm  in [350, 1060], linear between nine filters; constant beyond the ends.
[[nodiscard]] double MoonReflectance(double phase_angle_rad, double wavelength_nm);

/// Mean radius of the moon, IAU working group on cartographic coordinates (Archinal et al. 2018).
inline constexpr double kMoonRadius_m = 1737400.0;

/// The moon seen from a place, and where it is lit from.
struct MoonPosition : MoonInSky {
  Vector<Ecef> to_sun;  // unit vector from the moon to the sun
};

/// Returns the moon without refraction, topocentric and apparent. ELP/MPP02 (ephemeris.h; within an
/// arcsecond and 3 km 1950-2100 where delta-T is known; one second of delta-T is half an arcsecond),
/// IAU 2006/2000A precession-nutation, light time, aberration and parallax.
[[nodiscard]] MoonPosition TrueMoonAt(const Place& place, const UtcTime& instant);
/// Returns this moon for a given TT - UT1 [s].
[[nodiscard]] MoonPosition TrueMoonAt(const Place& place, const UtcTime& instant, double delta_t_s);

/// Returns the moon with refraction as seen from the place's height, like ApparentSunAt (sun.h).
/// Only its elevation and lower_for_air_deg differ from those of TrueMoonAt.
/// @param air  any that bends rays gently, such as AlmanacAir().
[[nodiscard]] MoonPosition ApparentMoonAt(const Place& place, const UtcTime& instant,
                                          const BendingAir& air);

/// Returns the direction of an apparent moon in the frame east, north, up of the place.
[[nodiscard]] LightDirection DirectionOf(const MoonPosition& apparent);

/// Returns the next instant after `after` at which the upper limb, refracted, appears over the sea
/// horizon seen from the place's height (dip), or vanishes below it; std::nullopt if this does not
/// happen within 30 days: every month has days of moonrise everywhere except within half a degree
/// of the poles. Error of the search below 0.1 s.
[[nodiscard]] std::optional<UtcTime> NextMoonrise(const Place& place, const UtcTime& after);
[[nodiscard]] std::optional<UtcTime> NextMoonset(const Place& place, const UtcTime& after);
/// Returns the next instant after `after` at which the centre passes the meridian on the upper
/// side. Error of the search below 0.1 s.
[[nodiscard]] UtcTime NextMoonTransit(const Place& place, const UtcTime& after);

/// Events of the moon.
enum class MoonEvent { kMoonrise, kMoonset, kMoonTransit };

/// Returns the event named "moonrise", "moonset" or "moon-transit"; std::nullopt for another name.
[[nodiscard]] std::optional<MoonEvent> MoonEventFromName(std::string_view name);

/// Returns the next instant of an event after `after`, by the three functions above.
[[nodiscard]] std::optional<UtcTime> NextMoonEvent(MoonEvent event, const Place& place,
                                                   const UtcTime& after);

/// The disk of the moon, with directions in any one frame.
struct MoonDisk {
  LightDirection direction;  // of the disk's centre
  glm::dvec3 to_sun;         // unit vector from the moon
  double radius_rad;         // angular radius
  double
      radiance_per_irradiance;  // [1/sr], scales LommelSeeliger; per solar irradiance at the earth
  double earthshine_per_irradiance = 0.0;  // [1/sr], uniform over the whole disk
};

/// Returns the disk of the moon at 550 nm. For phase angles over 150 degrees, which were never
/// measured, points of the disk are as bright as at 150.
/// @param earth_sun_au  distance of the place from the sun, whose irradiance there is the unit.
[[nodiscard]] MoonDisk MoonDiskOf(const MoonPosition& moon, const LightDirection& direction,
                                  const glm::dvec3& to_sun, double earth_sun_au);

/// Returns the radiance [1/sr] outside the air per unit of solar irradiance, in a direction; 0
/// outside the disk, on its dark side that of earthshine.
[[nodiscard]] double MoonRadiance(const MoonDisk& moon, const glm::dvec3& direction);

/// Returns the irradiance of the whole moon outside the air, per unit of solar irradiance there, at
/// a wavelength.
[[nodiscard]] double MoonIrradiance(const MoonPosition& moon, double earth_sun_au,
                                    double wavelength_nm);

}  // namespace alpenglow::atmosphere
