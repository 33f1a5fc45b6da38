// SPDX-License-Identifier: MIT
// What ground_light.glsl and ground_surface.glsl read of C++: uniform blocks byte for byte, as
// uniform_blocks.h does it, textures, and the texts put together for what the ground is made of.
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec4.hpp>
#include <vector>

#include "renderer/ground/ground_material.h"
#include "viewer/air/light_source.h"
#include "viewer/gl/gl_objects.h"
#include "viewer/gl/shader.h"
#include "viewer/ground/drape_texels.h"
#include "viewer/ground/sea_mirror.h"
#include "viewer/ground/sky_tilt.h"

namespace alpenglow::viewer {

/// `block GroundLight` of ground_light.glsl.
struct GroundLightBlock {
  glm::vec4 sky_towards;
  glm::vec4 ground_view;
  std::array<glm::vec4, SkyTilt::kColumns * SkyTilt::kRows> open_sky;
};
static_assert(sizeof(GroundLightBlock) == 47 * sizeof(glm::vec4));
static_assert(offsetof(GroundLightBlock, ground_view) == sizeof(glm::vec4));

/// @param to_sun  unit, in the frame of the eye.
/// @param pixel_angle_rad  between neighbouring pixels; larger: coarser detail.
[[nodiscard]] GroundLightBlock GroundLightBlockOf(const SkyTilt& tilt, const glm::dvec3& to_sun,
                                                  double pixel_angle_rad);

/// `block GroundSurface` of ground_surface.glsl.
struct GroundSurfaceBlock {
  glm::vec4 cover_albedo, rough, coat, water, under_water, snow_y;
  glm::vec4 drape_red, drape_green, drape_blue, drape_place, drape_eye;
  std::array<glm::vec4, 17> by_root_mu;
};
static_assert(sizeof(GroundSurfaceBlock) == 28 * sizeof(glm::vec4));
static_assert(offsetof(GroundSurfaceBlock, drape_red) == 6 * sizeof(glm::vec4));
static_assert(offsetof(GroundSurfaceBlock, by_root_mu) == 11 * sizeof(glm::vec4));

/// What does not change with the eye.
[[nodiscard]] GroundSurfaceBlock GroundSurfaceBlockOf(const GroundMaterial& material);
/// With the place of a draped picture.
/// @param eye_x_m, eye_y_m  of the eye in the frame of the ground.
[[nodiscard]] GroundSurfaceBlock Draped(GroundSurfaceBlock block, const FlatRectangle& picture,
                                        double eye_x_m, double eye_y_m);

/// The terrain of a scene.
struct LandKind {
  bool is_there;         // the planet goes on as its low land
  bool has_fine_relief;  // TerrainSource::HasFineRelief
};

/// GroundRadiance and PlanetRadiance for this material; to be read after the shared texts,
/// air_block, view_block, sun_light and TransmittanceToSun.
[[nodiscard]] std::vector<ShaderPiece> GroundTexts(const GroundMaterial& material,
                                                   const LandKind& land);

/// The samplers of these texts.
class GroundTextures {
 public:
  /// @param diffuse  of the air over the ground.
  explicit GroundTextures(const DiffuseLight& diffuse);

  /// The air over the ground has changed.
  void SetAir(const DiffuseLight& diffuse) const;
  void SetSeaMirror(LightSource source, const std::vector<BandTexel>& texels) const;
  void SetDrape(const DrapeTexels& texels) const;

  /// Binds to three texture units from the first on, and the samplers of a program to them.
  /// @param source  whose sky waves mirror.
  void Bind(const ShaderProgram& program, int first_unit, LightSource source) const;

 private:
  GlTexture level_sky_, drape_;
  std::array<GlTexture, kLightSources> sea_mirrors_;
};

}  // namespace alpenglow::viewer
