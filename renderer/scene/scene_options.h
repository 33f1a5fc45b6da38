// SPDX-License-Identifier: MIT
// A scene from the command line, for programs that are called without a scene file.
#pragma once

#include <optional>
#include <string>

#include "renderer/scene/scene.h"

namespace alpenglow {

/// What may be typed instead of a scene file; degrees and metres.
struct SceneOptions {
  double latitude = 46.5;
  double longitude = 8.0;
  std::optional<double> heading, pitch, fov;
  std::optional<double> height_m, above_ground_m;
  std::optional<std::string> dem;
  std::optional<std::string> atmosphere;  // a file, or the name of a preset
  std::optional<int> bortle;              // ZenithOfBortleClass
};

/// With `dem` the eye stands at latitude and longitude, 2 m above the ground, and looks north,
/// horizontally, 60 degrees wide, unless said otherwise. Without it the built-in range is centred
/// there and seen as in BuiltInRangeView, unless said otherwise. The scene's time is noon (UTC) of
/// 2026-06-21: the day of events when none is given. Throws InputError naming the option.
[[nodiscard]] Scene SceneFromOptions(const SceneOptions& options);

}  // namespace alpenglow
