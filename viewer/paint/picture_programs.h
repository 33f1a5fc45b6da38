// SPDX-License-Identifier: MIT
// Where what programs of a picture read is bound: one number each, so that passes do not take each
// other's places.
//
// What the fragment stages of a picture are put together from: one text, picture.frag.glsl, for
// land, sky and disks, after texts for what there is in a scene.
//
// The uniform blocks of a picture: what its programs read of the air, the view and the ground, on
// its way to the card.
//
// The programs of a picture, one a stage, made when a stage is first drawn with and kept.
//
// Drivers finish a program when it is drawn with, which takes tenths of a second. Stages that will
// be needed later, when shade begins or ends, or a disk comes into view, are drawn with in the
// first frames, over one pixel that is painted after.
#pragma once

#include <glm/vec2.hpp>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "atmosphere/air/phase.h"
#include "atmosphere/sun/sun.h"
#include "renderer/ground/surface.h"
#include "viewer/air/air_follower.h"
#include "viewer/air/solved_air.h"
#include "viewer/gl/gl_objects.h"
#include "viewer/gl/shader.h"
#include "viewer/ground/ground_block.h"
#include "viewer/lamps/fog.h"
#include "viewer/lamps/lamp_painter.h"
#include "viewer/paint/key_light.h"
#include "viewer/paint/painted_scene.h"
#include "viewer/paint/painted_view.h"
#include "viewer/shade/shafts.h"
#include "viewer/shaders/uniform_blocks.h"

namespace alpenglow::viewer {

/// Of uniform blocks.
enum PictureBinding : GLuint {
  kAirBinding,
  kViewBinding,
  kGroundBinding,
  kGroundLightBinding,
  kGroundSurfaceBinding,
  kSkyByPixelBinding,
  kTablesBinding,
  kLampsBinding,
  kFogBinding
};

/// Of textures.
enum PictureUnit {
  kSurfaceUnit,
  kSkyOnSurfaceUnit,
  kShaftUnit,
  kFogShaftUnit,
  kShadeUnit,
  kUploadUnit,
  kAirUnit,
  kGroundUnit = kAirUnit + AirTextures::kUnits,
  kLampUnit = kGroundUnit + 3,
  kFogUnit = kLampUnit + 6,
  kNightUnit = kFogUnit + 2,
  kSkyByPixelUnit = kNightUnit + 1,
};

inline constexpr LampUnits kLampUnits{kLampsBinding, kViewBinding, kSurfaceUnit, kLampUnit};
inline constexpr FogUnits kFogUnits{kFogBinding, kFogUnit};

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

/// Each call fills blocks and binds them (PictureBinding).
class PictureBlocks {
 public:
  void UploadAir(const PaintedScene& scene, const Eye& eye);
  /// @param ray  that is painted of each pixel.
  void UploadView(const PaintedScene& scene, const PaintedView& view, const KeyLight& key,
                  const PixelRay& ray) const;
  void UploadGround(const PaintedScene& scene, const PaintedView& view) const;
  void UploadGroundLight(const PaintedScene& scene, const PaintedView& view,
                         const KeyLight& light) const;
  /// Nothing where vertices have the sky's light.
  void UploadSkyByPixel(const PaintedScene& scene, const PaintedView& view,
                        const KeyLight& light) const;

 private:
  GlBuffer air_, view_, ground_, ground_light_, ground_surface_, sky_by_pixel_;
  // Of the air that was drawn last: colours of its bands take milliseconds.
  std::shared_ptr<const SolvedAir> known_air_;
  AirBlock air_block_{};
};

class PicturePrograms {
 public:
  /// Everything that programs read must outlive this.
  PicturePrograms(const PaintedScene& scene, const LampPainter& lamps, const ShaftPass& shafts);

  /// Paints the whole viewport, but land only over land, and sky and disks only beside it: by the
  /// depth of the target that is bound, which must be tested.
  /// @param source  whose sky waves mirror; its air, blocks and maps are bound.
  void Paint(const PictureStage& stage, LightSource source = LightSource::kSun);
  /// Draws with a stage that Paint was not called for yet. Whether that was to be done.
  bool MakeReady(const PictureStage& stage);

  /// Whether any stage has been drawn with.
  [[nodiscard]] bool HasPainted() const { return !ready_.empty(); }

  /// For uniforms of the stage's own.
  [[nodiscard]] const ShaderProgram& Of(const PictureStage& stage);

  /// The lamp painter is another.
  void ForgetThoseWithLamps();

 private:
  [[nodiscard]] ShaderProgram Made(const PictureStage& stage) const;

  const PaintedScene& scene_;
  const LampPainter& lamps_;
  const ShaftPass& shafts_;
  std::map<PictureStage, ShaderProgram> made_;
  std::set<PictureStage> ready_;  // those that have been drawn with
  GlVertexArray no_vertices_;
};

}  // namespace alpenglow::viewer
