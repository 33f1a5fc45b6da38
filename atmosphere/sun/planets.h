// SPDX-License-Identifier: MIT
// The five planets that the eye sees: where they stand and how bright they are.
//
// Places by ERFA's eraPlan94 (Simon et al. 1994, Astron. Astrophys. 282, 663; within 10 arcseconds
// 1900-2100, Saturn within 90), light time, aberration and parallax as for the moon. Magnitudes by
// G. Mueller's measurements as the Astronomical Almanac had them from 1984 (Meeus 1998,
// Astronomical Algorithms, chapter 41): V(1, 0) and a polynomial in the phase angle; of Saturn
// with its rings. Colours: Cox (2000), Allen's Astrophysical Quantities, table 12.10.
#pragma once

#include <array>

#include "atmosphere/sun/geodesy.h"
#include "atmosphere/sun/time.h"

namespace alpenglow::atmosphere {

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
