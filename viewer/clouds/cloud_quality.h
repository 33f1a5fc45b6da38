// SPDX-License-Identifier: MIT
// Sizes of the drawing of clouds.
#pragma once

namespace alpenglow::viewer {

struct CloudQuality {
  int scale;      // rays are this many pixels apart in both directions, >= 1
  int steps;      // the most steps of a ray through one layer
  int sun_steps;  // samples of the shape towards the light, before the map takes over

  bool operator==(const CloudQuality&) const = default;
};

inline constexpr CloudQuality kLowClouds{3, 96, 0}, kMediumClouds{2, 128, 1},
    kHighClouds{1, 256, 2};

}  // namespace alpenglow::viewer
