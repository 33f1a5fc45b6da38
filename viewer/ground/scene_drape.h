// SPDX-License-Identifier: MIT
// The picture, of colours or land cover, that a scene lays over its terrain, and where it lies.
#pragma once

#include <memory>

#include "renderer/ground/colour_drape.h"
#include "renderer/ground/scene_ground.h"
#include "renderer/scene/scene.h"
#include "viewer/ground/drape_texels.h"

namespace alpenglow::viewer {

struct SceneDrape {
  std::shared_ptr<const ColourDrape> colours;  // null: the scene names none
  FlatRectangle place{};                       // of the terrain, what it covers
};

/// @param ground  of the scene; its terrain, if it has none, is loaded for its frame and its rim.
[[nodiscard]] SceneDrape DrapeOf(const Scene& scene, const SceneGround& ground);

/// Finer than the picture, so that edges stay where they are when it is interpolated once more; 4096
/// texels a side at most, which take 180 MB. Only where there are colours.
[[nodiscard]] DrapeTexels TexelsOf(const SceneDrape& drape);

}  // namespace alpenglow::viewer
