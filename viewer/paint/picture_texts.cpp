// SPDX-License-Identifier: MIT
#include "viewer/paint/picture_texts.h"

#include <fmt/format.h>

#include <utility>

#include "viewer/air/air_textures.h"
#include "viewer/ground/ground_block.h"
#include "viewer/ground/sky_by_pixel.h"
#include "viewer/lamps/fog_painter.h"
#include "viewer/shade/shaft_pass.h"
#include "viewer/shaders/viewer_texts.h"

namespace alpenglow::viewer {
namespace {

ShaderPiece DefinesOf(const PictureKind& kind, const PictureStage& stage) {
  return {"stage",
          fmt::format("#define LAND_PASS 0\n#define SKY_PASS 1\n#define DISK_PASS 2\n"
                      "#define OPEN_SKY_PASS 3\n#define NIGHT_PASS 4\n"
                      "#define PASS {}\n#define HAS_SHADE {}\n#define HAS_LAMPS {}\n"
                      "#define HAS_FOG {}\n#define SKY_BY_PIXEL {}\n",
                      static_cast<int>(stage.pass), stage.has_shade ? 1 : 0,
                      stage.has_lamps ? 1 : 0, kind.fog ? 1 : 0, stage.sky_by_pixel ? 1 : 0)};
}

}  // namespace

std::vector<ShaderPiece> AirTexts() {
  std::vector<ShaderPiece> texts = WithViewerPieces(
      SharedTexts(), {"viewer/shaders/view_block.glsl", "viewer/shaders/bent_sight.glsl"});
  for (ShaderPiece& piece : AirTableTexts()) texts.push_back(std::move(piece));
  return texts;
}

std::vector<ShaderPiece> PictureTexts(const PictureKind& kind, const PictureStage& stage) {
  std::vector<ShaderPiece> texts = AirTexts();
  const auto add = [&](std::vector<ShaderPiece> pieces) {
    for (ShaderPiece& piece : pieces) texts.push_back(std::move(piece));
  };
  texts.push_back(DefinesOf(kind, stage));
  add(kind.fog ? FogTexts(*kind.fog) : NoFogTexts());
  // What fog leaves of the sun on the ground is part of what the air leaves.
  if (kind.fog) {
    texts.push_back(
        {"fog on the ground", "#define BeamOfSun(h, mu) (BeamOfSun(h, mu) * FogSunLeft(h, mu))\n"});
  }
  add(WithViewerPieces({}, {"viewer/shaders/air_block.glsl", "viewer/shaders/octahedral.glsl",
                            "viewer/shaders/nearness.glsl", "viewer/shaders/sun_light.glsl"}));
  if (stage.pass == PictureStage::Pass::kDisks)
    add(WithViewerPieces({}, {"viewer/shaders/bent_disks.glsl"}));
  add(GroundTexts(kind.material, kind.land));
  if (stage.sky_by_pixel) add(SkyByPixelTexts());
  add(ShaftTexts());
  add(stage.has_lamps ? kind.lamps.texts() : NoLampTexts());
  return texts;
}

}  // namespace alpenglow::viewer
