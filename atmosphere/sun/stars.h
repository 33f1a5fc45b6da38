// SPDX-License-Identifier: MIT
// The stars to V 6.0 and the planets, as points of light.
//
// Stars: 5080 of the Bright Star Catalogue (data/bright_stars.csv), with proper motion, precession
// and nutation (IAU 2006/2000A); aberration (20 arcseconds) and parallax (under 1) are left out.
// Light of magnitude V outside the air: 2.54e-6 lux 10^(-0.4 V) (Cox 2000, Allen's Astrophysical
// Quantities, 2.3). The colour of a black body stands for B - V (Ballesteros 2012, EPL 97, 34008):
//
//   T = 4600 K (1 / (0.92 (B - V) + 1.7) + 1 / (0.92 (B - V) + 0.62)).
#pragma once

#include <vector>

#include "atmosphere/sun/planets.h"

namespace alpenglow::atmosphere {

/// Stars up to a magnitude, brightest first, without refraction. The catalogue is read when it is
/// first asked for.
[[nodiscard]] std::vector<PointLight> StarsAt(const UtcInstant& instant, double faintest = 6.0);

/// Outside the air [lux], on a plane that faces the light.
[[nodiscard]] double IlluminanceOf(double magnitude);

/// Its inverse. @param lux  > 0.
[[nodiscard]] double MagnitudeOf(double lux);

/// Temperature [K] of a black body of the colour B - V, in [-0.4, 3].
[[nodiscard]] double TemperatureOf(double colour_index);

}  // namespace alpenglow::atmosphere
