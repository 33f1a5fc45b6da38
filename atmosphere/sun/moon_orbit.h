// SPDX-License-Identifier: MIT
// The moon on its way around the earth.
//
// ELP/MPP02, Chapront, J. and Francou, G. (2003), The lunar theory ELP revisited, Astronomy &
// Astrophysics 404, 735: longitude, latitude and distance as sums of some ten thousand periodic
// terms each, fitted to JPL's ephemerides DE405 and DE406. Of them 669 are kept, the largest
// (data/moon_elp_mpp02.csv).
#pragma once

#include "atmosphere/sun/apparent_place.h"

namespace alpenglow::atmosphere {

/// Geometric, from the centre of the earth, in the axes of the GCRS. 1950-2100: within 0.6
/// arcseconds of direction and 3 km of distance of all terms (those are a few hundredths of an
/// arcsecond from JPL's DE441).
/// @param time  TT, of which TDB differs by 2 ms, 0.001 arcseconds.
[[nodiscard]] BodyState MoonFromEarth(const TerrestrialTime& time);

}  // namespace alpenglow::atmosphere
