// SPDX-License-Identifier: MIT
// Provides the C++ side of ground_light.glsl and ground_surface.glsl: uniform blocks with identical
// byte layout (as in uniform_blocks.h), textures, and the shader texts for the material of the
// ground. It also provides the ColourDrape of a scene, a picture of colours or land cover over its
// terrain, resampled to a texture over a rectangle of the frame's plane.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec4.hpp>
#include <memory>
#include <vector>

#include "lut/camera_tables/air_tables.h"
#include "renderer/illumination/lighting.h"
#include "renderer/illumination/sky_on_ground.h"
#include "renderer/scene/scene.h"
#include "renderer/surface/colour_drape.h"
#include "renderer/surface/scene_ground.h"
#include "renderer/surface/surface.h"
#include "viewer/gl/gl_objects.h"
#include "viewer/gl/shader.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// Returns the part of a rectangle that the drape covers, to a hundredth of its sides; the whole
/// rectangle if the drape covers none of it.
[[nodiscard]] FlatRectangle CoveredPart(const ColourDrape& drape, const FlatRectangle& of);

/// Texels of a drape. Row 0 is the southernmost. Colours are linear sRGB in 16 bits; alpha is 65535
/// where the drape has a colour.
struct DrapeTexels {
  FlatRectangle place;
  std::size_t columns, rows;
  std::vector<std::array<std::uint16_t, 4>> rgba;

  /// @param most  texels per side.
  DrapeTexels(const ColourDrape& drape, const FlatRectangle& over, std::size_t most);
};

struct SceneDrape {
  std::shared_ptr<const ColourDrape> colours;  // null: the scene has no drape
  FlatRectangle place{};                       // part of the terrain that the drape covers
};

/// @param ground  ground of the scene. If it has no terrain, the terrain is loaded for its frame
///     and its rim.
[[nodiscard]] SceneDrape DrapeOf(const Scene& scene, const SceneGround& ground);

/// Resamples the drape with texels finer than its pixels, so that edges keep their position under
/// another interpolation; at most 4096 texels per side, which take 180 MB. The drape must have
/// colours.
[[nodiscard]] DrapeTexels TexelsOf(const SceneDrape& drape);

/// Mirrors the uniform block `GroundLight` of ground_light.glsl.
struct GroundLightBlock {
  glm::vec4 sky_towards;
  glm::vec4 ground_view;
  std::array<glm::vec4, SkyIrradianceGradient::kColumns * SkyIrradianceGradient::kRows> open_sky;
};
static_assert(sizeof(GroundLightBlock) == 47 * sizeof(glm::vec4));
static_assert(offsetof(GroundLightBlock, ground_view) == sizeof(glm::vec4));

/// @param to_sun  unit vector in the frame of the eye.
/// @param pixel_angle_rad  angle between neighbouring pixels; a larger angle gives coarser detail.
[[nodiscard]] GroundLightBlock GroundLightBlockOf(const SkyIrradianceGradient& tilt,
                                                  const glm::dvec3& to_sun, double pixel_angle_rad);

/// Mirrors the uniform block `GroundSurface` of ground_surface.glsl.
struct GroundSurfaceBlock {
  glm::vec4 cover_albedo, rough, coat, water, under_water, snow_y;
  glm::vec4 drape_red, drape_green, drape_blue, drape_place, drape_eye;
  std::array<glm::vec4, 17> by_root_mu;
};
static_assert(sizeof(GroundSurfaceBlock) == 28 * sizeof(glm::vec4));
static_assert(offsetof(GroundSurfaceBlock, drape_red) == 6 * sizeof(glm::vec4));
static_assert(offsetof(GroundSurfaceBlock, by_root_mu) == 11 * sizeof(glm::vec4));

/// Returns the block with all values that do not depend on the eye.
[[nodiscard]] GroundSurfaceBlock GroundSurfaceBlockOf(const GroundMaterial& material);
/// Returns the block with the rectangle of a drape.
/// @param eye_x_m, eye_y_m  position of the eye in the frame of the ground.
[[nodiscard]] GroundSurfaceBlock Draped(GroundSurfaceBlock block, const FlatRectangle& picture,
                                        double eye_x_m, double eye_y_m);

/// Properties of the terrain of a scene that select shader code.
struct LandKind {
  bool is_there;         // the planet continues beyond it as low land
  bool has_fine_relief;  // TerrainSource::HasFineRelief
};

/// Returns the shader texts of GroundRadiance and PlanetRadiance for this material. They follow the
/// shared texts, air_block, view_block, sun_light and TransmittanceToSun.
[[nodiscard]] std::vector<ShaderPiece> GroundTexts(const GroundMaterial& material,
                                                   const LandKind& land);

/// Textures of the samplers of these texts.
class GroundTextures {
 public:
  /// @param multiple_scattering  light of the air over the ground.
  explicit GroundTextures(const MultipleScattering& multiple_scattering);

  /// Updates the textures for another medium.
  void SetAir(const MultipleScattering& multiple_scattering) const;
  void SetSeaMirror(LightSource source, const std::vector<BandTexel>& texels) const;
  void SetDrape(const DrapeTexels& texels) const;

  /// Binds the textures to three units, beginning with `first_unit`, and assigns the samplers of a
  /// program to them.
  /// @param source  light source whose sky is mirrored by waves.
  void Bind(const ShaderProgram& program, int first_unit, LightSource source) const;

 private:
  GlTexture level_sky_, drape_;
  std::array<GlTexture, kLightSources> sea_mirrors_;
};

}  // namespace alpenglow::viewer
