// SPDX-License-Identifier: MIT
// What the fragment stages of a picture are put together from: one text, picture.frag.glsl, for
// land, sky and disks, after texts for what there is in a scene.
#pragma once

#include <optional>
#include <vector>

#include "atmosphere/air/phase.h"
#include "renderer/ground/ground_material.h"
#include "viewer/gl/shader.h"
#include "viewer/ground/ground_block.h"
#include "viewer/lamps/lamp_painter.h"

namespace alpenglow::viewer {

/// One of the picture's programs. Sky is open above the horizon, see RowsOfPlanet.
struct PictureStage {
  enum class Pass { kLand, kSky, kDisks, kOpenSky, kNight };
  Pass pass;
  bool has_shade = false, has_lamps = false;
  bool sky_by_pixel = false;  // SkyByPixel, of land alone

  auto operator<=>(const PictureStage&) const = default;
};

/// What the texts of a picture depend on.
struct PictureKind {
  const GroundMaterial& material;
  const LampPainter& lamps;
  LandKind land;
  std::optional<PhaseKind> fog;  // its phase function
};

/// The texts that a stage of the picture is made of, but for picture.frag.glsl itself.
[[nodiscard]] std::vector<ShaderPiece> PictureTexts(const PictureKind& kind,
                                                    const PictureStage& stage);

/// Those that they begin with: the view and the air.
[[nodiscard]] std::vector<ShaderPiece> AirTexts();

}  // namespace alpenglow::viewer
