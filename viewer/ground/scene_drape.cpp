// SPDX-License-Identifier: MIT
#include "viewer/ground/scene_drape.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace alpenglow::viewer {

SceneDrape DrapeOf(const Scene& scene, const SceneGround& ground) {
  if (scene.terrain.Drape().empty()) return {};
  std::optional<SceneGround> loaded;
  if (!ground.terrain) loaded.emplace(LoadGround(scene));
  const SceneGround& draped = loaded ? *loaded : ground;
  std::shared_ptr<const ColourDrape> colours = ColourDrape::Of(scene, draped);
  const FlatRectangle place = CoveredPart(*colours, RectangleOf(draped.terrain->mesh()));
  return {std::move(colours), place};
}

DrapeTexels TexelsOf(const SceneDrape& drape) {
  constexpr double kMostTexels = 4096.0, kTexelsAPixel = 4.0;
  const double side_m = std::max(drape.place.width_m, drape.place.depth_m);
  const double wanted = std::ceil(kTexelsAPixel * side_m / drape.colours->pixel_m());
  const auto texels = static_cast<std::size_t>(std::clamp(wanted, 1.0, kMostTexels));
  return {*drape.colours, drape.place, texels};
}

}  // namespace alpenglow::viewer
