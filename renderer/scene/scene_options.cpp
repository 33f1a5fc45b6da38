// SPDX-License-Identifier: MIT
#include "renderer/scene/scene_options.h"

#include <algorithm>
#include <cmath>

#include "atmosphere/astronomy/night_sky.h"
#include "atmosphere/base/error.h"
#include "atmosphere/base/parsing.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/medium/medium_presets.h"
#include "renderer/procedural_mountains/lattice_noise.h"
#include "renderer/procedural_mountains/procedural_mountains.h"
#include "renderer/scene/places.h"
#include "renderer/scene/scene_weather.h"
#include "renderer/scene/volume_file.h"
#include "renderer/terrain/land_source.h"

namespace alpenglow::renderer {
namespace {

/// Returns an NRRD file, and the file of the data if its header names one.
std::vector<std::filesystem::path> FilesOfNrrd(const std::filesystem::path& file) {
  try {
    const std::filesystem::path data = ReadNrrdHeader(file).data_file;
    if (data != file) return {file, data};
  } catch (const InputError&) {
    return {file};  // the error is reported when the grid is read
  }
  return {file};
}

/// Returns the place of the options on the ellipsoid, if they give one.
std::optional<Place> PlaceTyped(const SceneOptions& options) {
  if (!options.place && !options.latitude && !options.longitude) return std::nullopt;
  double latitude = kHomeLatitude, longitude = kHomeLongitude;
  if (options.place) {
    const Place& place = PlaceNamed(*options.place).place;
    latitude = place.latitude_deg;
    longitude = place.longitude_deg;
  }
  return CheckedPlace(
      {options.latitude.value_or(latitude), options.longitude.value_or(longitude), 0.0});
}

Place Home() { return CheckedPlace({kHomeLatitude, kHomeLongitude, 0.0}); }

/// Returns the built-in range, moved to a place given on the command line, or else around
/// kHomeLatitude and kHomeLongitude.
TerrainSource RangeOf(const std::optional<Place>& typed) {
  if (typed) return RangeSeenFrom(*typed);
  TerrainSource range;
  range.centre = Home();
  range.is_default = false;  // so that no other terrain is searched for there
  return range;
}

TerrainSource ElevationModelsOf(const std::vector<std::string>& dem) {
  TerrainSource terrain;
  terrain.kind = TerrainSource::Kind::kElevationModel;
  terrain.file = dem.front();
  terrain.more_files.assign(dem.begin() + 1, dem.end());
  return terrain;
}

/// Returns the default view: that of the range, or horizontally to the north. Its height is above the
/// ground.
CameraPose ViewOf(const TerrainSource& terrain, const std::optional<Place>& typed) {
  CameraPose view{.place = Home()};
  view.place.height_m = Height{}.value_m;
  if (terrain.kind != TerrainSource::Kind::kElevationModel)
    view = ProceduralMountainsViewAboveGround(*terrain.centre);
  if (typed) view.place = {typed->latitude_deg, typed->longitude_deg, view.place.height_m};
  return view;
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

// Returns a seed that is equal for places given or computed with small differences: the cells are
// offset so that such places do not fall on a cell border.
std::uint32_t SeedAt(const Place& place) {
  constexpr double kCellsPerDegree = 100.0, kOffset = 0.5 + 1.0 / 3e3;
  const auto cell = [](double angle_deg) {
    return static_cast<std::int32_t>(std::floor(angle_deg * kCellsPerDegree + kOffset));
  };
  const std::uint32_t seed =
      LatticeHash(cell(WrappedLongitude(place.longitude_deg)), cell(place.latitude_deg), 90);
  return std::max(seed, 1U);
}

}  // namespace

std::vector<std::filesystem::path> FilesOf(const Volume& volume) {
  if (volume.grid.empty()) return {};
  if (volume.grid_size) return {volume.grid};
  return FilesOfNrrd(volume.grid);
}

std::vector<std::filesystem::path> FilesOf(const SceneCloud& cloud) {
  if (cloud.grid.empty()) return {};
  const bool is_nrrd = HasExtension(cloud.grid, ".nrrd") || HasExtension(cloud.grid, ".nhdr");
  return is_nrrd ? FilesOfNrrd(cloud.grid) : std::vector{cloud.grid};
}

std::vector<NamedFile> FilesOf(const Scene& scene) {
  std::vector<NamedFile> files;
  const auto add = [&](const char* name, const std::filesystem::path& file) {
    if (!file.empty()) files.push_back({name, file});
  };
  add("the terrain", scene.terrain.file);
  for (const std::filesystem::path& file : scene.terrain.more_files) add("the terrain", file);
  add("terrain.colour", scene.terrain.colour);
  add("terrain.land_cover", scene.terrain.land_cover);
  for (const Light& light : scene.lights) {
    if (light.ies) add("light.ies", *light.ies);
  }
  for (const Volume& volume : scene.volumes) {
    for (const std::filesystem::path& file : FilesOf(volume)) add("volume.grid", file);
  }
  for (const SceneCloud& cloud : scene.clouds) {
    for (const std::filesystem::path& file : FilesOf(cloud)) add("cloud.grid", file);
  }
  return files;
}

LandSource LandSourceOf(const Scene& scene) {
  LandSource source;
  source.voids = scene.terrain.voids;
  if (scene.terrain.kind == TerrainSource::Kind::kElevationModel) {
    source.files = scene.terrain.more_files;
    source.files.insert(source.files.begin(), scene.terrain.file);
  }
  if (scene.terrain.kind == TerrainSource::Kind::kMesh)
    source.mesh = LandSource::Mesh{scene.terrain.file, scene.place, scene.terrain.up};
  if (scene.terrain.kind == TerrainSource::Kind::kProceduralMountains)
    source.range_centre = scene.terrain.centre.value_or(scene.place);
  source.range_seed = scene.terrain.range_seed;
  return source;
}

bool IsOnRangeAtHome(const Place& place) {
  return ProceduralMountainsExtent(Home()).Covers(place.latitude_rad(), place.longitude_rad());
}

TerrainSource RangeSeenFrom(const Place& place) {
  TerrainSource range;
  range.centre = CentreOfRangeSeenFrom(place);
  range.range_seed = IsOnRangeAtHome(place) ? 0 : SeedAt(place);
  return range;
}

SceneOptions AtStation(SceneOptions options, const SceneWeather& weather) {
  const bool has_place = options.place || options.latitude || options.longitude;
  if (!has_place && options.dem.empty()) options.place = AirportOf(weather);
  return options;
}

Scene SceneFromOptions(const SceneOptions& options) {
  const std::optional<Place> typed = PlaceTyped(options);
  Scene scene;
  scene.terrain = options.dem.empty() ? RangeOf(typed) : ElevationModelsOf(options.dem);
  const CameraPose view = ViewOf(scene.terrain, typed);
  const auto degrees = [](double radians) { return radians / kRadiansPerDegree; };
  scene.place = {view.place.latitude_deg, view.place.longitude_deg, 0.0};
  scene.time = ParseInstant("2026-06-21T12:00:00Z");
  scene.camera = CameraFromDegrees(HeightFrom(options, {view.place.height_m, true}),
                                   options.heading.value_or(degrees(view.heading_rad)),
                                   options.pitch.value_or(degrees(view.pitch_rad)), 0.0,
                                   options.fov.value_or(degrees(view.fov_rad)), "--");
  scene.medium = MediumFromChoice(options.atmosphere.value_or("earth"), kForPictures);
  if (options.bortle) {
    RequireInRange(*options.bortle, 1.0, 9.0, "--bortle");
    scene.town_zenith = ZenithOfBortleClass(*options.bortle);
  }
  return scene;
}

}  // namespace alpenglow::renderer
