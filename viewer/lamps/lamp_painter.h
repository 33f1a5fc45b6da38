// SPDX-License-Identifier: MIT
// Provides LampPainter, which draws lamps on the GPU. The steps of a frame are
//
//   Prepare          selects lamps for a view
//   PaintGlow        their light in the air at every few pixels, unless it is summed for each pixel
//   Bind             for the program that has texts(), for LampsOnGround and LampAirlightRgb
//   PaintOver        adds the disks of lamps and the bright cores of their light to the picture
//
// tests/viewer/lamps/lamp_light_test.cpp bounds the errors against LampLight without shadows of
// terrain, due to the quadrature with 12 nodes and the float of the GPU. Terrain hides lamps by a
// horizon around each (ShadeAround), to 2e-3 of the distance in height, a hundredth of a turn in
// azimuth and a twentieth of the distance along it. Between two nodes of the quadrature the
// shadowed part of the ray is omitted. The lit ground comes from the renderer's shadow rays, which
// are traced beside drawing (LampShadowField); until they are finished, that horizon is used.
#pragma once

#include <optional>
#include <vector>

#include "renderer/lamps/scene_lamps.h"
#include "viewer/gl/render_target.h"
#include "viewer/gl/shader.h"

namespace alpenglow::viewer {

struct LampQuality {
  int nodes = 12;  // nodes of the integral along a ray, [2, 32]
  int step = 1;    // pixels between rays; 1: one ray per pixel

  bool operator==(const LampQuality&) const = default;
};
/// High differs from LampLight by 0.5 % in the mean, and 99.9 % of pixels are within 2 %
/// (tests/viewer/lamps/lamp_light_test.cpp). Medium was measured against 12 nodes at each of
/// 1280 x 720 pixels, eight lamps in a layer: mean 0.2 %, 99.9 % within 3.5 %, except at edges of
/// beams, which are as coarse as the steps.
inline constexpr LampQuality kLowLamps{4, 4};
inline constexpr LampQuality kMediumLamps{5, 6};
inline constexpr LampQuality kHighLamps{12, 1};

/// Returns texts for a fragment stage, which follow SharedTexts() and view/block.glsl:
/// LampsOnGround(point_m, normal, ray_width_m), LampAirlightRgb(direction, end_m),
/// LampRayEnd(direction, surface_m).
/// @param shape  lamps that determine the features of the shaders: tables, a layer, phase functions.
[[nodiscard]] std::vector<ShaderPiece> LampTexts(const SceneLamps& shape,
                                                 const LampQuality& quality);

/// Returns these functions for pictures without lamps.
[[nodiscard]] std::vector<ShaderPiece> NoLampTexts();

/// Binding points of the lamps' data.
struct LampUnits {
  GLuint lamps_block = 8;
  GLuint view_block = 1;  // block "View" of view/block.glsl
  int surface = 0;        // texture unit of the surface map
  int first = 8;          // first of six texture units
};

class LampPainter {
 public:
  /// @param shape  as in LampTexts().
  LampPainter(const SceneLamps& shape, const LampQuality& quality, const LampUnits& units);

  [[nodiscard]] const std::vector<ShaderPiece>& texts() const { return texts_; }
  /// Connects a program with these texts to the bound data. Call it once for each program.
  void Connect(const ShaderProgram& program) const;

  /// @param dimmest_cd_per_m2, most  see SceneLamps::Before.
  void Prepare(SceneLamps& lamps, const LampView& view, double dimmest_cd_per_m2,
               std::size_t most = kMostGpuLamps);
  /// Prepares a view without lamps.
  void PutOut() { lamps_ = disks_ = 0; }
  /// Returns whether a quality uses the same programs; then SetStep is sufficient to select it.
  [[nodiscard]] bool Suits(const LampQuality& quality) const {
    return quality.nodes == quality_.nodes && (quality.step == 1) == (quality_.step == 1);
  }
  void SetStep(int step) { quality_.step = step; }
  /// Returns whether no light would be added by the functions below.
  [[nodiscard]] bool IsDark() const { return lamps_ == 0 && disks_ == 0; }

  /// Paints the light of lamps in the air into its own target. It reads the surface map, whose unit
  /// is bound, and the view block.
  /// @param width, height  of the picture [pixels].
  void PaintGlow(int width, int height);
  /// Binds textures and block for the next draw call of a program with texts().
  void Bind() const;
  /// Adds light to the bound target, over the picture.
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
