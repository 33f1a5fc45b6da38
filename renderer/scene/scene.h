// SPDX-License-Identifier: MIT
// What a picture is of: place, time, camera, air, ground, lamps; and the file that says so.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "atmosphere/air/medium.h"
#include "atmosphere/sun/geodesy.h"
#include "atmosphere/sun/time.h"
#include "renderer/scene/local_volume.h"
#include "renderer/terrain/elevation.h"
#include "renderer/terrain/mesh.h"

namespace alpenglow::renderer {

/// A height over the ellipsoid or over the ground below.
struct Height {
  double value_m = 2.0;
  bool above_ground = true;

  bool operator==(const Height&) const = default;
};

/// The lens, when it is more than a pinhole.
struct ThinLens {
  double f_number;
  double focal_length_m;
  double focus_m;                   // distance of the plane across the view axis that is sharp
  int blades = 0;                   // of the iris; 0: it is round
  double blade_rotation_rad = 0.0;  // of a corner from the right, counterclockwise from behind
};

/// The eye stands at the scene's place.
struct Camera {
  Height height;
  double heading_rad = 0.0;             // clockwise from north
  double pitch_rad = 0.0;               // up is positive
  double roll_rad = 0.0;                // clockwise seen from behind
  double fov_rad = 1.0471975511965976;  // horizontal, 60 degrees; over 179 degrees: see below
  std::optional<ThinLens> lens;
  /// A linear polariser before the lens: its transmission axis, clockwise from the picture's
  /// vertical as seen from behind.
  std::optional<double> polariser_rad;
  /// Seconds that the shutter is open for the sky: stars and the moon draw trails, the middle of
  /// which is at the time of the picture. All else stands still.
  double shutter_s = 0.0;

  /// 2 pi: a panorama, all directions; else a perspective of at most 179 degrees.
  [[nodiscard]] bool IsPanorama() const;
};

/// Where the ground comes from.
struct TerrainSource {
  enum class Kind {
    kBuiltInRange,    // BuiltInRange
    kElevationModel,  // file, see ReadElevation
    kMesh,            // file, see ReadObj
    kNone,            // the ellipsoid alone
  };
  Kind kind = Kind::kBuiltInRange;
  std::filesystem::path file;
  VoidPolicy voids = VoidPolicy::kFill;
  UpAxis up = UpAxis::kZ;                                 // of the mesh
  std::optional<GeodeticPosition> centre = std::nullopt;  // of the range; nothing: scene's place
  std::uint32_t range_seed = 0;                           // of the range
  bool is_default = true;  // nothing was said about the terrain: the range stands in for it
  std::filesystem::path colour = {};      // over it, see ColourDrape; empty: none
  std::filesystem::path land_cover = {};  // as colour, and not both

  /// The ground has relief finer than its triangles where they join samples of elevation. A mesh of
  /// a file has only its own triangles.
  [[nodiscard]] bool HasFineRelief() const { return kind != Kind::kMesh; }

  /// What of both is given.
  [[nodiscard]] const std::filesystem::path& Drape() const {
    return colour.empty() ? land_cover : colour;
  }
};

/// What the ground is made of, and how it sends light on (reflectance.h).
struct GroundCover {
  enum class Kind {
    kMountain,    // forest, meadow, rock, snow by altitude and slope (MountainSurface); Lambertian
    kLambert,     // one colour, even
    kOrenNayar,   // one colour, rough
    kBlinnPhong,  // one colour under a glossy coat
    kWater,
    kSnow,
  };
  Kind kind = Kind::kMountain;
  std::array<double, 3> albedo{0.2, 0.2, 0.2};  // linear sRGB, of kLambert to kBlinnPhong
  double roughness = 0.5;                       // of kOrenNayar and kBlinnPhong, see there
  double reflectance = 0.04;                    // of the coat at normal incidence
  double wind_m_per_s = 5.0;                    // over water
  double grain_diameter_m = 5e-4;               // of snow
  double wetness = 0.0;                         // of kMountain to kOrenNayar, see WetAlbedo
  std::optional<double> sea_level_m;            // ground that is not higher is water
};

/// A lamp.
struct Light {
  enum class Type { kPoint, kSpot };
  Type type = Type::kPoint;
  double latitude_rad = 0.0;
  double longitude_rad = 0.0;
  Height height;
  std::optional<double> intensity_cd;        // the largest; nothing: as the IES file says
  double temperature_k = 3000.0;             // of the black body whose colour it has
  double radius_m = 0.1;                     // of the luminous sphere that it is
  std::optional<std::filesystem::path> ies;  // how its light is distributed, see ReadIes
  double heading_rad = 0.0;                  // of the axis of a spot or of an IES file
  double pitch_rad = 0.0;
  double inner_rad = 0.0;  // half angles of a spot: full inside the first, none outside the second
  double outer_rad = 0.0;
};

/// Fog of exponential density over the ellipsoid. It scatters the light of lamps once, that of sun
/// and sky to all orders (FogLight).
struct Fog {
  double extinction_per_m = 0.0;        // at its base
  double scale_height_m = 0.0;          // may be infinite
  std::optional<double> base_height_m;  // over the ellipsoid; nothing: the ground under the eye
  double albedo = 1.0;
  PhaseFunction phase;
};

/// A body of air of its own, see LocalVolume: smoke, a fog bank, a glowing gas. Lists hold one
/// value, or one per wavelength of the medium.
struct Volume {
  VolumePlacement::Shape shape = VolumePlacement::Shape::kBox;
  double latitude_rad = 0.0;
  double longitude_rad = 0.0;
  Height height;                                // of its underside
  std::array<double, 3> size_m{};               // across its heading, along it, up
  double heading_rad = 0.0;                     // clockwise from north
  std::optional<double> scale_height_m;         // nothing: homogeneous, or a grid
  std::filesystem::path grid;                   // see ReadNrrd and ReadRawGrid; empty: none
  std::optional<std::array<int, 3>> grid_size;  // of a raw grid
  std::vector<double> extinction_per_m{0.0};    // where density is 1
  std::vector<double> albedo{1.0};
  std::vector<double> emission_per_m{0.0};  // W m^-2 sr^-1 nm^-1 a metre where density is 1
  std::optional<double> temperature_k;      // glows as a black body as far as it absorbs
  PhaseFunction phase;
};

struct Scene {
  GeodeticPosition place;           // height 0
  std::optional<std::string> zone;  // IANA name
  std::optional<UtcInstant> time;
  Camera camera;
  Medium medium;  // "earth" when nothing is said
  TerrainSource terrain;
  GroundCover ground;
  std::vector<Light> lights;
  std::optional<Fog> fog;
  std::vector<Volume> volumes;
  /// Of the zenith of a moonless night over the lamps of towns [V magnitudes a square arcsecond];
  /// nothing: there are none.
  std::optional<double> town_zenith;
};

/// Reads scene.toml. Names of files in it are relative to it. Throws InputError "file:line: key
/// ..." for unknown keys (with the nearest known one), wrong types, values out of range, a missing
/// place, malformed text, and what ReadMedium refuses. Files of the terrain are not opened here.
[[nodiscard]] Scene ReadScene(const std::filesystem::path& file);

/// As ReadScene, from text; `origin` stands in messages where the file's name would, and names of
/// files are relative to `folder`.
[[nodiscard]] Scene SceneFromToml(std::string_view text, const std::string& origin,
                                  const std::filesystem::path& folder);

/// Checked values of a camera: heading [-360, 360], pitch [-90, 90], roll [-180, 180], fov [0.1,
/// 179] or 360, all in degrees. Throws InputError naming the value as `prefix`heading and so on.
[[nodiscard]] Camera CameraFromDegrees(const Height& height, double heading, double pitch,
                                       double roll, double fov, const std::string& prefix = "");

}  // namespace alpenglow::renderer
