// SPDX-License-Identifier: MIT
// Where the sun stands, and when it rises.
//
// Days without an event of the sun: whether it is above or below.
//
// The sun as a disk: how much of it stands over the horizon, and how bright it is.
//
// This header also reads the shared text disk_light.glsl as C++.
#pragma once

#include <optional>
#include <string_view>

#include "atmosphere/dialect/shared_math.h"
#include "atmosphere/sun/geodesy.h"
#include "atmosphere/sun/refraction.h"
#include "atmosphere/sun/time.h"

namespace alpenglow::shared {

#include "atmosphere/dialect/shared_begin.h"
//
#include "atmosphere/sun/disk_light.glsl"
//
#include "atmosphere/dialect/shared_end.h"

}  // namespace alpenglow::shared

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

/// True if the sun stands above the height at which it rises and sets, or begins and ends a
/// twilight (FindSunEvent); an event other than noon. On a day without the event it does so all
/// day, if at noon.
[[nodiscard]] bool IsAboveEvent(SunEvent event, const GeodeticPosition& place,
                                const UtcInstant& instant);

/// The part of a disk that stands over the geometric horizon.
struct VisibleDisk {
  double fraction;        // of its area, [0, 1]
  double mu_s_effective;  // zenith cosine of the visible part's centre
};

/// @param mu_s        zenith cosine of the disk's centre, at the point.
/// @param horizon_mu  zenith cosine of the horizon at the point.
/// @param radius_rad  angular radius of the disk, > 0.
/// Area and centre of a circular segment; the horizon is a straight line over half a degree.
[[nodiscard]] VisibleDisk DiskOverHorizon(double mu_s, double horizon_mu, double radius_rad);

/// Solid angle of a disk of angular radius a [sr]: 2 pi (1 - cos a).
[[nodiscard]] double DiskSolidAngle(double radius_rad);

/// Brightness relative to the disk's mean at angular distance from its centre (0 centre, 1 limb):
/// (1 - u (1 - mu)) / (1 - u / 3), mu = sqrt(1 - rho^2), u = 0.6, the limb darkening of the
/// visible. Cox (2000), Allen's Astrophysical Quantities, 14.7.
[[nodiscard]] double LimbDarkening(double rho);

/// The same in one wavelength [nm]: Neckel (2005), Solar Physics 229, 13. Within 0.011 of the
/// centre's brightness of what Neckel and Labs (1994) measured from 390 to 1050 nm, rho up to 0.995.
/// Beyond [300, 1100] nm as at the ends.
[[nodiscard]] double LimbDarkening(double rho, double wavelength_nm);

/// The circle within which lies a share of the disk's light, by LimbDarkening(rho): its radius.
/// @param share  in [0, 1].
[[nodiscard]] double CircleOfLight(double share);

}  // namespace alpenglow::atmosphere
