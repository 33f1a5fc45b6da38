// SPDX-License-Identifier: MIT
// The light of points and small disks in a picture. The share of the light that falls on a pixel is
// divided by the solid angle of this pixel. The sum of radiance times solid angle is therefore the
// illuminance everywhere in a picture, at the rim of a wide view and at the poles of a panorama
// too. A panorama is closed: light beyond its left edge is that at its right edge, and light beyond
// a pole lies on the other side of the pole.
#pragma once

#include <cstddef>
#include <unordered_map>

#include "atmosphere/colour/spectrum.h"
#include "renderer/camera/camera_rays.h"

namespace alpenglow::renderer {

/// Light of points, spread over the pixels of a picture.
class SpreadLight {
 public:
  SpreadLight(int width, int height) : width_(width), height_(height) {}

  /// Adds the light that falls on a pixel, W m^-2 nm^-1; nothing outside a picture that is no
  /// panorama.
  void Add(const CameraRays& camera, int column, int row, const Spectrum& irradiance);

  /// Returns the radiance to add to a pixel, W m^-2 sr^-1 nm^-1; null: nothing to add.
  [[nodiscard]] const Spectrum* At(int x, int y) const;
  /// Number of pixels with light.
  [[nodiscard]] std::size_t size() const { return pixels_.size(); }

 private:
  struct LitPixel {
    double per_sr;
    Spectrum radiance;
  };

  int width_, height_;
  std::unordered_map<int, LitPixel> pixels_;
};

}  // namespace alpenglow::renderer
