// SPDX-License-Identifier: MIT
// The keys of scene.toml, section by section in the order of the file: their values, units, members
// and meanings. The reader of the file, the records of a scene in the headers of pictures and the
// manual follow these tables.
#pragma once

#include <string>
#include <vector>

#include "atmosphere/base/toml_fields.h"
#include "renderer/scene/scene.h"

namespace alpenglow::renderer {

[[nodiscard]] const TomlFields<Scene>& PlaceFields();
[[nodiscard]] const TomlFields<Scene>& TimeFields();
[[nodiscard]] const TomlFields<Camera>& CameraFields();
[[nodiscard]] const TomlFields<Scene>& AtmosphereFields();
[[nodiscard]] const TomlFields<TerrainSource>& TerrainFields();
[[nodiscard]] const TomlFields<GroundCover>& GroundFields();
[[nodiscard]] const TomlFields<Light>& LightFields();
[[nodiscard]] const TomlFields<MediumLayer>& LayerFields();
[[nodiscard]] const TomlFields<Scene>& NightFields();
[[nodiscard]] const TomlFields<Volume>& VolumeFields();

/// Returns the tables whose members are those of a scene itself: place, time, atmosphere, night.
[[nodiscard]] std::vector<TomlFields<Scene>> TablesOfScene();

/// Returns the type of a lamp as the file names it.
[[nodiscard]] std::string NameOf(Light::Type type);

/// A section as the manual shows it.
struct SceneSection {
  std::string name;
  bool is_list = false;  // [[name]], any number of times
  std::string text;
  std::vector<TomlKey> keys;
};

/// Returns the sections in the order of the file.
[[nodiscard]] std::vector<SceneSection> SectionsOfScene();

/// The deepest place [m above the ellipsoid], the limit of CheckedPlace, and the highest.
inline constexpr double kDeepestPlace_m = -12000.0;
inline constexpr double kHighestPlace_m = 1e9;

}  // namespace alpenglow::renderer
