// SPDX-License-Identifier: MIT
#include "renderer/scene/scene_options.h"

#include "atmosphere/air/medium_choice.h"
#include "atmosphere/sun/night_sky.h"
#include "atmosphere/text/error.h"
#include "renderer/terrain/built_in_range.h"

namespace alpenglow {
namespace {

struct View {
  GeodeticPosition place;
  Height height;
  double heading, pitch, fov;
};

bool IsPlaceTyped(const SceneOptions& options) { return options.latitude || options.longitude; }

GeodeticPosition PlaceTyped(const SceneOptions& options) {
  return PlaceFromDegrees(options.latitude.value_or(kHomeLatitude),
                          options.longitude.value_or(kHomeLongitude), 0.0);
}

/// The range comes to a place that is typed; nobody else moves.
GeodeticPosition CentreOfTheRange(const SceneOptions& options) {
  const GeodeticPosition typed = PlaceTyped(options);
  return IsPlaceTyped(options) ? CentreOfRangeSeenFrom(typed) : typed;
}

View ViewOfTheRange(const SceneOptions& options) {
  const BuiltInView view = BuiltInRangeViewAboveGround(CentreOfTheRange(options));
  GeodeticPosition place = IsPlaceTyped(options) ? PlaceTyped(options) : view.eye;
  place.height_m = 0.0;
  return {place, Height{view.eye.height_m, true}, view.heading_deg, view.pitch_deg, view.fov_deg};
}

Height HeightFrom(const SceneOptions& options, const Height& fallback) {
  if (options.height_m && options.above_ground_m) {
    throw InputError("--height and --above-ground are both given; give one");
  }
  if (options.height_m) {
    return {RequireInRange(*options.height_m, -12000.0, 1e9, "--height"), false};
  }
  if (options.above_ground_m) {
    return {RequireInRange(*options.above_ground_m, 0.0, 1e9, "--above-ground"), true};
  }
  return fallback;
}

}  // namespace

Scene SceneFromOptions(const SceneOptions& options) {
  const View view =
      options.dem ? View{PlaceTyped(options), Height{}, 0.0, 0.0, 60.0} : ViewOfTheRange(options);
  Scene scene;
  scene.place = view.place;
  scene.time = ParseInstant("2026-06-21T12:00:00Z");
  scene.camera = CameraFromDegrees(
      HeightFrom(options, view.height), options.heading.value_or(view.heading),
      options.pitch.value_or(view.pitch), 0.0, options.fov.value_or(view.fov), "--");
  scene.medium = MediumFromChoice(options.atmosphere.value_or("earth"));
  if (options.bortle) {
    RequireInRange(*options.bortle, 1.0, 9.0, "--bortle");
    scene.town_zenith = ZenithOfBortleClass(*options.bortle);
  }
  if (options.dem) {
    scene.terrain.kind = TerrainSource::Kind::kElevationModel;
    scene.terrain.file = *options.dem;
  } else {
    scene.terrain.centre = CentreOfTheRange(options);
    // Nobody looks for other mountains at the range's own place.
    scene.terrain.is_default = IsPlaceTyped(options);
  }
  return scene;
}

}  // namespace alpenglow
