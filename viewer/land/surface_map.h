// SPDX-License-Identifier: MIT
// What the eye sees of the terrain, a pixel each: the first pass of a frame draws it, the picture
// reads it.
#pragma once

#include "viewer/gl/render_target.h"

namespace alpenglow::viewer {

/// Its depth is 0 where there is no land.
class SurfaceMap : public RenderTarget {
 public:
  enum Output : std::size_t {
    /// Four floats: normal in the eye's frame, octahedral (octahedral.glsl); height of the disk that
    /// throws shadows over the terrain's edge, in its radii; distance [m], 0: no terrain.
    kSurface,
    /// Four half floats each: irradiance of the sun's sky and of the moon's in bands, as in VertexLight.
    kSky,
    kMoonSky,
  };

  /// @param width, height >= 1.
  SurfaceMap(int width, int height)
      : RenderTarget(width, height,
                     {PixelFormat::kRgba32F, PixelFormat::kRgba16F, PixelFormat::kRgba16F},
                     Depth::k32Bit) {}
};

}  // namespace alpenglow::viewer
