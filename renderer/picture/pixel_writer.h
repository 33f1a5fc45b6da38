// SPDX-License-Identifier: MIT
// From the rays of a pixel to the picture and its layers.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "lut/picture/image.h"
#include "renderer/ground/scene_geometry.h"
#include "renderer/picture/picture_layers.h"

namespace alpenglow::renderer {

/// How many rays the pixels of a picture took.
struct RayCount {
  std::uint64_t rays = 0;   // of all pixels
  std::uint64_t least = 0;  // of a pixel
  std::uint64_t most = 0;   // of a pixel
};

/// Puts the means of pixels into the picture.
class PixelWriter {
 public:
  /// A layer that is named twice is there once. Refers to `colour`.
  PixelWriter(const BandColour& colour, int width, int height,
              const std::vector<PictureLayer>& layers);

  /// Whether a layer is of what stands in the middle of a pixel: see WriteMiddle.
  [[nodiscard]] bool AsksForMiddle() const;

  /// Means of the rays. Not shared between pixels: rows may be written from any thread.
  void Write(int x, int y, const PixelSum& rays);
  /// Layers of what stands in the middle.
  void WriteMiddle(int x, int y, const Hit& hit);

  [[nodiscard]] Image Take();
  /// Of the pixels that are written.
  [[nodiscard]] RayCount rays() const {
    return {rays_, least_ <= most_ ? least_.load() : 0, most_};
  }

 private:
  struct Plane {
    const LayerKind& kind;
    std::size_t first_channel;  // of image_.layers
  };
  void Set(const Plane& plane, int x, int y, const LayerValues& values);

  void Count(std::uint64_t rays);

  const BandColour& colour_;
  Image image_;
  std::vector<Plane> planes_;
  std::atomic<std::uint64_t> rays_{0}, least_{~std::uint64_t{0}}, most_{0};
};

}  // namespace alpenglow::renderer
