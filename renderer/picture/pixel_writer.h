// SPDX-License-Identifier: MIT
// From the rays of a pixel to the picture and its layers.
#pragma once

#include <span>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "lut/picture/image.h"
#include "renderer/ground/scene_geometry.h"
#include "renderer/picture/picture_layers.h"

namespace alpenglow {

/// Accumulates the rays of a pixel into the picture.
class PixelWriter {
 public:
  /// A layer that is named twice is there once. Refers to `colour`.
  PixelWriter(const BandColour& colour, int width, int height,
              const std::vector<PictureLayer>& layers);

  /// Whether a layer is of what stands in the middle of a pixel: see WriteMiddle.
  [[nodiscard]] bool AsksForMiddle() const;

  /// Means of the rays. Not shared between pixels: rows may be written from any thread.
  void Write(int x, int y, std::span<const Shaded> rays);
  /// Layers of what stands in the middle.
  void WriteMiddle(int x, int y, const Hit& hit);

  [[nodiscard]] Image Take();

 private:
  struct Plane {
    const LayerKind& kind;
    std::size_t first_channel;  // of image_.layers
  };
  void Set(const Plane& plane, int x, int y, const LayerValues& values);

  const BandColour& colour_;
  Image image_;
  std::vector<Plane> planes_;
};

}  // namespace alpenglow
