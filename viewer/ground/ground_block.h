// SPDX-License-Identifier: MIT
// Provides the C++ side of ground/light.glsl and ground/surface.glsl: uniform blocks with identical
// byte layout (as in pass_setup.h), textures, and the shader texts for the material of the
// ground. It also provides the ColourDrape of a scene, a picture of colours or land cover over its
// terrain, resampled to a texture over a rectangle of the frame's plane.
//
// Provides SkyByPixel, the renderer's tables for the light on slopes between mountains
// (OccludedSkyIrradiance, HorizonMap, TerrainInterreflection) on the GPU.
// shaders/sky_by_pixel/tables.glsl evaluates them for every pixel. Light that is interpolated
// between vertices has errors of up to 10 % at dusk, where a horizon hides the glow
// (tests/bench/README.md).
//
// A pixel reads 56 texels of half floats per source for its irradiance, so only the high quality
// uses these tables for it. Water and glossy land look up what they mirror at every quality.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec4.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "lut/camera_tables/air_tables.h"
#include "renderer/illumination/gloss_mirror.h"
#include "renderer/illumination/lighting.h"
#include "renderer/illumination/sky_irradiance_gradient.h"
#include "renderer/lit_ground/ground_follower.h"
#include "renderer/scene/scene.h"
#include "renderer/surface/colour_drape.h"
#include "renderer/surface/ground_pattern.h"
#include "renderer/surface/scene_ground.h"
#include "renderer/surface/surface.h"
#include "viewer/gl/gl_context.h"
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

/// Mirrors the uniform block `GroundLight` of ground/light.glsl.
struct GroundLightBlock {
  glm::vec4 sky_towards;
  glm::vec4 ground_view;
  std::array<glm::vec4, SkyIrradianceGradient::kColumns * SkyIrradianceGradient::kRows> open_sky;
};
static_assert(sizeof(GroundLightBlock) == 47 * sizeof(glm::vec4));
static_assert(offsetof(GroundLightBlock, ground_view) == sizeof(glm::vec4));

/// @param to_light  unit vector in the frame of the eye.
/// @param pixel_angle_rad  angle between neighbouring pixels; a larger angle gives coarser detail.
[[nodiscard]] GroundLightBlock GroundLightBlockOf(const SkyIrradianceGradient& tilt,
                                                  const glm::dvec3& to_light,
                                                  double pixel_angle_rad);

/// Mirrors the uniform block `GroundSurface` of ground/surface.glsl.
struct GroundSurfaceBlock {
  glm::vec4 cover_albedo, rough, coat, water, under_water, snow_y;
  glm::vec4 drape_red, drape_green, drape_blue, drape_place, drape_eye, drape_east, drape_north;
  std::array<glm::vec4, 17> by_root_mu;
  glm::vec4 mirror_place;
};
static_assert(sizeof(GroundSurfaceBlock) == 31 * sizeof(glm::vec4));
static_assert(offsetof(GroundSurfaceBlock, drape_red) == 6 * sizeof(glm::vec4));
static_assert(offsetof(GroundSurfaceBlock, by_root_mu) == 13 * sizeof(glm::vec4));

/// Returns the block with all values that do not depend on the eye.
[[nodiscard]] GroundSurfaceBlock GroundSurfaceBlockOf(const GroundMaterial& material);
/// Returns the block with the altitudes of a mirror.
[[nodiscard]] GroundSurfaceBlock Mirrored(GroundSurfaceBlock block, const GlossMirror& mirror);
/// Returns the block with the rectangle of a drape, seen by an eye at the origin of its frame.
/// @param eye_from_drape  from the frame of the drape to that of the eye.
[[nodiscard]] GroundSurfaceBlock Draped(GroundSurfaceBlock block, const FlatRectangle& picture,
                                        const FrameTransform& eye_from_drape,
                                        const GroundPattern& pattern);

/// Properties of the terrain of a scene that select shader code.
struct LandKind {
  bool is_there;         // the planet continues beyond it as low land
  bool has_fine_relief;  // TerrainSource::HasFineRelief
};

/// Returns the shader texts of LandSeen, PlanetSeen and SentOn for this material. They follow the
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
  /// Sets what water and glossy land mirror. They mirror nothing before the first call.
  void SetGlossMirror(LightSource source, const GlossMirror& mirror) const;
  void SetDrape(const DrapeTexels& texels) const;

  /// Assigns the samplers of a program to kUnits units, beginning with `first_unit`.
  static constexpr int kUnits = 4;
  static void Connect(const ShaderProgram& program, int first_unit);
  /// Binds the textures to these units.
  /// @param source  first light of the sky, which water and glossy land mirror.
  /// @param other  second light, for programs with TWO_LIGHTS.
  void Bind(int first_unit, LightSource source, LightSource other) const;

 private:
  GlTexture level_sky_, drape_;
  std::array<GlTexture, kLightSources> gloss_mirrors_;
};

/// Mirrors the uniform block `SkyByPixel` of sky_by_pixel/tables.glsl.
struct SkyByPixelBlock {
  glm::vec4 horizon_u, horizon_v, slope_u, slope_v, sky_moment, sky_place, slope_unit;
  glm::vec4 other_sky_moment, other_sky_place, other_slope_unit;
};
static_assert(sizeof(SkyByPixelBlock) == 10 * sizeof(glm::vec4));

/// Returns the block of two lights of the sky over one terrain, from the block of each. Without
/// tables a light has a block of zeros.
[[nodiscard]] SkyByPixelBlock WithLights(const SkyByPixelBlock& first,
                                         const SkyByPixelBlock& other);

/// Returns the integrals of a sky in rows of nodes, from the renderer's layout
/// [level][azimuth][node][A, B][band], for a texture of half floats. With the sun 66
/// degrees down, level ground receives less than 1e-23 of sunlight from its sky, and some integrals
/// are 3e5 times as large. They become 65504, because infinity times that irradiance would be
/// infinite. With the sun up to 33 degrees down, integrals are below 15.
[[nodiscard]] std::vector<float> IntegralTexels(const OccludedSkyIrradiance::Tables& tables);

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
  /// to_light_for_air: direction to the source in this frame.
  /// @param now  current light of the open sky, at the altitude of the one given to Use.
  [[nodiscard]] SkyByPixelBlock BlockOf(LightSource source, const LocalFrame& eye,
                                        const glm::dvec3& to_light_for_air,
                                        const SkyIrradianceGradient& now) const;

  /// Assigns the samplers of a program to kUnits units, beginning with `first_unit`.
  static constexpr int kUnits = 7;
  static void Connect(const ShaderProgram& program, int first_unit);
  /// Binds the textures of the first light of the sky to these units.
  void Bind(int first_unit, LightSource source) const;
  /// Binds the textures of the second light.
  void BindOther(int first_unit, LightSource source) const;

 private:
  struct OfSource {
    GroundFollower::SkyOfSource sky;
    GlTexture integrals, level_irradiance, slopes;
    glm::vec4 slope_unit{1.0F};
  };
  void UploadHorizons(const TerrainHorizons& horizons);
  void BindLight(int first_unit, LightSource source) const;

  std::shared_ptr<const TerrainHorizons> horizons_;  // horizons in the texture
  GlTexture horizon_texture_;
  std::array<std::optional<OfSource>, kLightSources> of_source_;
};

/// Returns the shader text, which follows that of the ground's light.
[[nodiscard]] std::vector<ShaderPiece> SkyByPixelTexts();

}  // namespace alpenglow::viewer
