// SPDX-License-Identifier: MIT
// The description of a scene: place, time, camera, air, clouds, ground and lamps; and the reader of
// scene.toml.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "atmosphere/medium/medium.h"
#include "atmosphere/time_place/geodesy.h"
#include "atmosphere/time_place/time.h"
#include "renderer/clouds/cloud_options.h"
#include "renderer/elevation/elevation.h"
#include "renderer/elevation/mesh.h"
#include "renderer/scene/cloud_file.h"
#include "renderer/scene/sphere_material.h"
#include "renderer/scene/volume_grid.h"

namespace alpenglow::renderer {

/// A height above the ellipsoid or above the ground.
struct Height {
  double value_m = 2.0;
  bool above_ground = true;

  bool operator==(const Height&) const = default;
};

/// A lens of finite aperture; cameras without one are pinholes.
struct ThinLens {
  double f_number;
  double focal_length_m;
  double focus_m;                   // distance to the plane of sharp focus, across the view axis
  int blades = 0;                   // blades of the iris; 0: round
  double blade_rotation_rad = 0.0;  // angle of a corner from the right, counterclockwise seen from
                                    // behind
};

/// A camera; the eye is at the scene's place.
struct Camera {
  Height height;
  double heading_rad = 0.0;             // clockwise from north
  double pitch_rad = 0.0;               // positive is up
  double roll_rad = 0.0;                // clockwise seen from behind
  double fov_rad = 1.0471975511965976;  // horizontal, default 60 degrees; over 179 degrees: see
                                        // IsPanorama()
  std::optional<ThinLens> lens;
  /// Transmission axis of a linear polariser in front of the lens, clockwise from the picture's
  /// vertical as seen from behind.
  std::optional<double> polariser_rad;
  /// Exposure time [s] of the sky: stars and the moon draw trails, the middle of which is at the
  /// time of the picture. Everything else stands still.
  double shutter_s = 0.0;

  /// Returns whether the camera is a panorama of all directions (2 pi); else it is a perspective of
  /// at most 179 degrees.
  [[nodiscard]] bool IsPanorama() const;
};

/// Source of the ground geometry.
struct TerrainSource {
  enum class Kind {
    kProceduralMountains,  // ProceduralMountains
    kElevationModel,       // file, see ReadElevation
    kMesh,                 // file, see ReadMesh
    kNone,                 // the ellipsoid alone
  };
  Kind kind = Kind::kProceduralMountains;
  std::filesystem::path file;
  VoidPolicy voids = VoidPolicy::kFill;
  UpAxis up = UpAxis::kZ;                      // up axis of the mesh
  std::optional<Place> centre = std::nullopt;  // centre of the range; empty: the scene's
                                               // place
  std::uint32_t range_seed = 0;                // seed of the range
  bool is_default = true;                 // terrain was not specified: the range stands in for it
  std::filesystem::path colour = {};      // image over the terrain, see ColourDrape; empty: none
  std::filesystem::path land_cover = {};  // land cover map; excludes `colour`
  std::vector<std::filesystem::path> more_files = {};  // further elevation models, and folders of
                                                       // them: see LandSource

  /// Returns whether the heights are those of several files: `file` is a folder, or there are more.
  [[nodiscard]] bool HasManyModels() const {
    return kind == Kind::kElevationModel &&
           (!more_files.empty() || std::filesystem::is_directory(file));
  }

  /// Returns whether the ground has relief finer than its triangles, which then connect samples of
  /// elevation. A mesh file has only its own triangles.
  [[nodiscard]] bool HasFineRelief() const { return kind != Kind::kMesh; }

  /// Returns `colour` or `land_cover`, whichever is given.
  [[nodiscard]] const std::filesystem::path& Drape() const {
    return colour.empty() ? land_cover : colour;
  }
};

inline constexpr double kUsualWind_m_per_s = 5.0;
inline constexpr std::pair kWindsOverWater_m_per_s{0.0, 20.0};

/// Material of the ground and its reflectance model (reflectance.h).
struct GroundCover {
  enum class Kind {
    kMountain,    // forest, meadow, rock, snow by altitude and slope (MountainSurface); Lambertian
    kLambert,     // one colour, smooth
    kOrenNayar,   // one colour, rough
    kBlinnPhong,  // one colour under a glossy coat
    kWater,
    kSnow,
  };
  Kind kind = Kind::kMountain;
  std::array<double, 3> albedo{0.2, 0.2, 0.2};  // linear sRGB, of kLambert to kBlinnPhong
  double roughness = 0.5;                       // of kOrenNayar and kBlinnPhong, see their classes
  double reflectance = 0.04;                    // of the coat at normal incidence
  /// Wind over water, see Water; empty: that of the scene's report, or kUsualWind_m_per_s.
  std::optional<double> wind_m_per_s;
  double grain_diameter_m = 5e-4;     // of snow
  double wetness = 0.0;               // of kMountain to kOrenNayar, see WetAlbedo
  std::optional<double> sea_level_m;  // ground at or below this level is water
};

/// A lamp.
struct Light {
  enum class Type { kPoint, kSpot };
  Type type = Type::kPoint;
  Place place;  // with height 0
  Height height;
  std::optional<double> intensity_cd;        // maximum; empty: from the IES file
  double temperature_k = 3000.0;             // of a black body with the lamp's colour
  double radius_m = 0.1;                     // radius of the luminous sphere
  std::optional<std::filesystem::path> ies;  // angular distribution of the light, see ReadIes
  double heading_rad = 0.0;                  // of the axis of a spot or of an IES file
  double pitch_rad = 0.0;
  double inner_rad = 0.0;  // half angles of a spot: full intensity inside the first, none outside
                           // the second
  double outer_rad = 0.0;
};

/// A scattering layer of exponential density over the ellipsoid (ExponentialLayer).
/// Light of lamps is scattered once in it, light of sun and sky to all orders (LayerLight).
struct MediumLayer {
  double extinction_per_m = 0.0;        // at base_height_m
  double scale_height_m = 0.0;          // may be infinite
  std::optional<double> base_height_m;  // over the ellipsoid; empty: the ground under the eye
  double albedo = 1.0;
  PhaseFunction phase;
};

/// A node of a transfer function, see TransferFunction.
struct TransferNode {
  double value = 0.0;  // of the grid
  double extinction_per_m = 0.0;
  std::array<double, 3> albedo{1.0, 1.0, 1.0};  // of single scattering, linear sRGB
  double temperature_k = 0.0;                   // of black-body emission; 0: none

  bool operator==(const TransferNode&) const = default;
};

/// A local participating medium, see LocalVolume: smoke, a bank of droplets, a glowing gas. Lists
/// hold one value, or one per wavelength of the medium.
struct Volume {
  VolumePlacement::Shape shape = VolumePlacement::Shape::kBox;
  Place place;                                  // with height 0
  Height height;                                // height of the underside
  std::array<double, 3> size_m{};               // across its heading, along it, up
  double heading_rad = 0.0;                     // clockwise from north
  std::optional<double> scale_height_m;         // empty: homogeneous, or a grid
  std::filesystem::path grid;                   // see ReadNrrd and ReadRawGrid; empty: none
  std::optional<std::array<int, 3>> grid_size;  // of a raw grid
  /// With nodes the grid has values of any quantity, see ClassifiedVolume, and extinction, albedo and
  /// emission are those of the nodes. Values increase.
  std::vector<TransferNode> transfer;
  std::vector<double> extinction_per_m{0.0};  // at density 1
  std::vector<double> albedo{1.0};
  std::vector<double> emission_per_m{0.0};  // W m^-2 sr^-1 nm^-1 per metre at density 1
  std::optional<double> temperature_k;  // of black-body emission by Kirchhoff's law; empty: none
  PhaseFunction phase;
  ScatteringOrders orders = ScatteringOrders::kAll;
};

/// The map of photons in media: beams, which have less noise, or points where they are scattered.
enum class PhotonMap { kBeams, kPoints };

inline constexpr EnumNames kPhotonMaps{
    {std::pair{PhotonMap::kBeams, "beams"}, {PhotonMap::kPoints, "points"}}};

/// A sphere of glass or a mirror, see SpecularSphere.
struct SceneObject {
  std::string name;          // in messages: "scene.toml: object[0]"
  Place place;               // with height 0
  Height height{0.0, true};  // of its underside
  double radius_m = 1.0;
  SphereMaterial material = SphereMaterial::kGlass;
  double index = 1.5;         // of refraction, of glass
  double photons = 100000.0;  // for its light in media; a whole number
  PhotonMap photon_map = PhotonMap::kBeams;
};

/// A layer of clouds over the whole scene, or a field of others; see CloudFieldsOf.
struct SceneCloud {
  std::string name;            // in messages: "scene.toml: cloud[0]"
  CloudOptions options;        // of a grid: the genus, the wind and the base alone
  std::filesystem::path grid;  // see ReadCloudField; empty: a layer of the genus
  /// These options say how a grid is read; its origin follows from the base and from `middle`. The base of NRRD and raw
  /// files is that of their lowest samples, that of OpenVDB is the height of z = 0, and text has none.
  CloudFileOptions file;
  /// The base is a height above the ground at the scene's place, not above the ellipsoid; see
  /// OverEllipsoid. It is the default of genera with low bases.
  bool is_over_ground = false;
  std::optional<Place> middle;  // of a grid; empty: the place of the scene
};

/// The weather by which clouds, fog and air of a scene were made, see InWeather.
struct SceneWeather {
  std::optional<std::string> metar;        // a report, see ReadMetar
  std::optional<double> station_height_m;  // of its station, above the ellipsoid
  std::vector<std::string> notes;          // see NotesOnReport
};

struct Scene {
  Place place;                      // with height 0
  std::optional<std::string> zone;  // IANA name
  std::optional<UtcTime> time;
  Camera camera;
  Medium medium;  // default: preset "earth"
  SceneWeather weather;
  TerrainSource terrain;
  GroundCover ground;
  std::vector<Light> lights;
  std::vector<MediumLayer> layers;  // at most one
  std::vector<Volume> volumes;
  std::vector<SceneObject> objects;
  std::vector<SceneCloud> clouds;
  /// Day (UTC, modified Julian) from which clouds count their time; empty: that of `time`. See
  /// CloudTime_s.
  std::optional<int> cloud_day;
  /// Brightness of the zenith on a moonless night with light pollution [V magnitudes per square
  /// arcsecond]; empty: no light pollution.
  std::optional<double> town_zenith;
};

/// Reads scene.toml. File names in it are relative to it. Throws InputError "file:line: key ..."
/// for unknown keys (with the nearest known one), wrong types, values out of range, a missing
/// place, malformed text, and errors of ReadMedium. Files of the terrain are not opened here.
/// @param use  of the medium.
/// @param weather  that of the command line, which replaces weather, clouds and fog of the file.
[[nodiscard]] Scene ReadScene(const std::filesystem::path& file,
                              const MediumUse& use = kForPictures,
                              const SceneWeather& weather = {});

/// Reads a scene from text, like ReadScene. `origin` replaces the file's name in messages, and file
/// names are relative to `folder`.
[[nodiscard]] Scene SceneFromToml(std::string_view text, const std::string& origin,
                                  const std::filesystem::path& folder,
                                  const MediumUse& use = kForPictures,
                                  const SceneWeather& weather = {});

/// Returns a camera from checked values: heading [-360, 360], pitch [-90, 90], roll [-180, 180],
/// fov [0.1, 179] or 360, all in degrees. Throws InputError that names the value with `prefix` in
/// front ("heading" and so on).
[[nodiscard]] Camera CameraFromDegrees(const Height& height, double heading, double pitch,
                                       double roll, double fov, const std::string& prefix = "");

}  // namespace alpenglow::renderer
