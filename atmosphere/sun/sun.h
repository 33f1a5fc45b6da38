// SPDX-License-Identifier: MIT
// Where the sun stands, and when it rises.
#pragma once

#include <optional>
#include <string_view>

#include "atmosphere/sun/bent_ray.h"
#include "atmosphere/sun/geodesy.h"
#include "atmosphere/sun/time.h"

namespace alpenglow::atmosphere {

/// The sun seen from a place, without refraction (topocentric, apparent) unless a function says so.
struct SunPosition {
  double elevation_rad;       // above the horizontal plane of the ellipsoid
  double azimuth_rad;         // [0, 2 pi), from north over east
  double distance_au;         // from the place
  double angular_radius_rad;  // of the disk
  Vector<Ecef> direction;     // unit vector from the place to the sun
  /// The sun whose straight rays light the air stands lower by this (SunForAir).
  double lower_for_air_rad = 0.0;
};

/// The sun whose straight rays light the air as the bent rays of one that is seen do (LiftForAir of
/// refraction.h). What is seen of a sun, its disk, the middle of its aureole, shadows and light on the
/// ground, is where refraction shows it; columns of air between the sun and air, the planet's shadow
/// in it and light scattered more than once are those of this sun.
[[nodiscard]] SunPosition SunForAir(const SunPosition& seen);

/// Position of the sun. ERFA: IAU 2006/2000A precession-nutation, VSOP-type ephemeris (eraEpv00),
/// aberration and parallax. Within 2 arcseconds of NREL SPA where delta-T is known.
[[nodiscard]] SunPosition SunAt(const GeodeticPosition& place, const UtcInstant& instant);
/// As above with TT - UT1 given [s] (published comparisons fix it).
[[nodiscard]] SunPosition SunAt(const GeodeticPosition& place, const UtcInstant& instant,
                                double delta_t_s);

/// The sun where refraction shows it from the place's height: SunAt, its elevation raised by
/// RefractionFromHeight (refraction.h). SunForAir of it is raised by LiftForAir. `direction` stays the
/// one without refraction.
[[nodiscard]] SunPosition ApparentSunAt(const GeodeticPosition& place, const UtcInstant& instant);
/// The same, in any air that bends gently.
[[nodiscard]] SunPosition ApparentSunAt(const GeodeticPosition& place, const UtcInstant& instant,
                                        const BendingAir& air);

/// Unit vector from elevation and azimuth.
[[nodiscard]] Vector<Enu> DirectionFromAngles(double elevation_rad, double azimuth_rad);

/// Air at the observer, for refraction.
struct AirAtObserver {
  double pressure_pa = 101325.0;
  double temperature_k = 288.15;
};

/// Refraction [rad], apparent minus true elevation, of the *true* elevation, for an observer on the
/// ground; smooth and bounded for every elevation in [-pi/2, pi/2], 34' where the body is seen at
/// the horizontal, 0 from -6 degrees down. Model, source and error are in refraction.cpp;
/// RefractionFromHeight (refraction.h) serves observers high above the sea. Throws InputError when
/// the pressure is not in [0, 2e5] Pa or the temperature not in [150, 400] K.
[[nodiscard]] double Refraction(double true_elevation_rad, const AirAtObserver& air = {});

/// What the sun does on the day of `around`, local to the place.
enum class SunEvent {
  kNoon,
  kSunrise,
  kSunset,
  kCivilDawn,
  kCivilDusk,
  kNauticalDawn,
  kNauticalDusk,
  kAstronomicalDawn,
  kAstronomicalDusk,
};

/// "noon", "sunrise", "civil-dusk" ...; nothing for another name.
[[nodiscard]] std::optional<SunEvent> SunEventFromName(std::string_view name);

/// The instant of the event on the local solar day (midnight to midnight of mean solar time at the
/// longitude) that contains `around`; nothing when it does not happen that day (polar day and
/// night); the first where there are two. Rise and set: upper limb, refracted, seen over the sea
/// horizon from the place's height (dip). The twilights: true centre at -6, -12, -18 degrees. Noon:
/// the centre in the meridian. Error of the search below 0.1 s.
[[nodiscard]] std::optional<UtcInstant> FindSunEvent(SunEvent event, const GeodeticPosition& place,
                                                     const UtcInstant& around);

}  // namespace alpenglow::atmosphere
