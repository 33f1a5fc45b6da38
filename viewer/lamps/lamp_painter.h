// SPDX-License-Identifier: MIT
// Lamps on the graphics card. A frame:
//
//   Prepare          which lamps, from where
//   PaintGlow        their light in the air at every few pixels, if it is not summed at each one
//   Bind             for the program that has texts(): LampsOnGround and LampGlowRgb in the picture
//   PaintOver        lamps themselves, and the cores of their light, added to the picture
//
// Errors against LampLight where terrain shades nothing: of the rule with 12 nodes and the float
// of the card, tests/viewer/lamps/lamp_light_test.cpp. Terrain hides lamps by a horizon around each
// (ShadeAround), to 2e-3 of the distance, a hundredth of a turn and a twentieth of the distance; of
// the way between two nodes of the rule the part that is shaded is left out. Ground that they light
// is what the renderer's shadow rays have found beside drawing (LitPlan), and until then what that
// horizon says.
#pragma once

#include <optional>
#include <vector>

#include "viewer/gl/render_target.h"
#include "viewer/gl/shader.h"
#include "viewer/lamps/scene_lamps.h"

namespace alpenglow::viewer {

struct LampQuality {
  int nodes = 12;  // of the integral along a ray, [2, 32]
  int step = 1;    // pixels between rays; 1: each has its own

  bool operator==(const LampQuality&) const = default;
};
/// High is off by 0.5 % in the mean from LampLight and 99.9 % of pixels are within 2 %
/// (tests/viewer/lamps/lamp_picture_test.cpp). Medium was measured against 12 nodes at each of
/// 1280 x 720 pixels, eight lamps in fog: mean 0.2 %, 99.9 % within 3.5 %, but for edges of beams,
/// which are as coarse as the steps.
inline constexpr LampQuality kLowLamps{4, 4};
inline constexpr LampQuality kMediumLamps{5, 6};
inline constexpr LampQuality kHighLamps{12, 1};

/// Texts for a fragment stage, after SharedTexts() and view_block.glsl: LampsOnGround(point_m,
/// normal, ray_width_m), LampGlowRgb(direction, end_m), LampRayEnd(direction, surface_m).
/// @param shape  lamps that decide what shaders know of: tables, fog, phase functions.
[[nodiscard]] std::vector<ShaderPiece> LampTexts(const SceneLamps& shape,
                                                 const LampQuality& quality);

/// The functions that a picture calls, where there are no lamps.
[[nodiscard]] std::vector<ShaderPiece> NoLampTexts();

/// Where what lamps read is bound.
struct LampUnits {
  GLuint lamps_block = 8;
  GLuint view_block = 1;  // "View" of view_block.glsl
  int surface = 0;        // texture unit of the surface map
  int first = 8;          // of six texture units
};

class LampPainter {
 public:
  /// @param shape  as for LampTexts().
  LampPainter(const SceneLamps& shape, const LampQuality& quality, const LampUnits& units);

  [[nodiscard]] const std::vector<ShaderPiece>& texts() const { return texts_; }
  /// Ties a program made of these texts to what it reads; once.
  void Connect(const ShaderProgram& program) const;

  /// @param dimmest_cd_per_m2, most  see SceneLamps::Before.
  void Prepare(SceneLamps& lamps, const LampView& view, double dimmest_cd_per_m2,
               std::size_t most = kMostGpuLamps);
  /// Whether a quality has the same programs; then SetStep is enough to have it.
  [[nodiscard]] bool Suits(const LampQuality& quality) const {
    return quality.nodes == quality_.nodes && (quality.step == 1) == (quality_.step == 1);
  }
  void SetStep(int step) { quality_.step = step; }
  /// Nothing of what follows adds any light.
  [[nodiscard]] bool IsDark() const { return lamps_ == 0 && disks_ == 0; }

  /// Reads the surface map, whose unit is bound, and the view block. Binds its own target.
  /// @param width, height  of the picture [pixels].
  void PaintGlow(int width, int height);
  /// Textures and block for the next draw of a program of texts().
  void Bind() const;
  /// Into the target that is bound, over the picture.
  void PaintOver(double pixel_angle_rad) const;

 private:
  void UploadTables(const SceneLamps& shape);
  void UploadGlows(const SceneLamps& shape);
  void UploadShades(const SceneLamps& shape);
  void UploadPlans(const SceneLamps& shape);

  LampQuality quality_;
  LampUnits units_;
  std::vector<ShaderPiece> texts_;
  GlBuffer block_, disk_buffer_;
  GlVertexArray no_vertices_, disk_vertices_;
  GlTexture tables_, glows_, mie_table_, shades_, plans_;
  std::optional<ShaderProgram> glow_program_, core_program_, disk_program_;
  std::optional<RenderTarget> lattice_;
  int lamps_ = 0, disks_ = 0;
  std::size_t uploaded_plans_ = 0;
  int uploaded_layers_ = 0;
};

}  // namespace alpenglow::viewer
