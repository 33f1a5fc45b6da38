// SPDX-License-Identifier: MIT
// Disks of sun and moon that are too small for the rays of a picture: how much of their light the
// rays meet would depend on where they pass the disk.
//
// Such a disk is drawn in a view of its own, in which it is large, with the land before it. Each
// texel of that picture then sends its light to the pixels around its place in the whole picture,
// with weights that sum to 1. So the light in the whole picture is that of the visible part of the
// disk, with the transmittance of its own direction, for pixels of any size.
#pragma once

#include <glm/vec3.hpp>

#include "viewer/gl/gl_context.h"
#include "viewer/gl/render_target.h"
#include "viewer/gl/shader.h"
#include "viewer/land/land_pass.h"
#include "viewer/passes/painted_view.h"

namespace alpenglow::viewer {

/// Returns whether a disk is too small for one ray per pixel: with a radius of less than 2.5 pixels,
/// the light that they meet may be off by more than 5 %.
/// @param towards  unit vector east, north, up at the eye.
/// @param radius_rad  angular radius.
[[nodiscard]] bool IsSmallDisk(const glm::dvec3& towards, double radius_rad,
                               const PaintedView& view);

/// Paints the light of one disk after the other. An OpenGL context must be current in all calls.
class SmallDiskPainter {
 public:
  /// Width and height of the picture. The disk has a radius of 12 texels.
  static constexpr int kSide = 32;

  SmallDiskPainter();

  /// Returns the view in which a disk is drawn, of kSide x kSide pixels.
  /// @param radius_rad  at least SmallestRadius.
  [[nodiscard]] static PaintedView ViewOf(const glm::dvec3& towards, double radius_rad,
                                          const PaintedView& whole);
  /// Returns the smallest angular radius [rad] of a disk as drawn in that view: the shaders' vectors
  /// resolve a thousandth of it. In the whole picture it is at most half a pixel.
  [[nodiscard]] static double SmallestRadius(const PaintedView& whole);

  /// Receives the linear picture of the disk in ViewOf, and the depth of the land before it.
  [[nodiscard]] const RenderTarget& light() const { return light_; }
  [[nodiscard]] const DepthPrepass& outline() const { return outline_; }

  /// Adds the light of the disk to the bound target, over land too: a pixel stands for all that is
  /// seen in it. The uniform block View must be that of the whole view.
  /// @param alone  ViewOf the disk.
  void AddTo(const PaintedView& whole, const PaintedView& alone) const;

 private:
  ShaderProgram program_;
  RenderTarget light_;
  DepthPrepass outline_;
  GlVertexArray no_vertices_;
};

}  // namespace alpenglow::viewer
