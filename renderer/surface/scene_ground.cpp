// SPDX-License-Identifier: MIT
#include "renderer/surface/scene_ground.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/math/angles.h"
#include "atmosphere/math/constants.h"
#include "renderer/elevation/mesh.h"
#include "renderer/procedural_mountains/procedural_mountains.h"
#include "renderer/scene/scene_clouds.h"
#include "renderer/scene/scene_options.h"
#include "renderer/terrain/loaded_heights.h"
#include "renderer/visibility/sunlit_path.h"

namespace alpenglow::renderer {
namespace {

constexpr double kReach_m = 20000.0;  // above any mountain, below any trench

/// Returns the vertical of a place in a frame.
glm::dvec3 UpAt(const LocalFrame& frame, const Place& place) {
  const LocalFrame there(frame.ellipsoid(), place);
  return frame.EnuFromEcef(there.EcefFromEnu(Vector<Enu>{glm::dvec3(0.0, 0.0, 1.0)})).xyz;
}

/// Returns the first surface below a point raised by `over_m`, with its height relative to the
/// point.
std::optional<SurfaceUnder> SeenFrom(const Terrain& terrain, const glm::dvec3& point,
                                     const glm::dvec3& up, double over_m) {
  const auto hit = terrain.Intersect(point + over_m * up, -up);
  if (!hit) return std::nullopt;
  return SurfaceUnder{*hit, over_m - hit->distance_m};
}

constexpr double kEarth_m = 6.371e6;

// Returns the distance at which ground of any height may be visible [radians of the earth's curve].
// Refraction extends it by a tenth at most.
double Sight(double eye_m) {
  constexpr double kHighestGround_m = 9000.0, kRefraction = 1.1;
  return kRefraction * (HorizonDip(eye_m) + HorizonDip(kHighestGround_m));
}

struct Span {
  int first, count;
};

// Returns at least two samples of an axis, from half a width before a place to half a width after
// it.
Span Within(double middle, double half, int all) {
  const double first = std::clamp(std::floor(middle - half), 0.0, all - 2.0);
  const double last = std::clamp(std::ceil(middle + half), first + 1.0, all - 1.0);
  return {static_cast<int>(first), static_cast<int>(last - first) + 1};
}

// A circle on the sphere has its greatest extent in longitude away from the latitude of its centre;
// over a pole it includes all longitudes.
Span ColumnsAround(const ElevationGrid& grid, const Place& place, double distance_rad) {
  const bool is_over_pole = distance_rad + std::abs(place.latitude_rad()) >= 0.5 * kPi;
  const double half_rad =
      is_over_pole ? kPi : std::asin(std::sin(distance_rad) / std::cos(place.latitude_rad()));
  const double half = half_rad / grid.step_lon_rad;
  const double centre_rad = grid.west_rad + 0.5 * (grid.columns - 1) * grid.step_lon_rad;
  const double middle =
      0.5 * (grid.columns - 1) +
      std::remainder(place.longitude_rad() - centre_rad, 2.0 * kPi) / grid.step_lon_rad;
  if (!grid.ClosesAroundTheEarth()) return Within(middle, half, grid.columns);
  const double first = std::floor(middle - half);
  const double count = std::max(std::ceil(middle + half) - first, 1.0) + 1.0;
  if (count >= grid.columns) return {0, grid.columns};
  const int column = static_cast<int>(first) % grid.columns;
  return {column < 0 ? column + grid.columns : column, static_cast<int>(count)};
}

// Returns the name of the elevation model in messages.
std::string NameOfModels(const TerrainSource& terrain) {
  return terrain.file.string() + (terrain.more_files.empty() ? "" : " and others");
}

// Returns the height of the eye above the ellipsoid.
double EyeHeight(const Scene& scene, const ElevationGrid& grid) {
  const Height& height = scene.camera.height;
  if (!height.above_ground) return height.value_m;
  const ElevationModel there =
      ReadElevation(scene.terrain.file, scene.terrain.voids, WindowAround(grid, scene.place, 0.0));
  return height.value_m +
         there.grid.HeightAt(scene.place.latitude_rad(), scene.place.longitude_rad()).value_or(0.0);
}

// Returns the grid of all models together, without heights.
ElevationGrid OutlineOf(const LandLattice& lattice) {
  ElevationGrid extent;
  extent.west_rad = lattice.west_rad;
  extent.north_rad = lattice.north_rad;
  extent.step_lon_rad = lattice.step_lon_rad;
  extent.step_lat_rad = lattice.step_lat_rad;
  extent.columns = lattice.last_column + 1;
  extent.rows = lattice.last_row + 1;
  return extent;
}

ModelInSight ReadModelsInSight(const Scene& scene) {
  constexpr int kMostSamples = 1 << 13;
  const auto tiles = std::make_shared<const LandTiles>(LandSourceOf(scene));
  ModelInSight loaded{{}, OutlineOf(tiles->lattice()), ""};
  std::vector<std::string> notes = tiles->notes();
  double eye_m = scene.camera.height.value_m;
  if (scene.camera.height.above_ground) {
    const SampleSize step = SampleSizeAt(tiles->lattice(), scene.place.latitude_rad());
    const double around_m = 2.0 * std::max(step.column_m, step.row_m);
    std::vector<std::string> said_below;
    const auto under_eye =
        ReadHeightsAround(tiles, scene.place, around_m, kMostSamples, said_below);
    if (under_eye)
      eye_m += under_eye->HeightAt(scene.place.latitude_rad(), scene.place.longitude_rad())
                   .value_or(0.0);
  }
  const double sight_m = kEarth_m * Sight(eye_m);
  auto grid = ReadHeightsAround(tiles, scene.place, sight_m, kMostSamples, notes);
  if (grid) loaded.model.grid = std::move(*grid);
  const std::vector<float>& heights = loaded.model.grid.height_m;
  if (std::all_of(heights.begin(), heights.end(), [](float z_m) { return std::isnan(z_m); })) {
    throw InputError(fmt::format("{}: no valid sample within {:.0f} km of the camera",
                                 NameOfModels(scene.terrain), 1e-3 * sight_m));
  }
  loaded.message = fmt::format("{}", fmt::join(notes, "; "));
  return loaded;
}

struct LoadedMesh {
  std::optional<TriangleMesh> mesh;
  std::string message;
  bool is_whole = false;  // a grid without holes
};

/// Builds the mesh of a grid, and checks whether all triangles exist: none is left out beside a
/// void.
LoadedMesh MeshOf(const ElevationGrid& grid, const LocalFrame& frame, std::string message) {
  LoadedMesh loaded{MeshFromElevation(grid, frame), std::move(message)};
  loaded.is_whole = loaded.mesh->triangles.size() == 2 * static_cast<std::size_t>(grid.rows - 1) *
                                                         static_cast<std::size_t>(grid.columns - 1);
  return loaded;
}

// Southern, northern, western and eastern limits of a grid [degrees].
struct GroundRectangle {
  double south, north, west, east;

  explicit GroundRectangle(const ElevationGrid& grid)
      : south(grid.LatitudeOfRow(grid.rows - 1) / kRadiansPerDegree),
        north(grid.north_rad / kRadiansPerDegree),
        west(grid.west_rad / kRadiansPerDegree),
        east(grid.LongitudeOfColumn(grid.columns - 1) / kRadiansPerDegree) {}
};

// Returns whether any part of the model may be above the horizon of an eye, on a sphere.
bool IsInSight(const ElevationGrid& grid, const Place& place, double eye_m) {
  const GroundRectangle model(grid);
  float highest_m = 0.0F;
  for (const float height_m : grid.height_m) highest_m = std::max(highest_m, height_m);
  const double latitude = place.latitude_deg;
  const double longitude = place.longitude_deg;
  const double middle = 0.5 * (model.west + model.east);
  const double from_middle = std::remainder(longitude - middle, 360.0);
  const double half = 0.5 * (model.east - model.west);
  const double beside =
      std::max(std::abs(from_middle) - half, 0.0) * kRadiansPerDegree;  // difference of longitude
  const double nearest = std::clamp(latitude, model.south, model.north) * kRadiansPerDegree;
  const double cosine = std::sin(place.latitude_rad()) * std::sin(nearest) +
                        std::cos(place.latitude_rad()) * std::cos(nearest) * std::cos(beside);
  return std::acos(std::clamp(cosine, -1.0, 1.0)) <
         HorizonDip(eye_m) + HorizonDip(static_cast<double>(highest_m));
}

// A value and a range in degrees, with as many digits, at least 6, as distinguish the limits from a
// value outside.
struct RangeText {
  std::string value, low, high;
};
RangeText TextOfRange(double value, double low, double high) {
  RangeText text;
  for (int digits = 6; digits <= 17; ++digits) {
    const auto written = [&](double number) { return fmt::format("{:.{}g}", number, digits); };
    text = {written(value), written(low), written(high)};
    const bool differs = text.value != text.low && text.value != text.high;
    if (differs || value == low || value == high) break;
  }
  return text;
}

// Throws InputError if an eye relative to the ground is outside the model, or if a free eye is
// outside it and sees none of it.
// @param extent  of the whole model.
// @param seen  the part of the model that has been read.
void RequireEyeOver(const ElevationGrid& extent, const ElevationGrid& seen, const Scene& scene) {
  const Place& place = scene.place;
  if (extent.Covers(place.latitude_rad(), place.longitude_rad())) return;
  const GroundRectangle model(extent);
  const Height& height = scene.camera.height;
  if (!height.above_ground && IsInSight(seen, place, height.value_m)) return;
  const bool swapped_lies_inside = extent.Covers(place.longitude_rad(), place.latitude_rad());
  const RangeText latitude = TextOfRange(place.latitude_deg, model.south, model.north);
  const RangeText longitude = TextOfRange(place.longitude_deg, model.west, model.east);
  throw InputError(fmt::format(
      "the camera at latitude {}, longitude {} is outside {}, which covers latitudes {} "
      "to {} and longitudes {} to {}{}",
      latitude.value, longitude.value, NameOfModels(scene.terrain), latitude.low, latitude.high,
      longitude.low, longitude.high,
      swapped_lies_inside ? "; latitude and longitude seem to be swapped" : ""));
}

std::string Joined(const std::string& one, const std::string& other) {
  return one.empty() || other.empty() ? one + other : one + "; " + other;
}

/// Throws InputError for clouds whose base is below all ground of a grid.
void RequireCloudsOver(const ElevationGrid& grid, const Scene& scene) {
  if (scene.clouds.empty()) return;
  float lowest_m = std::numeric_limits<float>::infinity();
  for (const float height_m : grid.height_m) lowest_m = std::fmin(lowest_m, height_m);
  RequireCloudsOverGround(scene.clouds, static_cast<double>(lowest_m));
}

LoadedMesh LoadMesh(const Scene& scene, const LocalFrame& frame, Progress* progress) {
  if (scene.terrain.kind != TerrainSource::Kind::kNone) Prepare(progress, "terrain");
  switch (scene.terrain.kind) {
    case TerrainSource::Kind::kProceduralMountains: {
      const ElevationGrid range =
          ProceduralMountains(scene.terrain.centre.value_or(scene.place), scene.terrain.range_seed);
      RequireCloudsOver(range, scene);
      Prepare(progress, "mesh");
      return MeshOf(
          range, frame,
          scene.terrain.is_default
              ? "the terrain is made up: no elevation model of the place was named (--dem; or "
                "[terrain] in a scene file, where range = true asks for it)"
              : "");
    }
    case TerrainSource::Kind::kElevationModel: {
      const auto [model, extent, message] = ReadModelInSight(scene);
      RequireEyeOver(extent, model.grid, scene);
      RequireCloudsOver(model.grid, scene);
      Prepare(progress, "mesh");
      return MeshOf(model.grid, frame, Joined(message, NoteOn(model, scene.terrain.file.string())));
    }
    case TerrainSource::Kind::kMesh: {
      MeshModel read = ReadMesh(scene.terrain.file, scene.terrain.up);
      return {std::move(read.mesh), std::move(read.message)};
    }
    case TerrainSource::Kind::kNone:
      break;
  }
  return {};
}

// Returns the heights of the ground below the eye; empty on the bare ellipsoid.
std::optional<GroundHeights> GroundAtFoot(const std::optional<Terrain>& terrain) {
  if (!terrain) return std::nullopt;
  return GroundHeightsAlong(*terrain, glm::dvec3(0.0), glm::dvec3(0.0, 0.0, 1.0));
}

std::string TextOf(const Place& place) {
  return fmt::format("the eye at {:.6f}, {:.6f}", place.latitude_deg, place.longitude_deg);
}

/// Throws InputError if the place is too far from the scene's place.
FrameTransform FromPlace(const SceneGround& ground, const Place& place) {
  const FrameTransform from_place(ground.frame, LocalFrame(ground.frame.ellipsoid(), place));
  constexpr double kFarthest_m = 500e3;
  const double radius_m = ground.frame.ellipsoid().equatorial_radius_m;
  const double along_m = radius_m * std::acos(std::min(from_place.axes()[2].z, 1.0));
  if (along_m > kFarthest_m) {
    throw InputError(
        fmt::format("{} is {:.0f} km from the scene's place; at most {:.0f} km can be "
                    "shown from one frame",
                    TextOf(place), 1e-3 * along_m, 1e-3 * kFarthest_m));
  }
  return from_place;
}

}  // namespace

std::optional<GroundHeights> GroundHeightsAlong(const Terrain& terrain, const glm::dvec3& point,
                                                const glm::dvec3& up) {
  const auto from_above = terrain.Intersect(point + kReach_m * up, -up, 2.0 * kReach_m);
  if (!from_above) return std::nullopt;
  const double highest_m = kReach_m - from_above->distance_m;
  const auto from_below = terrain.Intersect(point - kReach_m * up, up, 2.0 * kReach_m);
  // One ray may hit an edge that the other just misses; the surface that was hit exists.
  const double lowest_m = from_below ? from_below->distance_m - kReach_m : highest_m;
  return GroundHeights{std::min(lowest_m, highest_m), highest_m};
}

std::optional<GroundHeights> GroundHeightsAt(const Terrain& terrain, const LocalFrame& frame,
                                             const Place& place) {
  Place foot = place;
  foot.height_m = 0.0;
  return GroundHeightsAlong(terrain, frame.EnuFromGeodetic(foot).xyz, UpAt(frame, foot));
}

std::optional<SurfaceUnder> SurfaceUnderPoint(const Terrain& terrain, const glm::dvec3& point,
                                              const glm::dvec3& up) {
  constexpr double kRounding_m = 0.02;  // a point on a surface counts as above it
  const auto below = SeenFrom(terrain, point, up, kRounding_m);
  return below ? below : SeenFrom(terrain, point, up, kReach_m);
}

std::optional<double> GroundUnderEye(const Terrain& terrain, const LocalFrame& frame,
                                     const Place& place) {
  const auto surface =
      SurfaceUnderPoint(terrain, frame.EnuFromGeodetic(place).xyz, UpAt(frame, place));
  if (!surface) return std::nullopt;
  return place.height_m + surface->height_m;
}

double HorizonDip(double height_m) {
  const double over_m = std::max(height_m, 0.0);
  return DipOfHorizon(over_m, kEarth_m + over_m);
}

GridWindow WindowAround(const ElevationGrid& grid, const Place& place, double distance_rad) {
  const Span rows = Within((grid.north_rad - place.latitude_rad()) / grid.step_lat_rad,
                           distance_rad / grid.step_lat_rad, grid.rows);
  const Span columns = ColumnsAround(grid, place, distance_rad);
  return {columns.first, rows.first, columns.count, rows.count};
}

ModelInSight ReadModelInSight(const Scene& scene) {
  if (scene.terrain.HasManyModels()) return ReadModelsInSight(scene);
  constexpr double kManySamples = 1 << 25;
  const std::filesystem::path& file = scene.terrain.file;
  ElevationGrid all = ReadElevationExtent(file);
  const double samples = static_cast<double>(all.columns) * static_cast<double>(all.rows);
  if (samples <= kManySamples || !CanBeCut(file)) {
    return {ReadElevation(file, scene.terrain.voids), std::move(all), ""};
  }
  const double sight = Sight(EyeHeight(scene, all));
  const GridWindow window = WindowAround(all, scene.place, sight);
  ModelInSight loaded{ReadElevation(file, scene.terrain.voids, window), all, ""};
  if (loaded.model.voids == loaded.model.grid.height_m.size()) {
    throw InputError(fmt::format("{}: has no valid sample within {:.0f} km of the camera",
                                 file.string(), 1e-3 * kEarth_m * sight));
  }
  if (window.columns < all.columns || window.rows < all.rows) {
    loaded.message = fmt::format(
        "{}: of {} x {} samples {} x {} are read, those within {:.0f} km of "
        "the camera",
        file.string(), all.columns, all.rows, window.columns, window.rows, 1e-3 * kEarth_m * sight);
  }
  return loaded;
}

Ellipsoid EllipsoidOf(const Medium& medium) {
  return medium.follows_wgs84 ? kWgs84 : Ellipsoid{medium.planet_radius_m, 0.0};
}

SceneGround LoadGround(const Scene& scene, Progress* progress) {
  Place foot = scene.place;
  foot.height_m = 0.0;
  const LocalFrame frame(EllipsoidOf(scene.medium), foot);
  LoadedMesh loaded = LoadMesh(scene, frame, progress);
  std::optional<Terrain> terrain;
  if (loaded.mesh) Prepare(progress, "tree of triangles");
  if (loaded.mesh) terrain.emplace(std::move(*loaded.mesh));
  const auto under_eye = GroundAtFoot(terrain);
  const GroundHeights ground = under_eye.value_or(GroundHeights{0.0, 0.0});
  const Height& height = scene.camera.height;
  const double eye = height.above_ground ? ground.highest_m + height.value_m : height.value_m;
  if (eye < ground.lowest_m) {
    throw InputError(fmt::format("camera.height_m is {:.1f}; the ground there is at {:.1f} m", eye,
                                 ground.lowest_m));
  }
  Prepare(progress, "air");  // name of the next step
  const bool from_file = scene.terrain.kind == TerrainSource::Kind::kMesh;
  const bool is_one_surface = !from_file || !terrain || IsOneSurface(*terrain);
  if (!is_one_surface) {
    if (!loaded.message.empty()) loaded.message += "; ";
    loaded.message += fmt::format(
        "{}: the mesh has overhangs; sunlight in the air under them is found by occlusion rays",
        scene.terrain.file.string());
  }
  return {frame,
          std::move(terrain),
          eye,
          std::move(loaded.message),
          is_one_surface,
          loaded.is_whole && under_eye.has_value()};
}

FrameTransform FromSceneEye(const SceneGround& ground) {
  return FrameTransform({0.0, 0.0, ground.eye_height_m});
}

void RequireOverGround(const Place& eye, double ground_m) {
  if (eye.height_m >= ground_m) return;
  throw InputError(fmt::format("{} is {:.1f} m high; the ground there is at {} m", TextOf(eye),
                               eye.height_m,
                               ground_m == 0.0 ? "0" : fmt::format("{:.1f}", ground_m)));
}

FrameTransform FromEyeAt(const SceneGround& ground, const Place& place) {
  const FrameTransform from_eye = FromPlace(ground, place);
  if (!ground.terrain) {
    RequireOverGround(place, 0.0);
  } else if (const auto there = GroundHeightsAt(*ground.terrain, ground.frame, place)) {
    RequireOverGround(place, there->lowest_m);
  }
  return from_eye;
}

double GroundHeightUnder(const SceneGround& ground, const Place& place) {
  if (!ground.terrain) return 0.0;
  FromPlace(ground, place);  // throws if the place is too far away
  const auto there = GroundHeightsAt(*ground.terrain, ground.frame, place);
  return there ? there->highest_m : 0.0;
}

MovingCamera CameraOn(const SceneGround& ground, const Camera& camera,
                      std::span<const CameraPose> poses, int width, int height) {
  if (poses.empty()) return CameraRays(camera, width, height, FromSceneEye(ground));
  std::vector<CameraRays> steps;
  for (const CameraPose& pose : poses) {
    Camera there = camera;
    there.heading_rad = pose.heading_rad;
    there.pitch_rad = pose.pitch_rad;
    there.roll_rad = pose.roll_rad;
    there.fov_rad = pose.fov_rad;
    steps.emplace_back(there, width, height, FromEyeAt(ground, pose.place));
  }
  return MovingCamera(std::move(steps));
}

}  // namespace alpenglow::renderer
