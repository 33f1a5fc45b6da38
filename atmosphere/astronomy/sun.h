// SPDX-License-Identifier: MIT
// The sun: its position, its rise, set and twilights, and its disk (the part above the horizon,
// limb darkening). This header also compiles the shared source disk_light.glsl as C++.
#pragma once

#include <alpenglow/sun_and_moon.h>

#include <optional>
#include <string_view>

#include "atmosphere/astronomy/light_direction.h"
#include "atmosphere/refraction/refraction.h"
#include "atmosphere/shared_glsl/shared_math.h"
#include "atmosphere/time_place/geodesy.h"
#include "atmosphere/time_place/time.h"

namespace alpenglow::shared {

#include "atmosphere/shared_glsl/shared_begin.h"
//
#include "atmosphere/astronomy/disk_light.glsl"
//
#include "atmosphere/shared_glsl/shared_end.h"

}  // namespace alpenglow::shared

namespace alpenglow::atmosphere {

/// Returns the sun whose straight rays light the air like the refracted rays of the visible sun
/// (LiftForAir of refraction.h). The visible sun is used for its disk, the centre of its aureole,
/// shadows and light on the ground. The sun returned here is used for columns of air between the
/// sun and the air, the planet's shadow in it, and multiple scattering. It never stands beyond the
/// nadir or the zenith.
[[nodiscard]] SunInSky SunForAir(const SunInSky& seen);

/// Returns the sun without refraction, topocentric and apparent: its elevation is above the
/// horizontal plane of the ellipsoid, its azimuth in [0, 360). ERFA: IAU 2006/2000A
/// precession-nutation, VSOP-type ephemeris (eraEpv00), aberration and parallax. Within 2 arcseconds
/// of NREL SPA where delta-T is known.
[[nodiscard]] SunInSky TrueSunAt(const Place& place, const UtcTime& instant);
/// Returns this sun for a given TT - UT1 [s] (published comparisons specify it).
[[nodiscard]] SunInSky TrueSunAt(const Place& place, const UtcTime& instant, double delta_t_s);

/// Returns the sun with refraction as seen from the place's height: TrueSunAt, with its elevation
/// raised by RefractionFromHeight (refraction.h). SunForAir of the result is raised by LiftForAir.
[[nodiscard]] SunInSky ApparentSunAt(const Place& place, const UtcTime& instant);
/// Returns the sun with refraction by any air that bends rays gently.
[[nodiscard]] SunInSky ApparentSunAt(const Place& place, const UtcTime& instant,
                                     const BendingAir& air);

/// Returns the unit vector of an elevation and azimuth.
[[nodiscard]] Vector<Enu> EnuFromAngles(double elevation_rad, double azimuth_rad);

/// Returns the unit vector from a place to a SunInSky or a MoonInSky that is seen there.
template <typename Body>
[[nodiscard]] Vector<Ecef> EcefTowards(const Body& body, const Place& place) {
  return LocalFrame(kWgs84, place)
      .EcefFromEnu(EnuFromAngles(body.elevation_rad(), body.azimuth_rad()));
}

/// Returns the direction of an apparent sun in the frame east, north, up of the place.
[[nodiscard]] LightDirection DirectionOf(const SunInSky& apparent);

/// Events of the sun on a local solar day.
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

/// Returns the event named "noon", "sunrise", "civil-dusk" ...; std::nullopt for another name.
[[nodiscard]] std::optional<SunEvent> SunEventFromName(std::string_view name);

/// Returns the instant of the event on the local solar day (midnight to midnight of mean solar time
/// at the longitude) that contains `around`; std::nullopt if it does not happen that day
/// (polar day and night); the first if there are two. Rise and set: upper limb, refracted, seen
/// over the sea horizon from the place's height (dip). Twilights: true centre at -6, -12,
/// -18 degrees. Noon: centre in the meridian. Error of the search below 0.1 s.
[[nodiscard]] std::optional<UtcTime> FindSunEvent(SunEvent event, const Place& place,
                                                  const UtcTime& around);

/// Returns whether the sun is above the elevation at which it rises and sets, or begins and ends a
/// twilight (FindSunEvent), for an event other than noon. On a day without the event, the value at
/// noon holds for the whole day.
[[nodiscard]] bool IsAboveEvent(SunEvent event, const Place& place, const UtcTime& instant);

/// The part of a disk above the geometric horizon.
struct VisibleDisk {
  double fraction;        // visible fraction of its area, [0, 1]
  double mu_s_effective;  // zenith cosine of the visible part's centre
};

/// Returns area and centre of the visible circular segment; the horizon is treated as a straight
/// line over half a degree.
/// @param mu_s        zenith cosine of the disk's centre, at the point.
/// @param horizon_mu  zenith cosine of the horizon at the point.
/// @param radius_rad  angular radius of the disk, > 0.
[[nodiscard]] VisibleDisk DiskOverHorizon(double mu_s, double horizon_mu, double radius_rad);

/// Returns the solid angle of a disk of angular radius a [sr]: 2 pi (1 - cos a).
[[nodiscard]] double DiskSolidAngle(double radius_rad);

/// Returns the radiance relative to the disk's mean at an angular distance from its centre
/// (0 centre, 1 limb): (1 - u (1 - mu)) / (1 - u / 3), mu = sqrt(1 - rho^2), u = 0.6, the limb
/// darkening of the visible. Cox (2000), Allen's Astrophysical Quantities, 14.7.
[[nodiscard]] double LimbDarkening(double rho);

/// Returns the relative radiance at one wavelength [nm]: Neckel (2005), Solar Physics 229, 13.
/// Within 0.011 of the centre's radiance of the measurements of Neckel and Labs (1994) from 390 to
/// 1050 nm, rho up to 0.995. Constant beyond the ends of [300, 1100] nm.
[[nodiscard]] double LimbDarkening(double rho, double wavelength_nm);

/// Returns the radius of the circle that contains a fraction of the disk's light, by
/// LimbDarkening(rho). @param share  in [0, 1].
[[nodiscard]] double CircleOfLight(double share);

}  // namespace alpenglow::atmosphere
