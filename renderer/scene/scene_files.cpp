// SPDX-License-Identifier: MIT
#include "renderer/scene/scene_files.h"

namespace alpenglow {

std::vector<NamedFile> FilesOf(const Scene& scene) {
  std::vector<NamedFile> files;
  const auto add = [&](const char* name, const std::filesystem::path& file) {
    if (!file.empty()) files.push_back({name, file});
  };
  add("the terrain", scene.terrain.file);
  add("terrain.colour", scene.terrain.colour);
  add("terrain.land_cover", scene.terrain.land_cover);
  for (const Light& light : scene.lights) {
    if (light.ies) add("light.ies", *light.ies);
  }
  for (const Volume& volume : scene.volumes) add("volume.grid", volume.grid);
  return files;
}

}  // namespace alpenglow
