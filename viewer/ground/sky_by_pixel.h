// SPDX-License-Identifier: MIT
// The renderer's tables of the light on slopes between mountains (OpenSky, HorizonMap, SlopeLight) on the
// graphics card, where shaders/sky_by_pixel.glsl works that light out for every pixel. Light that vertices have
// and triangles interpolate is up to 10 % off at dusk, where a horizon hides the glow (tests/bench/README.md).
//
// A pixel reads 56 texels a source, of half floats: this is for the high quality alone.
#pragma once

#include <array>
#include <glm/vec4.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "viewer/air/solved_air.h"
#include "viewer/gl/gl_objects.h"
#include "viewer/gl/shader.h"
#include "viewer/ground/ground_follower.h"

namespace alpenglow::viewer {

/// `block SkyByPixel` of sky_by_pixel.glsl.
struct SkyByPixelBlock {
  glm::vec4 horizon_u, horizon_v, slope_u, slope_v, sky_moment, sky_place, slope_unit;
};
static_assert(sizeof(SkyByPixelBlock) == 7 * sizeof(glm::vec4));

class SkyByPixel {
 public:
  /// Uploads the tables that belong to a source, and the terrain's where that is another.
  void Use(LightSource source, const GroundFollower::SkyOfSource& sky);
  /// There is no light of the source any more.
  void Forget(LightSource source) { of_source_[IndexOf(source)].reset(); }
  [[nodiscard]] bool Has(LightSource source) const {
    return of_source_[IndexOf(source)].has_value();
  }

  /// A source's, which it must have. @param eye  the frame that pixels are in; to_disk: of the source, in it.
  /// @param now  the open sky's light of the moment, at the altitude of that which Use was given.
  [[nodiscard]] SkyByPixelBlock BlockOf(LightSource source, const LocalFrame& eye,
                                        const glm::dvec3& to_sun_for_air, const SkyTilt& now) const;

  /// Binds four textures, from this unit on, and the samplers of a program to them.
  static constexpr int kUnits = 4;
  void Bind(const ShaderProgram& program, int first_unit, LightSource source) const;

 private:
  struct OfSource {
    GroundFollower::SkyOfSource sky;
    GlTexture integrals, level_irradiance, slopes;
    glm::vec4 slope_unit{1.0F};
  };
  void UploadHorizons(const TerrainHorizons& horizons);

  std::shared_ptr<const TerrainHorizons> horizons_;  // that the texture has
  GlTexture horizon_texture_;
  std::array<std::optional<OfSource>, kLightSources> of_source_;
};

/// The text, to be read after that of the ground's light.
[[nodiscard]] std::vector<ShaderPiece> SkyByPixelTexts();

}  // namespace alpenglow::viewer
