// SPDX-License-Identifier: MIT
#include <alpenglow/scene.h>

#include <alpenglow/errors.h>

#include <utility>

#include "atmosphere/api/conversions.h"
#include "atmosphere/math/constants.h"
#include "renderer/picture/picture_layers.h"
#include "renderer/picture/render.h"
#include "renderer/procedural_mountains/procedural_mountains.h"
#include "renderer/scene/scene.h"
#include "renderer/scene/scene_options.h"
#include "renderer/series/scene_metadata.h"

namespace alpenglow {

using atmosphere::kRadiansPerDegree;

struct Scene::State {
  explicit State(const renderer::Scene& loaded)
      : scene(loaded), renderer(loaded), hashes(renderer::HashFilesOf(loaded)) {}

  renderer::Scene scene;
  renderer::SceneRenderer renderer;
  renderer::FileHashes hashes;  // of what has been loaded
};

namespace {

renderer::TerrainSource TerrainOf(const SceneDescription& description) {
  renderer::TerrainSource terrain;
  switch (description.terrain) {
    case TerrainKind::kBuiltInMountains:
      terrain = renderer::RangeSeenFrom(atmosphere::CheckedPlace(description.place));
      break;
    case TerrainKind::kElevationModel:
      terrain.kind = renderer::TerrainSource::Kind::kElevationModel;
      terrain.file = description.elevation_model;
      break;
    case TerrainKind::kNone:
      terrain.kind = renderer::TerrainSource::Kind::kNone;
      break;
    default:
      throw InputError("terrain is no TerrainKind");
  }
  terrain.is_default = false;
  return terrain;
}

renderer::Scene SceneFrom(const SceneDescription& description) {
  renderer::Scene scene;
  scene.place = atmosphere::CheckedPlace(description.place);
  scene.place.height_m = 0.0;
  const Camera& camera = description.camera;
  scene.camera = renderer::CameraFromDegrees({camera.height_m, camera.height_is_above_ground},
                                             camera.heading_deg, camera.pitch_deg, camera.roll_deg,
                                             camera.fov_deg, "camera.");
  scene.medium = description.atmosphere.medium();
  atmosphere::Validate(scene.medium, atmosphere::kForPictures);
  scene.terrain = TerrainOf(description);
  return scene;
}

}  // namespace

SceneDescription BuiltInScene() {
  const atmosphere::CameraPose view = renderer::ProceduralMountainsViewAboveGround(
      {renderer::kHomeLatitude, renderer::kHomeLongitude, 0.0});
  SceneDescription scene;
  scene.place = {view.place.latitude_deg, view.place.longitude_deg};
  scene.camera = {.height_m = view.place.height_m,
                  .heading_deg = view.heading_rad / kRadiansPerDegree,
                  .pitch_deg = view.pitch_rad / kRadiansPerDegree,
                  .fov_deg = view.fov_rad / kRadiansPerDegree};
  return scene;
}

Scene::Scene(const SceneDescription& description)
    : Scene(std::make_shared<const State>(SceneFrom(description))) {}

Scene::Scene(std::shared_ptr<const State> state) : state_(std::move(state)) {}

Scene Scene::Read(const std::filesystem::path& file) {
  return Scene(std::make_shared<const State>(renderer::ReadScene(file)));
}

HdrImage Scene::Render(const UtcTime& time, const StillOptions& options) const {
  renderer::RenderSettings settings;
  settings.width = options.width;
  settings.height = options.height;
  settings.samples_per_pixel = options.samples_per_pixel;
  settings.noise = options.noise;
  settings.layers = renderer::LayersFromNames(options.layers);
  HdrImage still = state_->renderer.Render(RequireValid(time), settings);
  still.is_panorama = state_->scene.camera.IsPanorama();
  still.metadata = renderer::PictureMetadata(state_->scene, state_->hashes, settings);
  still.metadata["alpenglow.utc"] = TextFromTime(time);
  return still;
}

double Scene::HorizontalIlluminance(const UtcTime& time) const {
  return state_->renderer.Illuminance(RequireValid(time));
}

const std::string& Scene::terrain_message() const { return state_->renderer.terrain_message(); }

}  // namespace alpenglow
