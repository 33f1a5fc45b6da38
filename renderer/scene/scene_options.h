// SPDX-License-Identifier: MIT
// Builds a scene from command line options, for programs that are called without a scene file, and
// lists the files and the land of a scene.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lut/cli/output_file.h"
#include "renderer/scene/scene.h"

namespace alpenglow::renderer {

struct LandSource;  // renderer/terrain/land_source.h

/// Returns every file that the scene names and that is read for rendering, with the name of its
/// key.
[[nodiscard]] std::vector<NamedFile> FilesOf(const Scene& scene);

/// Returns the files of a volume's grid: none, one, or an NRRD header and the data that it names.
[[nodiscard]] std::vector<std::filesystem::path> FilesOf(const Volume& volume);

/// Returns the files of a cloud's grid: none, one, or an NRRD header and the data that it names.
[[nodiscard]] std::vector<std::filesystem::path> FilesOf(const SceneCloud& cloud);

/// Returns the land source of a scene: its elevation model, its mesh or the built-in range.
[[nodiscard]] LandSource LandSourceOf(const Scene& scene);

/// Default latitude and longitude [degrees], for elevation models, and for the view of the built-in
/// range centred there.
inline constexpr double kHomeLatitude = 46.5;
inline constexpr double kHomeLongitude = 8.0;

/// Options that replace a scene file; degrees and metres.
struct SceneOptions {
  std::optional<std::string> place;  // see PlaceNamed; for what latitude and longitude do not say
  std::optional<double> latitude, longitude;
  std::optional<double> heading, pitch, fov;
  std::optional<double> height_m, above_ground_m;
  std::vector<std::string> dem;           // files and folders; see LandSource
  std::optional<std::string> atmosphere;  // file, or name of a preset
  std::optional<int> bortle;              // see ZenithOfBortleClass
};

/// Returns the built-in range whose view is at `place`. Places on the range around kHomeLatitude
/// and kHomeLongitude get its mountains (seed 0). Other places get their own mountains, which are
/// equal within a hundredth of a degree and in every run.
[[nodiscard]] TerrainSource RangeSeenFrom(const Place& place);

/// Returns whether a place lies on the built-in range around kHomeLatitude and kHomeLongitude.
[[nodiscard]] bool IsOnRangeAtHome(const Place& place);

/// Returns the options with the place of a report, if its station is a named airport and the options
/// have neither a place nor an elevation model.
[[nodiscard]] SceneOptions AtStation(SceneOptions options, const SceneWeather& weather);

/// Returns the scene with the eye at latitude and longitude or the named place, on any ground. With
/// `dem` the default is 2 m above the ground, looking north, horizontally, 60 degrees wide. Without
/// it the range is RangeSeenFrom the place, and height and directions default to
/// ProceduralMountainsView. The scene's time is noon (UTC) of 2026-06-21, which sets the day of
/// events given without a date. Throws InputError naming the option.
[[nodiscard]] Scene SceneFromOptions(const SceneOptions& options);

}  // namespace alpenglow::renderer
