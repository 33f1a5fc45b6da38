// SPDX-License-Identifier: MIT
#include <alpenglow/scene.h>

#include <alpenglow/errors.h>

#include <optional>
#include <stop_token>
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

namespace {

View ViewOf(const renderer::Scene& scene) {
  const renderer::Camera& camera = scene.camera;
  return {scene.place,
          {.height_m = camera.height.value_m,
           .height_is_above_ground = camera.height.above_ground,
           .heading_deg = camera.heading_rad / kRadiansPerDegree,
           .pitch_deg = camera.pitch_rad / kRadiansPerDegree,
           .roll_deg = camera.roll_rad / kRadiansPerDegree,
           .fov_deg = camera.fov_rad / kRadiansPerDegree}};
}

renderer::Camera CheckedCamera(const Camera& camera) {
  return renderer::CameraFromDegrees({camera.height_m, camera.height_is_above_ground},
                                     camera.heading_deg, camera.pitch_deg, camera.roll_deg,
                                     camera.fov_deg, "camera.");
}

}  // namespace

struct Scene::State {
  explicit State(const renderer::Scene& loaded)
      : scene(loaded),
        view(ViewOf(loaded)),
        renderer(loaded),
        hashes(renderer::HashFilesOf(loaded)) {}

  /// Returns the pose of a view; std::nullopt for that of the scene.
  [[nodiscard]] std::optional<atmosphere::CameraPose> PoseOf(const View& of) const {
    if (of == view) return std::nullopt;
    const renderer::Camera camera = CheckedCamera(of.camera);
    atmosphere::RequireInRange(camera.height.value_m, -12e3, 1e9, "camera.height_m");
    Place place = atmosphere::CheckedPlace(of.place);
    place.height_m = camera.height.value_m;
    if (camera.height.above_ground) place.height_m += renderer.GroundHeightAt(place);
    return atmosphere::CameraPose{place, camera.heading_rad, camera.pitch_rad, camera.roll_rad,
                                  camera.fov_rad};
  }

  renderer::Scene scene;
  View view;
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
  scene.camera = CheckedCamera(description.camera);
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

Scene Scene::FromToml(std::string_view text, const std::filesystem::path& folder) {
  return Scene(std::make_shared<const State>(renderer::SceneFromToml(text, "scene", folder)));
}

const View& Scene::view() const { return state_->view; }

HdrImage Scene::Render(const View& view, const UtcTime& time, const StillOptions& options,
                       const ProgressFunction& progress) const {
  renderer::RenderSettings settings;
  settings.width = options.width;
  settings.height = options.height;
  settings.samples_per_pixel = options.samples_per_pixel;
  settings.noise = options.noise;
  settings.layers = renderer::LayersFromNames(options.layers);
  std::stop_source others;  // pixels that other threads compute when the progress ends the work
  settings.stop = others.get_token();
  if (progress) {
    settings.pixels_done = [&](double fraction) {
      const bool continues = progress(fraction);
      if (!continues) others.request_stop();
      return continues;
    };
  }
  renderer::CameraSample sample = RequireValid(time);
  const auto pose = state_->PoseOf(view);
  if (pose) sample.poses = {*pose};
  HdrImage still = state_->renderer.Render(sample, settings);
  still.metadata = renderer::PictureMetadata(state_->scene, state_->hashes, settings);
  if (pose) {
    for (const auto& [name, value] : renderer::PoseMetadata(*pose)) still.metadata[name] = value;
  }
  still.is_panorama = CheckedCamera(view.camera).IsPanorama();
  still.metadata["alpenglow.utc"] = TextFromTime(time);
  return still;
}

HdrImage Scene::Render(const UtcTime& time, const StillOptions& options,
                       const ProgressFunction& progress) const {
  return Render(view(), time, options, progress);
}

double Scene::HorizontalIlluminance(const View& view, const UtcTime& time) const {
  renderer::CameraSample sample = RequireValid(time);
  if (const auto pose = state_->PoseOf(view)) sample.poses = {*pose};
  return state_->renderer.Illuminance(sample);
}

double Scene::HorizontalIlluminance(const UtcTime& time) const {
  return HorizontalIlluminance(view(), time);
}

const std::string& Scene::terrain_message() const { return state_->renderer.terrain_message(); }

}  // namespace alpenglow
