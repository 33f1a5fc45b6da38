// SPDX-License-Identifier: MIT
// How fine shafts are drawn.
//
// Measured over the built-in range (1024 samples over 72 km), 1280x720, light of the air alone, away
// from edges, against ShadowHeights and AerialPerspective, the sun at 8 and at 3 degrees before and
// behind the eye; milliseconds of two cores' time with the tables of the air (tests/bench says how):
//
//             mean error      99th percentile   pass      taking it between rays
//   low       0.2 - 0.4 %     2.5 - 5 %          6 ms      9 ms
//   medium    0.2 - 0.3 %     1.6 - 4 %         11 ms      9 ms
//   high      0.1 - 0.2 %     1.0 - 1.9 %      110 ms      9 ms
//
// Of the rest most is the distance of the samples from which the map is made.
#pragma once

#include "viewer/shade/shade_follower.h"
#include "viewer/shade/shaft_pass.h"

namespace alpenglow {

struct ShadeQuality {
  ShadeSize size;
  ShaftDetail detail;
};

inline constexpr ShadeQuality kLowShade{{30e3, 512, 2, 768}, {6, {2, 6}}};
inline constexpr ShadeQuality kMediumShade{{30e3, 1024, 2, 1024}, {5, {3, 6}}};
inline constexpr ShadeQuality kHighShade{{30e3, 1500, 3, 2048}, {2, {6, 8}}};

}  // namespace alpenglow
