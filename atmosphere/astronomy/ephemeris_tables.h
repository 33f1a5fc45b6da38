// SPDX-License-Identifier: MIT
// Earth, sun, moon and the axes of the earth as functions of time, from polynomials: the series of
// ephemeris.h take tens of microseconds for each instant, and a search for an event asks for
// thousands. Time is divided into spans; the first question about a span evaluates the series at
// its Chebyshev nodes (Press et al. 2007, Numerical Recipes, 5.8). Which questions came before does
// not change an answer.
#pragma once

#include <glm/mat3x3.hpp>

#include "atmosphere/astronomy/ephemeris.h"

namespace alpenglow::atmosphere {

/// Earth, sun and axes at one time of TT.
struct EarthAndAxes {
  EarthAndSun bodies;
  glm::dmat3 true_from_gcrs;           // precession and nutation, IAU 2006/2000A
  double equation_of_the_origins_rad;  // earth rotation angle minus sidereal time
};

/// Returns the values of the series. Within 1e-9 au and 1e-9 rad of ERFA's (asserted by
/// ephemeris_tables_test).
[[nodiscard]] EarthAndAxes EarthAndAxesAt(const TerrestrialTime& time);

/// Returns MoonFromEarth, within 1 m.
[[nodiscard]] BodyState TabulatedMoonFromEarth(const TerrestrialTime& time);

}  // namespace alpenglow::atmosphere
