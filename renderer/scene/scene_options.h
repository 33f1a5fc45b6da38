// SPDX-License-Identifier: MIT
// The files that a scene is made from.
//
// A scene from the command line, for programs that are called without a scene file.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lut/program/output_file.h"
#include "renderer/scene/scene.h"

namespace alpenglow::renderer {

/// Every file that a scene names and that is read when it is rendered, under the name of its key.
[[nodiscard]] std::vector<NamedFile> FilesOf(const Scene& scene);

/// Latitude and longitude [degrees] where none are typed: of elevation models, and of the view of
/// the built-in range that is centred there.
inline constexpr double kHomeLatitude = 46.5;
inline constexpr double kHomeLongitude = 8.0;

/// What may be typed instead of a scene file; degrees and metres.
struct SceneOptions {
  std::optional<double> latitude, longitude;
  std::optional<double> heading, pitch, fov;
  std::optional<double> height_m, above_ground_m;
  std::optional<std::string> dem;
  std::optional<std::string> atmosphere;  // a file, or the name of a preset
  std::optional<int> bortle;              // ZenithOfBortleClass
};

/// The built-in range of a place: the place is that of its view. Places on the range around
/// kHomeLatitude and kHomeLongitude have its mountains (seed 0), others their own: the same within a
/// hundredth of a degree, and each time.
[[nodiscard]] TerrainSource RangeSeenFrom(const GeodeticPosition& place);

/// A place lies on the built-in range around kHomeLatitude and kHomeLongitude, or does not.
[[nodiscard]] bool IsOnRangeAtHome(const GeodeticPosition& place);

/// The eye stands at latitude and longitude, whatever the ground is. With `dem` it stands 2 m above
/// the ground and looks north, horizontally, 60 degrees wide, unless said otherwise. Without it the
/// built-in range is RangeSeenFrom the place, and height and directions of BuiltInRangeView hold
/// unless said otherwise. The scene's time is noon (UTC) of 2026-06-21: the day of events when
/// none is given. Throws InputError naming the option.
[[nodiscard]] Scene SceneFromOptions(const SceneOptions& options);

}  // namespace alpenglow::renderer
