// SPDX-License-Identifier: MIT
// Apparent places of bodies of the solar system for an observer on the earth, shared by sun.h and
// moon.h, with the orbits of the moon and the planets.
//
// Directions are apparent: they include light time and the observer's motion. Axes are those of the
// true equator and equinox (IAU 2006/2000A); polar motion, under 0.6 arcseconds, is neglected.
//
// The moon's orbit around the earth is ELP/MPP02, Chapront, J. and Francou, G. (2003), The lunar
// theory ELP revisited, Astronomy & Astrophysics 404, 735: longitude, latitude and distance as sums
// of some ten thousand periodic terms each, fitted to JPL's ephemerides DE405 and DE406. The 669
// largest terms are used (data/moon_elp_mpp02.csv).
//
// Positions and magnitudes are given for the five planets visible to the naked eye. Positions are
// from ERFA's eraPlan94 (Simon et al. 1994, Astron. Astrophys. 282, 663; within 10 arcseconds
// 1900-2100, Saturn within 90), with light time, aberration and parallax as for the moon.
// Magnitudes are from G. Mueller's measurements as in the Astronomical Almanac from 1984 (Meeus
// 1998, Astronomical Algorithms, chapter 41): V(1, 0) and a polynomial in the phase angle; for
// Saturn with its rings. Colours: Cox (2000), Allen's Astrophysical Quantities, table 12.10.
#pragma once

#include <array>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "atmosphere/time_place/geodesy.h"
#include "atmosphere/time_place/time.h"

namespace alpenglow::atmosphere {

/// Julian date at which the modified Julian date is 0 [days].
inline constexpr double kModifiedJulianEpoch = 2400000.5;

/// Angular velocity of the earth's rotation. WGS84, NIMA TR8350.2 table 3.1.
inline constexpr double kEarthRotation_rad_per_s = 7.292115e-5;

/// Position and velocity in GCRS axes, with the origin at the barycentre of the solar system.
struct BodyState {
  glm::dvec3 position_au;
  glm::dvec3 velocity_au_per_day;
};

struct EarthAndSun {
  BodyState earth;  // state of the earth's centre
  BodyState sun;
};

/// Returns the states of earth and sun. Outside 1900-2100 the error is no longer bounded by 0.02
/// arcseconds.
/// @param delta_t_s  TT - UT1.
[[nodiscard]] EarthAndSun EarthAndSunAt(const UtcTime& instant, double delta_t_s);

/// Returns the rotation from GCRS via the true equator and equinox to ITRS, which equals WGS84
/// within decimetres.
[[nodiscard]] glm::dmat3 EcefFromGcrs(const UtcTime& instant, double delta_t_s);

/// Earth and sun at an instant, with EcefFromGcrs.
struct TurnedEarth {
  EarthAndSun bodies;
  glm::dmat3 ecef_from_gcrs;
};
/// Returns both from one evaluation of the series.
[[nodiscard]] TurnedEarth TurnedEarthAt(const UtcTime& instant, double delta_t_s);

/// Apparent place of a body seen from a place, without refraction.
struct ApparentPlace {
  double elevation_rad;  // above the horizontal plane of the ellipsoid
  double azimuth_rad;    // [0, 2 pi), from north over east
  double distance_au;    // distance that the light has travelled
  Vector<Ecef> direction;
};

/// Returns the apparent place of a body. All arguments must be for the same instant.
[[nodiscard]] ApparentPlace SeenFrom(const Place& place, const glm::dmat3& ecef_from_gcrs,
                                     const EarthAndSun& bodies, const BodyState& body);

/// A time in TT in ERFA's format: a day and the elapsed fraction of it.
struct TerrestrialTime {
  double day, part;
};
[[nodiscard]] TerrestrialTime TerrestrialTimeAt(const UtcTime& instant, double delta_t_s);

/// Returns the geometric state of the moon from the centre of the earth, in the axes of the GCRS.
/// 1950-2100: within 0.6 arcseconds of direction and 3 km of distance of the sum of all terms
/// (which is within a few hundredths of an arcsecond of JPL's DE441).
/// @param time  TT, from which TDB differs by 2 ms, 0.001 arcseconds.
[[nodiscard]] BodyState MoonFromEarth(const TerrestrialTime& time);

/// A point source of light in the sky.
struct PointLight {
  Vector<Ecef> direction;  // unit vector, without refraction
  double magnitude;        // V
  double colour_index;     // B - V
};

/// Returns Mercury, Venus, Mars, Jupiter, Saturn, seen from a place. Errors of magnitudes: 0.2, for
/// Saturn 0.3.
[[nodiscard]] std::array<PointLight, 5> PlanetsAt(const Place& place, const UtcTime& instant);

}  // namespace alpenglow::atmosphere
