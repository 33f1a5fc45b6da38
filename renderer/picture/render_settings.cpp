// SPDX-License-Identifier: MIT
#include "renderer/picture/render_settings.h"

#include "atmosphere/text/error.h"
#include "renderer/camera/pixel_samples.h"

namespace alpenglow::renderer {

void ValidateSettings(const RenderSettings& settings) {
  RequireInRange(settings.width, 1, 16384, "picture width");
  RequireInRange(settings.height, 1, 16384, "picture height");
  RequireInRange(settings.samples_per_pixel, 1, PixelSamples::kMostSamples, "samples per pixel");
  if (settings.noise) {
    RequireInRange(*settings.noise, 1e-8, 1.0, "noise");
    RequireInRange(settings.samples_per_pixel, 2, PixelSamples::kMostSamples,
                   "samples per pixel, with noise,");
  }
  RequireInRange(settings.air_nodes, 2, 32, "air nodes");
}

}  // namespace alpenglow::renderer
