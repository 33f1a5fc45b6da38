// SPDX-License-Identifier: MIT
// Provides SkyByPixel, the renderer's tables for the light on slopes between mountains (OccludedSkyIrradiance,
// HorizonMap, TerrainInterreflection) on the GPU. shaders/sky_by_pixel.glsl evaluates them for every pixel.
// Light that is interpolated between vertices has errors of up to 10 % at dusk, where a horizon
// hides the glow (tests/bench/README.md).
//
// A pixel reads 56 texels of half floats per source, so only the high quality uses these tables.
#pragma once

#include <array>
#include <glm/vec4.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "lut/camera_tables/air_tables.h"
#include "renderer/illumination/lighting.h"
#include "viewer/gl/gl_objects.h"
#include "viewer/gl/shader.h"
#include "viewer/ground/ground_follower.h"

namespace alpenglow::viewer {

/// Mirrors the uniform block `SkyByPixel` of sky_by_pixel.glsl.
struct SkyByPixelBlock {
  glm::vec4 horizon_u, horizon_v, slope_u, slope_v, sky_moment, sky_place, slope_unit;
};
static_assert(sizeof(SkyByPixelBlock) == 7 * sizeof(glm::vec4));

class SkyByPixel {
 public:
  /// Uploads the tables of a source, and those of the terrain if it has changed.
  void Use(LightSource source, const GroundFollower::SkyOfSource& sky);
  /// Removes the light of a source.
  void Forget(LightSource source) { of_source_[IndexOf(source)].reset(); }
  [[nodiscard]] bool Has(LightSource source) const {
    return of_source_[IndexOf(source)].has_value();
  }

  /// Returns the block of a source, which must have tables. @param eye  frame of the pixels;
  /// to_sun_for_air: direction to the source in this frame.
  /// @param now  current light of the open sky, at the altitude of the one given to Use.
  [[nodiscard]] SkyByPixelBlock BlockOf(LightSource source, const LocalFrame& eye,
                                        const glm::dvec3& to_sun_for_air,
                                        const SkyIrradianceGradient& now) const;

  /// Binds four textures, beginning with `first_unit`, and assigns the samplers of a program to
  /// them.
  static constexpr int kUnits = 4;
  void Bind(const ShaderProgram& program, int first_unit, LightSource source) const;

 private:
  struct OfSource {
    GroundFollower::SkyOfSource sky;
    GlTexture integrals, level_irradiance, slopes;
    glm::vec4 slope_unit{1.0F};
  };
  void UploadHorizons(const TerrainHorizons& horizons);

  std::shared_ptr<const TerrainHorizons> horizons_;  // horizons in the texture
  GlTexture horizon_texture_;
  std::array<std::optional<OfSource>, kLightSources> of_source_;
};

/// Returns the shader text, which follows that of the ground's light.
[[nodiscard]] std::vector<ShaderPiece> SkyByPixelTexts();

}  // namespace alpenglow::viewer
