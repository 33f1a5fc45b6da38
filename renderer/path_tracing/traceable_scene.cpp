// SPDX-License-Identifier: MIT
#include "renderer/path_tracing/traceable_scene.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "atmosphere/base/error.h"

namespace alpenglow::renderer {
namespace {

bool IsLambertian(GroundCover::Kind kind) {
  return kind == GroundCover::Kind::kMountain || kind == GroundCover::Kind::kLambert;
}

}  // namespace

std::vector<std::string> UntracedContent(const Scene& scene) {
  std::vector<std::string> content;
  const auto add = [&](bool is_there, const char* name) {
    if (is_there) content.emplace_back(name);
  };
  add(!scene.lights.empty(), "lamps (light)");
  add(!scene.layers.empty(), "fog (fog)");
  add(!scene.volumes.empty(), "local media (volume)");
  add(!scene.objects.empty(), "spheres of glass and mirrors (object)");
  add(!IsLambertian(scene.ground.kind), "ground that is not Lambertian (ground.cover)");
  add(scene.ground.sea_level_m.has_value(), "a sea (ground.sea_level_m)");
  add(!scene.terrain.land_cover.empty(), "land cover (terrain.land_cover)");
  add(scene.camera.polariser_rad.has_value(), "a polariser (camera.polariser_deg)");
  return content;
}

void RequireTraceable(const Scene& scene) {
  const std::vector<std::string> content = UntracedContent(scene);
  if (content.empty()) return;
  throw InputError(
      fmt::format("--paths does not trace {}; without --paths the scene can be rendered",
                  fmt::join(content, ", ")));
}

}  // namespace alpenglow::renderer
