// SPDX-License-Identifier: MIT
// A ColourDrape resampled over a rectangle of the frame's plane, as a texture has it.
//
// The picture, of colours or land cover, that a scene lays over its terrain, and where it lies.
//
// What ground_light.glsl and ground_surface.glsl read of C++: uniform blocks byte for byte, as
// uniform_blocks.h does it, textures, and the texts put together for what the ground is made of.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec4.hpp>
#include <memory>
#include <vector>

#include "renderer/ground/colour_drape.h"
#include "renderer/ground/scene_ground.h"
#include "renderer/ground/surface.h"
#include "renderer/scene/scene.h"
#include "viewer/air/solved_air.h"
#include "viewer/gl/gl_objects.h"
#include "viewer/gl/shader.h"
#include "viewer/ground/sky_on_ground.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// East and north in the frame of the ground [m].
struct FlatRectangle {
  double west_m, south_m, width_m, depth_m;
};

/// Around all vertices.
[[nodiscard]] FlatRectangle RectangleOf(const TriangleMesh& mesh);

/// What of a rectangle a picture covers, to a hundredth of its sides; all of it where that is
/// nothing.
[[nodiscard]] FlatRectangle CoveredPart(const ColourDrape& drape, const FlatRectangle& of);

/// Row 0 is the southernmost; linear sRGB in 16 bits, and 65535 where there is a picture.
struct DrapeTexels {
  FlatRectangle place;
  std::size_t columns, rows;
  std::vector<std::array<std::uint16_t, 4>> rgba;

  /// @param most  texels a side.
  DrapeTexels(const ColourDrape& drape, const FlatRectangle& over, std::size_t most);
};

struct SceneDrape {
  std::shared_ptr<const ColourDrape> colours;  // null: the scene names none
  FlatRectangle place{};                       // of the terrain, what it covers
};

/// @param ground  of the scene; its terrain, if it has none, is loaded for its frame and its rim.
[[nodiscard]] SceneDrape DrapeOf(const Scene& scene, const SceneGround& ground);

/// Finer than the picture, so that edges stay where they are when it is interpolated once more; 4096
/// texels a side at most, which take 180 MB. Only where there are colours.
[[nodiscard]] DrapeTexels TexelsOf(const SceneDrape& drape);

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
