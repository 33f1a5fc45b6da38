// SPDX-License-Identifier: MIT
// The shader programs of a picture: their bindings, shader texts and uniform blocks.
//
// Every uniform block (block_bindings.h) and texture has a binding number of its own, so that
// passes do not overwrite each other's bindings. The fragment stages share one text,
// picture/picture.frag.glsl, for land, sky and disks, preceded by texts that depend on the scene.
// There is one program per stage, created on first use and kept. A program adds the light of sun,
// moon and night sky, because most of its time is needed for what they light: the ground's pattern
// and the transmittance of the air.
//
// Drivers finish compiling a program on its first draw, which takes tenths of a second. Stages that
// will be needed later, when shadowing begins or ends or a disk comes into view, are therefore
// drawn in the first frames, over one pixel that is overwritten afterwards.
#pragma once

#include <glm/vec2.hpp>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "atmosphere/astronomy/sun.h"
#include "atmosphere/medium/phase.h"
#include "lut/camera_tables/air_tables.h"
#include "renderer/illumination/lighting.h"
#include "renderer/surface/surface.h"
#include "viewer/air/air_follower.h"
#include "viewer/clouds/cloud_pass.h"
#include "viewer/gl/gl_context.h"
#include "viewer/gl/shader.h"
#include "viewer/ground/ground_block.h"
#include "viewer/lamps/lamp_painter.h"
#include "viewer/media/scene_media.h"
#include "viewer/passes/frame.h"
#include "viewer/passes/frame_sky.h"
#include "viewer/passes/painted_scene.h"
#include "viewer/passes/painted_view.h"
#include "viewer/shade/shafts.h"
#include "viewer/shaders/block_bindings.h"
#include "viewer/shaders/pass_setup.h"

namespace alpenglow::viewer {

/// Texture units.
enum PictureUnit {
  kSurfaceUnit,
  kSkyOnSurfaceUnit,
  kOtherSkyOnSurfaceUnit,
  kShaftUnit,
  kMediaShaftUnit,
  kShadeUnit,
  kUploadUnit,
  kAirUnit,
  kOtherAirUnit = kAirUnit + AirTextures::kUnits,
  kGroundUnit = kOtherAirUnit + AirTextures::kUnits,
  kLampUnit = kGroundUnit + GroundTextures::kUnits,
  kMediaUnit = kLampUnit + 6,
  kNightUnit = kMediaUnit + 4,
  kSkyByPixelUnit = kNightUnit + 1,
  kCloudUnit = kSkyByPixelUnit + SkyByPixel::kUnits,
};

inline constexpr LampUnits kLampUnits{kLampsBinding, kViewBinding, kSurfaceUnit, kLampUnit};
inline constexpr MediaUnits kMediaUnits{kMediaBinding, kMediaUnit};
/// The passes before the picture use the units of lamps and media, which are bound after them.
inline constexpr CloudUnits kCloudUnits{kCloudsBinding, kCloudUnit, kSurfaceUnit, kLampUnit};

/// Identifies one program of the picture. kUnoccludedSky is the sky above the horizon, see
/// RowsOfPlanet.
struct PictureStage {
  enum class Pass { kLand, kSky, kDisks, kUnoccludedSky };
  Pass pass;
  bool has_shade = false, has_lamps = false;
  bool two_lights = false, has_night = false;
  bool sky_by_pixel = false;   // SkyByPixel, for land only
  bool other_has_set = false;  // see view/lights.glsl
  int cloud_layers = 0;

  /// Returns the stage of another pass, without properties that this pass does not have.
  [[nodiscard]] PictureStage In(Pass other) const {
    PictureStage stage = *this;
    stage.pass = other;
    stage.sky_by_pixel = sky_by_pixel && other == Pass::kLand;
    stage.other_has_set =
        other_has_set && two_lights && (other == Pass::kLand || other == Pass::kSky);
    return stage;
  }

  auto operator<=>(const PictureStage&) const = default;
};

/// The properties of a scene that its shader texts depend on.
struct PictureKind {
  const GroundMaterial& material;
  const LampPainter& lamps;
  LandKind land;
  MediaKind media;
};

/// Returns the texts of a stage that precede picture/picture.frag.glsl.
[[nodiscard]] std::vector<ShaderPiece> PictureTexts(const PictureKind& kind,
                                                    const PictureStage& stage);

/// Returns the number of textures that the program of a stage reads. It counts all textures of lamps
/// and of the sky, some of which a compiler may omit.
[[nodiscard]] int TexturesOf(const PictureKind& kind, const PictureStage& stage);

/// A stage that a driver can link, and what it lacks.
struct FittingStage {
  PictureStage stage;
  std::vector<std::string> omitted;  // in words
};
/// Returns the stage without as many properties as all passes need to read at most `units` textures:
/// first the shadows in the air, then the second light, the light of the sky by pixel, lamps, and
/// the night sky. Throws DisplayError that names the numbers if that is not enough.
[[nodiscard]] FittingStage Fitting(const PictureKind& kind, const PictureStage& stage, int units);

/// Returns the first of these texts: the view and the medium.
[[nodiscard]] std::vector<ShaderPiece> AirTexts();
/// Returns the pass of clouds with its programs connected.
[[nodiscard]] CloudPass ConnectedClouds();

/// The light of a picture. Of a single light of the sky, "the second light" is a copy, which no
/// program reads.
struct LightsOfView {
  LightsOfSky of_sky;
  glm::vec4 night_scattered{0.0F}, night_level{0.0F};  // NightSkyMap; 0 without it
};

/// The uniform blocks of a picture. Each call fills blocks and binds them (PictureBinding).
class PictureBlocks {
 public:
  void UploadAir(const PaintedScene& scene, const CameraPose& eye);
  /// @param ray  one of each pixel. @param lights  may differ from those of the frame.
  void UploadView(const PaintedScene& scene, const Frame& frame, const PixelRay& ray,
                  const LightsOfView& lights) const;
  void UploadGround(const PaintedScene& scene, const PaintedView& view) const;
  void UploadGroundLight(const PaintedScene& scene, const Frame& frame) const;
  /// For a light without tables the block says so.
  void UploadSkyByPixel(const PaintedScene& scene, const Frame& frame) const;

 private:
  GlBuffer air_, view_, ground_, ground_light_, other_ground_light_, ground_surface_, sky_by_pixel_;
  // The block of the last medium is kept, since computing the colours of its bands takes
  // milliseconds.
  std::shared_ptr<const SolvedAir> known_air_;
  AirBlock air_block_{};
};

class PicturePrograms {
 public:
  /// The arguments must outlive this object.
  PicturePrograms(const PaintedScene& scene, const LampPainter& lamps, const ShaftPass& shafts,
                  const CloudPass& clouds);

  /// Returns the stage that the driver of the current context can link, and tells the user once what
  /// pictures lack because of it.
  [[nodiscard]] PictureStage Fitting(const PictureStage& stage);

  /// Draws the whole viewport. Land is drawn only over land, sky and disks only where there is no
  /// land, by a test against the depth of the bound target. The depth test must be enabled. Air,
  /// blocks and maps of the lights must be bound.
  void Paint(const PictureStage& stage);
  /// Draws once with a stage that was not drawn yet, and returns whether this was necessary.
  bool MakeReady(const PictureStage& stage);

  /// Returns whether any stage has been drawn.
  [[nodiscard]] bool HasPainted() const { return !ready_.empty(); }

  /// Returns the program of a stage, to set uniforms that only this stage has.
  [[nodiscard]] const ShaderProgram& Of(const PictureStage& stage);

  /// Discards the programs with lamps, because the lamp painter has been replaced.
  void ForgetThoseWithLamps();

 private:
  [[nodiscard]] PictureKind Kind() const;
  [[nodiscard]] ShaderProgram Made(const PictureStage& stage) const;

  const PaintedScene& scene_;
  const LampPainter& lamps_;
  const ShaftPass& shafts_;
  const CloudPass& clouds_;
  int units_;                      // of the textures of a fragment stage
  std::set<std::string> omitted_;  // as told
  std::map<PictureStage, ShaderProgram> made_;
  std::set<PictureStage> ready_;  // stages that have been drawn
  GlVertexArray no_vertices_;
};

}  // namespace alpenglow::viewer
