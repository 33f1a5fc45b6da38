// SPDX-License-Identifier: MIT
// What the eye sees of the terrain, a pixel each: the first pass of a frame draws it, the picture
// reads it.
#pragma once

#include <glm/vec4.hpp>
#include <vector>

#include "viewer/gl/gl_objects.h"

namespace alpenglow {

/// Location 0, four floats: normal in the eye's frame, octahedral (octahedral.glsl); height of the
/// sun over the terrain's edge, in radii of its disk; distance [m], 0: no terrain. Location 1, four
/// half floats: the sky's irradiance in bands, per unit solar irradiance.
class SurfaceMap {
 public:
  /// @param width, height >= 1.
  SurfaceMap(int width, int height);

  /// Draws go here from now on.
  void Bind() const;
  /// Makes the two textures readable.
  void BindTextures(int surface_unit, int sky_unit) const;

  /// The texture of depths: 0 where there is no land.
  [[nodiscard]] GLuint depth() const { return depth_.id(); }

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }

  /// Row 0 is the lowest.
  [[nodiscard]] std::vector<glm::vec4> ReadSurface() const { return Read(0); }
  [[nodiscard]] std::vector<glm::vec4> ReadSky() const { return Read(1); }

 private:
  [[nodiscard]] std::vector<glm::vec4> Read(int location) const;

  int width_, height_;
  GlTexture surface_, sky_, depth_;
  GlFramebuffer framebuffer_;
};

}  // namespace alpenglow
