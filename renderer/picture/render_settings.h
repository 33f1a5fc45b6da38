// SPDX-License-Identifier: MIT
// What is asked of a picture: its size and care, when and from where it is taken.
#pragma once

#include <exception>
#include <optional>
#include <stop_token>
#include <vector>

#include "atmosphere/sun/time.h"
#include "lut/program/progress.h"
#include "renderer/camera/camera_path.h"
#include "renderer/camera/pixel_filter.h"
#include "renderer/effect/effects.h"
#include "renderer/lamp/lamp_plan.h"
#include "renderer/picture/picture_layers.h"

namespace alpenglow::renderer {

/// Of a pixel, unless it begins with more.
inline constexpr int kMostRaysForNoise = 256;
/// What a pixel begins with whose neighbours agree.
inline constexpr int kFewestRaysForNoise = 2;

struct RenderSettings {
  int width = 1280;
  int height = 720;
  int samples_per_pixel = 4;  // rays, in [1, 1024]; a power of two is spread best
  /// Of a pixel, relative, in [1e-8, 1]: pixels take more rays as it asks (pixel_noise.h), at most
  /// kMostRaysForNoise. Nothing: all take samples_per_pixel.
  std::optional<double> noise = std::nullopt;
  PixelFilter::Kind filter = PixelFilter::Kind::kBlackmanHarris;
  int air_nodes = 12;  // Gauss nodes along a ray to the sky
  EffectSet effects = EffectSet::All();
  bool share_air = true;  // between rays of a pixel; false for comparison
  /// With noise between pixels, too, where it is smooth (air_lattice.h); false for comparison.
  bool share_air_of_pixels = true;
  /// With noise, pixels that see nothing but sky take one ray; false is for comparison.
  bool skips_open_sky = true;
  std::vector<PictureLayer> layers;
  LampSettings lamps = {};
  Progress* progress = nullptr;  // told of steps, and of the rows of pixels that are done
  std::stop_token stop = {};     // asked between pixels whether anybody still wants the picture
};

/// Nobody wants the picture any more (RenderSettings::stop).
class RenderingStopped : public std::exception {
 public:
  [[nodiscard]] const char* what() const noexcept override { return "rendering was stopped"; }
};

/// When a picture is taken, and from where.
struct Shot {
  Shot(const UtcInstant& at) : instant(at) {}  // NOLINT: by the scene's camera

  UtcInstant instant;
  /// Another camera with the scene's lens: of one pose, or of several that it takes
  /// at even steps of time while its shutter is open. Terrain stays where it is;
  /// light and air are as at the middle pose. The air stays on the sphere that
  /// osculates the ellipsoid at the scene's place, which the ellipsoid leaves by 3
  /// m at 100 km and by 70 m at 500 km, the farthest that an eye may be.
  std::vector<CameraPose> poses;

  [[nodiscard]] std::optional<CameraPose> middle() const {
    if (poses.empty()) return std::nullopt;
    return poses[poses.size() / 2];
  }
};

/// Throws InputError for what is out of range.
void ValidateSettings(const RenderSettings& settings);

}  // namespace alpenglow::renderer
