// SPDX-License-Identifier: MIT
#include "renderer/scene/scene_files.h"

#include "atmosphere/text/error.h"
#include "renderer/scene/nrrd_header.h"

namespace alpenglow::renderer {
namespace {

// The file that a grid's header names, or the grid itself.
std::filesystem::path DataOfGrid(const Volume& volume) {
  if (volume.grid.empty() || volume.grid_size) return volume.grid;
  try {
    return ReadNrrdHeader(volume.grid).data_file;
  } catch (const InputError&) {
    return volume.grid;  // the fault is told when the volume is read
  }
}

}  // namespace

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
  for (const Volume& volume : scene.volumes) {
    add("volume.grid", volume.grid);
    if (const auto data = DataOfGrid(volume); data != volume.grid) add("volume.grid", data);
  }
  return files;
}

}  // namespace alpenglow::renderer
