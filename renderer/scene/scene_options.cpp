// SPDX-License-Identifier: MIT
#include "renderer/scene/scene_options.h"

#include <algorithm>

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

View ViewOfTheRange(const GeodeticPosition& centre) {
  const BuiltInView view = BuiltInRangeViewAboveGround(centre);
  GeodeticPosition place = view.eye;
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

Medium MediumFrom(const std::string& name) {
  const std::vector<std::string> presets = MediumPresetNames();
  const bool is_preset = std::find(presets.begin(), presets.end(), name) != presets.end();
  return is_preset ? MediumPreset(name) : ReadMedium(name);
}

}  // namespace

Scene SceneFromOptions(const SceneOptions& options) {
  const GeodeticPosition typed = PlaceFromDegrees(options.latitude, options.longitude, 0.0);
  const View view = options.dem ? View{typed, Height{}, 0.0, 0.0, 60.0} : ViewOfTheRange(typed);
  Scene scene;
  scene.place = view.place;
  scene.time = ParseInstant("2026-06-21T12:00:00Z");
  scene.camera = CameraFromDegrees(
      HeightFrom(options, view.height), options.heading.value_or(view.heading),
      options.pitch.value_or(view.pitch), 0.0, options.fov.value_or(view.fov), "--");
  scene.medium = MediumFrom(options.atmosphere.value_or("earth"));
  if (options.bortle) {
    RequireInRange(*options.bortle, 1.0, 9.0, "--bortle");
    scene.town_zenith = ZenithOfBortleClass(*options.bortle);
  }
  if (options.dem) {
    scene.terrain.kind = TerrainSource::Kind::kElevationModel;
    scene.terrain.file = *options.dem;
  } else {
    const SceneOptions at_home;  // the range's own place, where nobody looks for other mountains
    scene.terrain.centre = typed;
    scene.terrain.is_default =
        options.latitude != at_home.latitude || options.longitude != at_home.longitude;
  }
  return scene;
}

}  // namespace alpenglow
