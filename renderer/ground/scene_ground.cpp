// SPDX-License-Identifier: MIT
#include "renderer/ground/scene_ground.h"

#include <cmath>

#include "atmosphere/number/constants.h"
#include "atmosphere/text/error.h"
#include "renderer/shadow/sun_probes.h"
#include "renderer/terrain/built_in_range.h"

namespace alpenglow {
namespace {

struct LoadedMesh {
  std::optional<TriangleMesh> mesh;
  std::string message;
};

LoadedMesh LoadMesh(const Scene& scene, const LocalFrame& frame, Progress* progress) {
  if (scene.terrain.kind != TerrainSource::Kind::kNone) Prepare(progress, "terrain");
  switch (scene.terrain.kind) {
    case TerrainSource::Kind::kBuiltInRange: {
      const ElevationGrid range = BuiltInRange(scene.terrain.centre.value_or(scene.place));
      Prepare(progress, "mesh");
      return {MeshFromElevation(range, frame), ""};
    }
    case TerrainSource::Kind::kElevationModel: {
      const ElevationModel model = ReadElevation(scene.terrain.file, scene.terrain.voids);
      std::string message;
      if (model.voids > 0) {
        message = fmt::format("{}: {} samples without data, {} filled", scene.terrain.file.string(),
                              model.voids, model.voids_filled);
      }
      Prepare(progress, "mesh");
      return {MeshFromElevation(model.grid, frame), message};
    }
    case TerrainSource::Kind::kMesh:
      return {ReadObj(scene.terrain.file), ""};
    case TerrainSource::Kind::kNone:
      break;
  }
  return {};
}

// Height of the ground under the eye, seen from high above; 0 on the bare ellipsoid.
double GroundUnderEye(const std::optional<Terrain>& terrain) {
  constexpr double kAbove_m = 20000.0;
  if (!terrain) return 0.0;
  const auto hit = terrain->Intersect({0.0, 0.0, kAbove_m}, {0.0, 0.0, -1.0});
  return hit ? kAbove_m - hit->distance_m : 0.0;
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
  const double ground = GroundUnderEye(terrain);
  const Height& height = scene.camera.height;
  const double eye = height.above_ground ? ground + height.value_m : height.value_m;
  if (eye < ground) {
    throw InputError(
        fmt::format("camera.height_m is {:.1f}; the ground there is at {:.1f} m", eye, ground));
  }
  Prepare(progress, "air");  // what follows
  const bool from_file = scene.terrain.kind == TerrainSource::Kind::kMesh;
  const bool is_one_surface = !from_file || !terrain || IsOneSurface(*terrain);
  if (!is_one_surface) {
    loaded.message = fmt::format(
        "{}: the mesh has overhangs; sunlight in the air under them is found by occlusion rays",
        scene.terrain.file.string());
  }
  return {frame, std::move(terrain), eye, std::move(loaded.message), is_one_surface};
}

}  // namespace alpenglow
