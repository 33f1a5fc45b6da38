// SPDX-License-Identifier: MIT
// Where land stands in a picture of the screen's size, while its light is painted in a smaller one.
#pragma once

#include "viewer/gl/render_target.h"

namespace alpenglow::viewer {

/// Depth alone, as the depth of a SurfaceMap: 0 where there is no land.
class LandOutline : public RenderTarget {
 public:
  /// @param width, height >= 1.
  LandOutline(int width, int height) : RenderTarget(width, height, {}, Depth::k32Bit) {}
};

}  // namespace alpenglow::viewer
