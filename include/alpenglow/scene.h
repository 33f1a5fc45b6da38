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
#include <vector>

#include <alpenglow/atmosphere.h>
#include <alpenglow/export.h>
#include <alpenglow/image.h>
#include <alpenglow/place_time.h>

namespace ALPENGLOW_EXPORT alpenglow {

/// A camera. Its eye is at the place of the scene.
struct Camera {
  double height_m = 2.0;               ///< above the ground, or above the ellipsoid
  bool height_is_above_ground = true;  ///< false: height_m is above the ellipsoid
  double heading_deg = 0.0;            ///< clockwise from north, in [-360, 360]
  double pitch_deg = 0.0;              ///< positive is up, in [-90, 90]
  double roll_deg = 0.0;               ///< clockwise as seen from behind, in [-180, 180]
  double fov_deg = 60.0;               ///< horizontal, in [0.1, 179], or 360 for a panorama
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
  Place place;            ///< of the eye; its height_m is not used, see Camera
  Camera camera;          ///< see there
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
  std::vector<std::string> layers;
};

/// A scene whose terrain is loaded and whose air is solved; it renders stills of any time.
/// Immutable; copies share their memory.
class Scene {
 public:
  /// Loads a scene. Throws InputError for values out of range, a file that cannot be read, and an
  /// eye below the ground.
  explicit Scene(const SceneDescription& description);

  /// Reads and loads a scene.toml; renderer/MANUAL.md describes its keys. File names in it are
  /// relative to it. Throws InputError "FILE:LINE: key ..." for a malformed file, and as the
  /// constructor does.
  [[nodiscard]] static Scene Read(const std::filesystem::path& file);

  /// Renders a still on all processors. Its bytes do not depend on their number. Pictures of whole
  /// scenes are compared with stored ones by golden_test. Throws InputError for options out of
  /// range and an unknown layer.
  [[nodiscard]] HdrImage Render(const UtcTime& time, const StillOptions& options = {}) const;

  /// Returns the illuminance of sun, moon and sky on a horizontal plane at the eye, without terrain
  /// [lx].
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
