// SPDX-License-Identifier: MIT
#include "renderer/picture/spread_light.h"

#include <array>

namespace alpenglow::renderer {
namespace {

/// Returns the pixel of a closed panorama; columns and rows may lie beyond its edges.
std::array<int, 2> InPanorama(int column, int row, int width, int height) {
  while (row < 0 || row >= height) {
    row = row < 0 ? -1 - row : 2 * height - 1 - row;
    column += width / 2;
  }
  return {((column % width) + width) % width, row};
}

}  // namespace

void SpreadLight::Add(const CameraRays& camera, int column, int row, const Spectrum& irradiance) {
  if (camera.IsPanorama()) {
    const auto pixel = InPanorama(column, row, width_, height_);
    column = pixel[0];
    row = pixel[1];
  }
  if (row < 0 || row >= height_ || column < 0 || column >= width_) return;
  auto at = pixels_.find(row * width_ + column);
  if (at == pixels_.end()) {
    const double per_sr = 1.0 / camera.PixelSolidAngle(column, row);
    at =
        pixels_.emplace(row * width_ + column, LitPixel{per_sr, Spectrum(irradiance.size())}).first;
  }
  LitPixel& pixel = at->second;
  pixel.radiance = pixel.radiance + static_cast<float>(pixel.per_sr) * irradiance;
}

const Spectrum* SpreadLight::At(int x, int y) const {
  const auto found = pixels_.find(y * width_ + x);
  return found == pixels_.end() ? nullptr : &found->second.radiance;
}

}  // namespace alpenglow::renderer
