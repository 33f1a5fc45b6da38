// SPDX-License-Identifier: MIT
// The keys of scene.toml, table by table: their values, units, members and meanings. The reader of
// the file, the records of a scene in the headers of pictures and the manual follow these tables,
// and ForEachTable is the one list of them.
#pragma once

#include <span>
#include <string>

#include "atmosphere/base/toml_fields.h"
#include "renderer/scene/scene.h"

namespace alpenglow::renderer {

[[nodiscard]] const TomlFields<Scene>& PlaceFields();
[[nodiscard]] const TomlFields<Scene>& TimeFields();
[[nodiscard]] const TomlFields<Camera>& CameraFields();
[[nodiscard]] const TomlFields<Scene>& AtmosphereFields();
[[nodiscard]] const TomlFields<SceneWeather>& WeatherFields();
[[nodiscard]] const TomlFields<TerrainSource>& TerrainFields();
[[nodiscard]] const TomlFields<GroundCover>& GroundFields();
[[nodiscard]] const TomlFields<Light>& LightFields();
[[nodiscard]] const TomlFields<MediumLayer>& LayerFields();
[[nodiscard]] const TomlFields<Scene>& NightFields();
[[nodiscard]] const TomlFields<Volume>& VolumeFields();
[[nodiscard]] const TomlFields<SceneObject>& ObjectFields();
[[nodiscard]] const TomlFields<SceneCloud>& CloudFields();

/// Returns the type of a lamp as the file names it.
[[nodiscard]] std::string NameOf(Light::Type type);

/// Calls `use(fields, objects_of)` for every table in the order of the file. `objects_of(scene)`
/// returns a span over the objects that a scene has of the table: the scene itself, one of its
/// members, or a list.
template <typename Use>
void ForEachTable(const Use& use) {
  const auto whole = [](auto& scene) { return std::span(&scene, 1); };
  use(PlaceFields(), whole);
  use(TimeFields(), whole);
  use(CameraFields(), [](auto& scene) { return std::span(&scene.camera, 1); });
  use(AtmosphereFields(), whole);
  use(WeatherFields(), [](auto& scene) { return std::span(&scene.weather, 1); });
  use(TerrainFields(), [](auto& scene) { return std::span(&scene.terrain, 1); });
  use(GroundFields(), [](auto& scene) { return std::span(&scene.ground, 1); });
  use(LightFields(), [](auto& scene) { return std::span(scene.lights); });
  use(LayerFields(), [](auto& scene) { return std::span(scene.layers); });
  use(VolumeFields(), [](auto& scene) { return std::span(scene.volumes); });
  use(ObjectFields(), [](auto& scene) { return std::span(scene.objects); });
  use(CloudFields(), [](auto& scene) { return std::span(scene.clouds); });
  use(NightFields(), whole);
}

/// The deepest place [m above the ellipsoid], the limit of CheckedPlace, and the highest.
inline constexpr double kDeepestPlace_m = -12000.0;
inline constexpr double kHighestPlace_m = 1e9;

}  // namespace alpenglow::renderer
