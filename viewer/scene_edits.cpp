// SPDX-License-Identifier: MIT
#include "viewer/scene_edits.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <glm/geometric.hpp>
#include <utility>

#include "atmosphere/base/error.h"
#include "renderer/clouds/cloud_options.h"
#include "renderer/procedural_mountains/procedural_mountains.h"
#include "renderer/scene/places.h"
#include "renderer/scene/scene_clouds.h"
#include "renderer/scene/scene_options.h"
#include "renderer/terrain/loaded_heights.h"
#include "viewer/shaders/pass_setup.h"

namespace alpenglow::viewer {
namespace {

// Returns the half width of a square around a place that contains all land, at most 60 km. A
// smaller square has finer samples.
double HalfWidthOfLand(const LandLattice& lattice, const Place& place) {
  constexpr double kMost_m = 60e3;
  const SampleSize size = SampleSizeAt(lattice, place.latitude_rad());
  const LatticePlace at = lattice.At(place.latitude_rad(), place.longitude_rad());
  const double columns = std::max(at.column, lattice.last_column - at.column);
  const double rows = std::max(at.row, lattice.last_row - at.row);
  return std::min(std::max(columns * size.column_m, rows * size.row_m) + size.row_m, kMost_m);
}

TerrainSource TerrainOf(const Scene& scene) {
  TerrainSource terrain = scene.terrain;
  if (terrain.kind == TerrainSource::Kind::kProceduralMountains && !terrain.centre)
    terrain.centre = scene.place;
  return terrain;
}

bool IsOneModel(const LandSource& land) {
  return land.files.empty() ||
         (land.files.size() == 1 && !std::filesystem::is_directory(land.files.front()));
}

}  // namespace

SceneEdits::SceneEdits(const Scene& scene, const LandSource& land, SkyPainter& painter)
    : painter_(painter),
      scene_(scene),
      first_terrain_(TerrainOf(scene)),
      has_range_(land.files.empty() && land.range_centre),
      has_one_model_(IsOneModel(land)),
      changes_{first_terrain_, scene.medium, {}, {}} {
  scene_.terrain = first_terrain_;
  const SceneDrape& drape = painter.scene().fixed().drape;
  if (drape.colours && !drape.colours->note().empty()) notes_.push_back(drape.colours->note());
  BeginHashing();
}

void SceneEdits::BeginHashing() {
  std::promise<FileHashes> promise;
  file_hashes_ = promise.get_future().share();
  hashing_ = std::jthread(
      [scene = scene_, promise = std::move(promise)](const std::stop_token& stop) mutable {
        try {
          promise.set_value(HashFilesOf(scene, stop));
        } catch (...) {
          promise.set_exception(std::current_exception());
        }
      });
}

void SceneEdits::Use(const std::vector<SceneCloud>& clouds) {
  for (const SceneCloud& layer : OverEllipsoid(clouds, GroundAt(scene_.place))) {
    if (layer.grid.empty()) CheckCloudOptions(layer.options);
  }
  RequireCloudsFit(clouds, MemoryOfMachine());
  scene_.clouds = clouds;
  changes_.clouds = std::make_shared<const std::vector<SceneCloud>>(clouds);
  ++version_;
  painter_.Replace(clouds);
}

void SceneEdits::Use(const AirChoice& choice, const Place& place) {
  const Medium changed = Changed(changes_.planet, choice);
  changes_.air = choice;
  scene_.medium = changed;
  ++version_;
  changes_.sky_air = OnOsculatingSphere(changed, place.latitude_rad());
  painter_.Replace(*changes_.sky_air);
}

void SceneEdits::UsePlanet(const std::string& preset, const Place& place) {
  Medium planet = MediumPreset(preset);
  if (planet.follows_wgs84 != changes_.planet.follows_wgs84) {
    throw InputError(fmt::format(
        "{} is another planet than the one that this land lies on; start there with a scene file",
        preset));
  }
  static_cast<void>(AirBlockOf(planet));
  changes_.planet = std::move(planet);
  Use(changes_.air, place);
}

void SceneEdits::Restore(const SceneChanges& changes) {
  if (has_range_ && changes.terrain.centre != scene_.terrain.centre) UseRange(changes.terrain);
  changes_.planet = changes.planet;
  changes_.air = changes.air;
  if (changes.clouds && changes.clouds != changes_.clouds) {
    Use(*changes.clouds);
    changes_.clouds = changes.clouds;
  }
  if (!changes.sky_air || changes.sky_air == changes_.sky_air) return;
  scene_.medium = Changed(changes_.planet, changes_.air);
  changes_.sky_air = changes.sky_air;
  ++version_;
  painter_.Replace(*changes_.sky_air);
}

bool SceneEdits::IsRangeExpectedAt(const Place& place) const {
  constexpr double kNear_m = 100.0;
  if (!has_range_ || painter_.land().ground().IsKnownAt(place)) return false;
  Place view = ProceduralMountainsViewAboveGround(*scene_.terrain.centre).place;
  view.height_m = place.height_m;
  return glm::length(LocalFrame(kWgs84, view).EnuFromGeodetic(place).xyz) < kNear_m;
}

double SceneEdits::GroundAt(const Place& place) const {
  if (IsRangeExpectedAt(place)) return kRangeViewGround_m;
  return painter_.land().ground().HeightUnder(place).value_or(0.0);
}

void SceneEdits::AwaitGround(const Place& place) { painter_.land().AwaitGround(place); }

void SceneEdits::BringRangeTo(const Place& place) {
  const auto reaches = [&](const TerrainSource& range) {
    return ProceduralMountainsExtent(*range.centre)
        .Covers(place.latitude_rad(), place.longitude_rad());
  };
  if (!has_range_ || reaches(scene_.terrain)) return;
  UseRange(reaches(first_terrain_) ? first_terrain_ : RangeSeenFrom(place));
}

void SceneEdits::UseRange(const TerrainSource& range) {
  scene_.terrain = changes_.terrain = range;
  painter_.Replace(LandSourceOf(scene_));
  ++version_;
}

void SceneEdits::BringLandTo(const Place& place, const std::string& name) {
  BringRangeTo(place);
  const Landscape& land = painter_.land();
  if (land.tiles().source().IsEmpty()) return;
  if (land.ground().Reaches(place)) {
    if (!land.ground().IsKnownAt(place)) painter_.AwaitLand();
    return;
  }
  notes_.push_back(
      fmt::format("there is no terrain at {}: --dem loads an elevation model of it", name));
}

std::vector<std::string> SceneEdits::PollNotes() {
  std::vector<std::string> notes = std::exchange(notes_, {});
  for (std::string& note : painter_.land().PollNotes()) notes.push_back(std::move(note));
  return notes;
}

std::string SceneEdits::ZoneAt(const Place& place) const {
  return ZoneNear(place, scene_.zone, scene_.place);
}

Scene SceneEdits::SeenBy(const CameraPose& eye, const UtcTime& now) const {
  Scene seen = scene_;
  // The frame of clouds is that of the place of the scene.
  if (seen.clouds.empty()) seen.place = eye.place;
  seen.place.height_m = 0.0;
  seen.time = now;
  seen.camera.height = {eye.place.height_m, false};
  seen.camera.heading_rad = eye.heading_rad;
  seen.camera.pitch_rad = eye.pitch_rad;
  seen.camera.roll_rad = eye.roll_rad;
  seen.camera.fov_rad = eye.fov_rad;
  return seen;
}

ReferenceScene SceneEdits::ForRenderer(const CameraPose& eye, const UtcTime& now) const {
  ReferenceScene scene{SeenBy(eye, now), nullptr};
  if (has_one_model_) return scene;
  scene.scene.terrain.kind = TerrainSource::Kind::kNone;
  scene.ground = GroundAround(eye.place);
  return scene;
}

std::function<std::shared_ptr<const SceneGround>()> SceneEdits::GroundAround(
    const Place& place) const {
  constexpr int kMostSamples = 3000;
  return [sample = painter_.land().ground().Sampler(), place,
          half_width_m = HalfWidthOfLand(painter_.land().tiles().lattice(), place),
          ellipsoid = EllipsoidOf(scene_.medium)]() -> std::shared_ptr<const SceneGround> {
    Place foot = place;
    foot.height_m = 0.0;
    const LocalFrame frame(ellipsoid, foot);
    const std::optional<ElevationGrid> grid = sample(place, half_width_m, kMostSamples);
    if (!grid)
      return std::make_shared<const SceneGround>(
          SceneGround{frame, std::nullopt, place.height_m, "", true});
    SceneGround ground = GroundOf(*grid, frame);
    ground.eye_height_m = place.height_m;
    return std::make_shared<const SceneGround>(std::move(ground));
  };
}

void Standpoint::Leave(std::optional<double> above_ground_m) {
  state_ = {false, above_ground_m};
  put_at_ = std::nullopt;
}

void Standpoint::AwaitGround() {
  if (state_.knows_ground || !state_.waits_above_ground_m) return;
  if (!scene_.IsRangeExpectedAt(eye().place)) {
    painter_.land().AwaitGround(eye().place);
    return StandOnGround();
  }
  CameraPose stands = eye();
  stands.place.height_m = kRangeViewGround_m + *state_.waits_above_ground_m;
  controller_.pilot().PutAt(stands, controller_.ground());
  put_at_ = eye();
}

void Standpoint::StandOnGround() {
  if (state_.knows_ground || !painter_.land().ground().IsKnownAt(eye().place)) return;
  state_.knows_ground = true;
  const std::optional<double> above_m = std::exchange(state_.waits_above_ground_m, std::nullopt);
  const bool has_left = put_at_ && *put_at_ != eye();
  if (!above_m || has_left) return controller_.pilot().KeepAbove(controller_.ground());
  CameraPose stands = eye();
  stands.place.height_m = painter_.land().ground().HighestAt(stands.place).value_or(0.0) + *above_m;
  controller_.pilot().PutAt(stands, controller_.ground());
}

void Standpoint::MoveTo(const EyePlacement& placement) {
  const bool moves = placement.latitude_deg || placement.longitude_deg;
  if (!moves && !placement.height_m && !placement.heading_deg && !placement.pitch_deg) return;
  const GroundHeight& ground = controller_.ground();
  const double above_m =
      state_.waits_above_ground_m.value_or(eye().place.height_m - ground(eye().place));
  CameraPose placed = Placed(eye(), placement);
  if (moves) scene_.BringLandTo(placed.place, "this place");
  if (moves && !placement.height_m)
    placed.place.height_m = ground(placed.place) + std::max(above_m, 0.0);
  controller_.pilot().PutAt(placed, ground);
  if (placement.height_m) {
    Leave();
  } else if (moves) {
    Leave(std::max(above_m, 0.0));
  }
}

void Standpoint::GoTo(const std::string& name) {
  const NamedPlace& there = PlaceNamed(name);
  scene_.BringLandTo(there.place, there.name);
  controller_.GoTo(there);
  Leave(eye().place.height_m - scene_.GroundAt(eye().place));
}

}  // namespace alpenglow::viewer
