// SPDX-License-Identifier: MIT
// Where a body of the solar system is seen from a place on the earth: what sun.h and moon.h share.
//
// Directions are apparent: the light has been on its way, and the observer moves. Axes are those of
// the true equator and equinox (IAU 2006/2000A); polar motion, under 0.6 arcseconds, is left out.
#pragma once

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

}  // namespace alpenglow::atmosphere
