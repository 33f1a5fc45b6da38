// SPDX-License-Identifier: MIT
// Where a body of the solar system is seen from a place on the earth: what sun.h and moon.h share.
//
// Directions are apparent: the light has been on its way, and the observer moves. Axes are those of
// the true equator and equinox (IAU 2006/2000A); polar motion, under 0.6 arcseconds, is left out.
//
// The moon on its way around the earth.
//
// ELP/MPP02, Chapront, J. and Francou, G. (2003), The lunar theory ELP revisited, Astronomy &
// Astrophysics 404, 735: longitude, latitude and distance as sums of some ten thousand periodic
// terms each, fitted to JPL's ephemerides DE405 and DE406. Of them 669 are kept, the largest
// (data/moon_elp_mpp02.csv).
//
// The five planets that the eye sees: where they stand and how bright they are.
//
// Places by ERFA's eraPlan94 (Simon et al. 1994, Astron. Astrophys. 282, 663; within 10 arcseconds
// 1900-2100, Saturn within 90), light time, aberration and parallax as for the moon. Magnitudes by
// G. Mueller's measurements as the Astronomical Almanac had them from 1984 (Meeus 1998,
// Astronomical Algorithms, chapter 41): V(1, 0) and a polynomial in the phase angle; of Saturn
// with its rings. Colours: Cox (2000), Allen's Astrophysical Quantities, table 12.10.
#pragma once

#include <array>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "atmosphere/sun/geodesy.h"
#include "atmosphere/sun/time.h"

namespace alpenglow::atmosphere {

/// WGS84, NIMA TR8350.2 table 3.1.
inline constexpr double kEarthRotation_rad_per_s = 7.292115e-5;

/// Position and velocity: GCRS axes, origin at the barycentre of the solar system.
struct BodyState {
  glm::dvec3 position_au;
  glm::dvec3 velocity_au_per_day;
};

struct EarthAndSun {
  BodyState earth;  // its centre
  BodyState sun;
};

/// @param delta_t_s  TT - UT1. Outside 1900-2100 the error is no longer bounded by 0.02 arcseconds.
[[nodiscard]] EarthAndSun EarthAndSunAt(const UtcInstant& instant, double delta_t_s);

/// From GCRS over the true equator and equinox to ITRS, which is WGS84 within decimetres.
[[nodiscard]] glm::dmat3 EcefFromGcrs(const UtcInstant& instant, double delta_t_s);

/// A body seen from a place, without refraction.
struct ApparentPlace {
  double elevation_rad;  // above the horizontal plane of the ellipsoid
  double azimuth_rad;    // [0, 2 pi), from north over east
  double distance_au;    // that the light came
  Vector<Ecef> direction;
};

/// All of one instant.
[[nodiscard]] ApparentPlace SeenFrom(const GeodeticPosition& place,
                                     const glm::dmat3& ecef_from_gcrs, const EarthAndSun& bodies,
                                     const BodyState& body);

/// As what ERFA takes: a day and the part of it that has passed, in TT.
struct TerrestrialTime {
  double day, part;
};
[[nodiscard]] TerrestrialTime TerrestrialTimeAt(const UtcInstant& instant, double delta_t_s);

/// Geometric, from the centre of the earth, in the axes of the GCRS. 1950-2100: within 0.6
/// arcseconds of direction and 3 km of distance of all terms (those are a few hundredths of an
/// arcsecond from JPL's DE441).
/// @param time  TT, of which TDB differs by 2 ms, 0.001 arcseconds.
[[nodiscard]] BodyState MoonFromEarth(const TerrestrialTime& time);

/// A point of light in the sky.
struct PointLight {
  Vector<Ecef> direction;  // unit, without refraction
  double magnitude;        // V
  double colour_index;     // B - V
};

/// Mercury, Venus, Mars, Jupiter, Saturn, seen from a place. Errors of magnitudes: 0.2, of
/// Saturn 0.3.
[[nodiscard]] std::array<PointLight, 5> PlanetsAt(const GeodeticPosition& place,
                                                  const UtcInstant& instant);

}  // namespace alpenglow::atmosphere
