// SPDX-License-Identifier: MIT
// Renders the pixels of a picture in parallel, row by row or, with a bound on the noise, tile by
// tile.
#pragma once

#include <vector>

#include "renderer/effects/effect_choice.h"
#include "renderer/picture/picture_layers.h"
#include "renderer/picture/pixel_light.h"
#include "renderer/picture/pixel_shader.h"
#include "renderer/picture/render.h"

namespace alpenglow::renderer {

class OccludedSkyPixels;

/// Refers to the frame. The bytes of its pictures do not depend on the number of threads.
class TileRenderer {
 public:
  explicit TileRenderer(const FrameContext& frame) : shader_(frame), frame_(frame) {}

  /// Throws RenderingStopped when the settings request it; stops early when Interrupted().
  [[nodiscard]] CountedPicture Picture() const;
  /// Returns single pixels as an image of one row, with a fixed number of rays per pixel and
  /// without layers.
  [[nodiscard]] Image Pixels(const std::vector<PixelPlace>& places) const;

 private:
  /// Adds the rows of a picture with a fixed number of rays per pixel.
  void AddRows(PixelWriter& writer) const;
  /// Adds the tiles of a picture whose pixels take as many rays as their noise requires.
  void AddTiles(PixelWriter& writer) const;
  void AddTile(double floor, int x0, int y0, const OccludedSkyPixels& open_sky,
               PixelWriter& writer) const;
  void Write(int x, int y, const PixelLight& pixel, PixelWriter& writer) const;
  /// Returns the luminance floor of the relative noise: darker pixels count as if they had this
  /// luminance (effect_choice.h) [cd/m^2].
  [[nodiscard]] double NoiseFloor() const;

  PixelShader shader_;
  const FrameContext& frame_;
};

}  // namespace alpenglow::renderer
