// SPDX-License-Identifier: MIT
// How fine shafts are drawn.
//
// tests/bench/shade_error: the built-in range, 1280x720 on software OpenGL with two cores, which
// others used too; errors against ShadowHeights as shares of the light of unshaded air, away from
// edges, for the sun at 15 to 1 degrees before and behind the eye.
//
//             mean             99th percentile   map        pass
//   low       0.15 - 0.6 %     1.5 - 6.7 %        13 ms       3.5 ms
//   medium    0.09 - 0.35 %    1.1 - 3.5 %        25 ms       7 ms
//   high      0.03 - 0.14 %    0.4 - 1.2 %       150 ms     120 ms
//
// The map is made on its own thread; the heights it is made from take 50, 90 and 360 ms more once a
// place.
#pragma once

#include "viewer/shade/shade_follower.h"
#include "viewer/shade/shaft_pass.h"

namespace alpenglow::viewer {

struct ShadeQuality {
  ShadeSize size;
  ShaftDetail detail;
};

inline constexpr ShadeQuality kLowShade{{30e3, 512, 2, 768}, {6, {2, 6}}};
/// A pass over kLowShade's map that looks at it 0.47 times as often: fewer rays and steps.
inline constexpr ShaftDetail kCoarseShafts{8, {2, 5}};
inline constexpr ShadeQuality kMediumShade{{30e3, 1024, 2, 1024}, {5, {3, 6}}};
inline constexpr ShadeQuality kHighShade{{30e3, 1500, 3, 2048}, {2, {6, 8}}};

}  // namespace alpenglow::viewer
