// SPDX-License-Identifier: MIT
/// @file
/// Stills of scenes: terrain, sky, and the air in front of everything.
///
/// These functions are in the library alpenglow::renderer; all others are in alpenglow::lut.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <alpenglow/atmosphere.h>
#include <alpenglow/export.h>
#include <alpenglow/image.h>
#include <alpenglow/place_time.h>
#include <alpenglow/progress.h>

namespace ALPENGLOW_EXPORT alpenglow {

/// A camera. Its eye is at the place of the view.
struct Camera {
  double height_m = 2.0;               ///< above the ground, or above the ellipsoid
  bool height_is_above_ground = true;  ///< false: height_m is above the ellipsoid
  double heading_deg = 0.0;            ///< clockwise from north, in [-360, 360]
  double pitch_deg = 0.0;              ///< positive is up, in [-90, 90]
  double roll_deg = 0.0;               ///< clockwise as seen from behind, in [-180, 180]
  double fov_deg = 60.0;               ///< horizontal, in [0.1, 179], or 360 for a panorama

  /// Returns whether all members are equal.
  [[nodiscard]] bool operator==(const Camera&) const = default;
};

/// The place and the direction from which a picture is seen.
struct View {
  Place place;    ///< of the eye; its height_m is not used, see Camera
  Camera camera;  ///< see there

  /// Returns whether all members are equal.
  [[nodiscard]] bool operator==(const View&) const = default;
};

/// The source of terrain.
enum class TerrainKind {
  kBuiltInMountains,  ///< a range that is generated for the place
  kElevationModel,    ///< a file: GeoTIFF, SRTM .hgt or USGS DEM
  kNone               ///< the ellipsoid alone
};

/// The content of a picture. Scene files (Scene::Read) can also contain lamps, fog, smoke, meshes,
/// draped images and other ground materials.
struct SceneDescription {
  Place place;            ///< of the eye, in the middle of what is loaded; its height_m is not used
  Camera camera;          ///< of the view from there
  Atmosphere atmosphere;  ///< preset "earth" by default
  TerrainKind terrain = TerrainKind::kBuiltInMountains;  ///< see there
  std::filesystem::path elevation_model;                 ///< for TerrainKind::kElevationModel
};

/// Returns the view of the built-in mountains that skyseries renders without a scene file.
[[nodiscard]] SceneDescription BuiltInScene();

/// Size and quality of a still.
struct StillOptions {
  int width = 1280;  ///< in [1, 16384]
  int height = 720;  ///< in [1, 16384]
  /// Relative noise of a pixel, in [1e-8, 1]: pixels take up to 256 rays until they reach it.
  /// Empty: every pixel takes samples_per_pixel rays.
  std::optional<double> noise = 0.02;
  int samples_per_pixel = 4;  ///< rays of a pixel, in [1, 1024]; with noise its first rays
  /// Further layers: "depth", "normal", "albedo", "inscatter", "transmittance", "sun_visibility"
  /// and others, see --aov in renderer/MANUAL.md.
  std::vector<std::string> layers = {};
};

/// A scene whose terrain is loaded and whose air is solved; it renders stills of any time from any
/// place nearby, without loading anything again. Immutable; copies share their memory.
///
/// A View must lie at most 500 km from the place of the scene and above the ground. An elevation
/// model of more than 2^25 samples is loaded only as far as the eye at the place of the scene sees.
class Scene {
 public:
  /// Loads a scene. Throws InputError for values out of range, a file that cannot be read, and an
  /// eye below the ground.
  explicit Scene(const SceneDescription& description);

  /// Reads and loads a scene.toml; renderer/MANUAL.md describes its keys. File names in it are
  /// relative to it. Throws InputError "FILE:LINE: key ..." for a malformed file, and as the
  /// constructor does.
  [[nodiscard]] static Scene Read(const std::filesystem::path& file);

  /// Loads the text of a scene.toml. Throws InputError as Read() does.
  /// @param text    of the scene.
  /// @param folder  to which file names in the text are relative.
  [[nodiscard]] static Scene FromToml(std::string_view text, const std::filesystem::path& folder);

  /// Returns the view of the description or the file.
  [[nodiscard]] const View& view() const;

  /// Renders a still on all processors. Its bytes do not depend on their number. Pictures of whole
  /// scenes are compared with stored ones by golden_test. A lens, a polariser and a shutter of a
  /// scene file belong to every view. Throws InputError for a view or options out of range, an
  /// unknown layer, and an eye below the ground, and Cancelled if `progress` ends the work.
  /// @param view      place and camera.
  /// @param time      of the picture.
  /// @param options   see there.
  /// @param progress  receives the fraction of the pixels that are done, after light and shadows of
  ///   the moment are known; may be empty.
  [[nodiscard]] HdrImage Render(const View& view, const UtcTime& time,
                                const StillOptions& options = {},
                                const ProgressFunction& progress = {}) const;

  /// Renders a still of view().
  [[nodiscard]] HdrImage Render(const UtcTime& time, const StillOptions& options = {},
                                const ProgressFunction& progress = {}) const;

  /// Returns the illuminance of sun, moon and sky on a horizontal plane at the eye, without terrain
  /// [lx]. Throws InputError for a view out of range and an eye below the ground.
  [[nodiscard]] double HorizontalIlluminance(const View& view, const UtcTime& time) const;

  /// Returns the illuminance at the eye of view() [lx].
  [[nodiscard]] double HorizontalIlluminance(const UtcTime& time) const;

  /// Returns the message of the terrain loader, for example about filled voids; empty if there is
  /// none.
  [[nodiscard]] const std::string& terrain_message() const;

 private:
  struct State;
  explicit Scene(std::shared_ptr<const State> state);
  std::shared_ptr<const State> state_;
};

}  // namespace alpenglow
