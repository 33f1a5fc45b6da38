// SPDX-License-Identifier: MIT
#include "renderer/ground/scene_ground.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "atmosphere/number/constants.h"
#include "atmosphere/text/error.h"
#include "renderer/ground/ground_heights.h"
#include "renderer/ground/model_in_sight.h"
#include "renderer/shadow/sun_probes.h"
#include "renderer/terrain/built_in_range.h"
#include "renderer/terrain/obj_file.h"

namespace alpenglow::renderer {
namespace {

struct LoadedMesh {
  std::optional<TriangleMesh> mesh;
  std::string message;
  bool is_whole = false;  // a grid without holes
};

/// Whether a grid's triangles are all there: none is left out beside a void.
LoadedMesh MeshOf(const ElevationGrid& grid, const LocalFrame& frame, std::string message) {
  LoadedMesh loaded{MeshFromElevation(grid, frame), std::move(message)};
  loaded.is_whole = loaded.mesh->triangles.size() == 2 * static_cast<std::size_t>(grid.rows - 1) *
                                                         static_cast<std::size_t>(grid.columns - 1);
  return loaded;
}

// South, north, west and east ends of a grid [degrees].
struct GroundRectangle {
  double south, north, west, east;

  explicit GroundRectangle(const ElevationGrid& grid)
      : south(grid.LatitudeOfRow(grid.rows - 1) / kRadiansPerDegree),
        north(grid.north_rad / kRadiansPerDegree),
        west(grid.west_rad / kRadiansPerDegree),
        east(grid.LongitudeOfColumn(grid.columns - 1) / kRadiansPerDegree) {}
};

// Whether anything of the model may stand over the horizon of an eye, on a sphere.
bool IsInSight(const ElevationGrid& grid, const GeodeticPosition& place, double eye_m) {
  const GroundRectangle model(grid);
  float highest_m = 0.0F;
  for (const float height_m : grid.height_m) highest_m = std::max(highest_m, height_m);
  const double latitude = place.latitude_rad / kRadiansPerDegree;
  const double longitude = place.longitude_rad / kRadiansPerDegree;
  const double middle = 0.5 * (model.west + model.east);
  const double from_middle = std::remainder(longitude - middle, 360.0);
  const double half = 0.5 * (model.east - model.west);
  const double beside =
      std::max(std::abs(from_middle) - half, 0.0) * kRadiansPerDegree;  // in longitude
  const double nearest = std::clamp(latitude, model.south, model.north) * kRadiansPerDegree;
  const double cosine = std::sin(place.latitude_rad) * std::sin(nearest) +
                        std::cos(place.latitude_rad) * std::cos(nearest) * std::cos(beside);
  return std::acos(std::clamp(cosine, -1.0, 1.0)) <
         HorizonDip(eye_m) + HorizonDip(static_cast<double>(highest_m));
}

// A range of degrees in as many digits, 6 at least, as tell its ends from a value outside.
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

// An eye that stands on the ground stands on the model's; one that flies sees some of it.
// @param extent  of the whole model; seen: what has been read of it.
void RequireEyeOver(const ElevationGrid& extent, const ElevationGrid& seen, const Scene& scene) {
  const GeodeticPosition& place = scene.place;
  if (extent.Covers(place.latitude_rad, place.longitude_rad)) return;
  const GroundRectangle model(extent);
  const Height& height = scene.camera.height;
  if (!height.above_ground && IsInSight(seen, place, height.value_m)) return;
  const bool swapped_lies_inside = extent.Covers(place.longitude_rad, place.latitude_rad);
  const RangeText latitude =
      TextOfRange(place.latitude_rad / kRadiansPerDegree, model.south, model.north);
  const RangeText longitude =
      TextOfRange(place.longitude_rad / kRadiansPerDegree, model.west, model.east);
  throw InputError(fmt::format(
      "the camera at latitude {}, longitude {} is outside {}, which covers latitudes {} "
      "to {} and longitudes {} to {}{}",
      latitude.value, longitude.value, scene.terrain.file.string(), latitude.low, latitude.high,
      longitude.low, longitude.high,
      swapped_lies_inside ? "; latitude and longitude seem to be swapped" : ""));
}

std::string Joined(const std::string& one, const std::string& other) {
  return one.empty() || other.empty() ? one + other : one + "; " + other;
}

LoadedMesh LoadMesh(const Scene& scene, const LocalFrame& frame, Progress* progress) {
  if (scene.terrain.kind != TerrainSource::Kind::kNone) Prepare(progress, "terrain");
  switch (scene.terrain.kind) {
    case TerrainSource::Kind::kBuiltInRange: {
      const ElevationGrid range =
          BuiltInRange(scene.terrain.centre.value_or(scene.place), scene.terrain.range_seed);
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
      Prepare(progress, "mesh");
      return MeshOf(model.grid, frame, Joined(message, NoteOn(model, scene.terrain.file.string())));
    }
    case TerrainSource::Kind::kMesh: {
      ObjMesh read = ReadObj(scene.terrain.file, scene.terrain.up);
      return {std::move(read.mesh), std::move(read.message)};
    }
    case TerrainSource::Kind::kNone:
      break;
  }
  return {};
}

// At the foot of the eye; nothing on the bare ellipsoid.
std::optional<GroundHeights> GroundAtFoot(const std::optional<Terrain>& terrain) {
  if (!terrain) return std::nullopt;
  return GroundHeightsAlong(*terrain, glm::dvec3(0.0), glm::dvec3(0.0, 0.0, 1.0));
}

}  // namespace

Ellipsoid EllipsoidOf(const Medium& medium) {
  return medium.follows_wgs84 ? kWgs84 : Ellipsoid{medium.planet_radius_m, 0.0};
}

SceneGround LoadGround(const Scene& scene, Progress* progress) {
  GeodeticPosition foot = scene.place;
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
  Prepare(progress, "air");  // what follows
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

}  // namespace alpenglow::renderer
