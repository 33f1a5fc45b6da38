// SPDX-License-Identifier: MIT
// Bodies of air of their own: a cloud of smoke, a fog bank, a plume of gas. A density, 1 unless
// said otherwise, within a box or an ellipsoid, times what a metre of density 1 does to light.
//
//   homogeneous   1
//   exponential   exp(-z / H), z the height over the bottom of the body
//   grid          trilinear between samples (VolumeGrid)
//
// A body is flat: the planet's curvature below it is not seen in it (over 2 km, 0.1 m).
#pragma once

#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "atmosphere/sun/geodesy.h"
#include "renderer/layer.h"
#include "renderer/scene/volume_grid.h"

namespace alpenglow::renderer {

/// Where a body stands, in the frame of SceneGround.
struct VolumePlacement {
  enum class Shape { kBox, kEllipsoid };
  Shape shape = Shape::kBox;
  glm::dvec3 bottom{0.0};            // the middle of its underside
  glm::dvec3 across{1.0, 0.0, 0.0};  // unit vectors at right angles
  glm::dvec3 ahead{0.0, 1.0, 0.0};
  glm::dvec3 up{0.0, 0.0, 1.0};
  glm::dvec3 size_m{1.0};  // across, ahead, up
};

/// A piece of a line, as distances along it [m].
struct LineSpan {
  double begin_m, end_m;
};

/// A piece of a line and the largest density on it, or more.
struct DensePiece {
  double begin_m, end_m;
  double largest;
};

/// Immutable; safe to ask from many threads. Directions are unit vectors.
class LocalVolume {
 public:
  /// @param scale_height_m  of the density; nothing: homogeneous. Not together with a grid.
  LocalVolume(const VolumePlacement& placement, std::optional<double> scale_height_m,
              std::shared_ptr<const VolumeGrid> grid);

  [[nodiscard]] const VolumePlacement& placement() const { return placement_; }
  [[nodiscard]] const VolumeGrid* grid() const { return grid_.get(); }
  /// The middle of the box around it.
  [[nodiscard]] glm::dvec3 Middle() const;

  /// The point as shares of size_m: the box is the unit cube.
  [[nodiscard]] glm::dvec3 UnitFromFrame(const glm::dvec3& point) const;
  [[nodiscard]] glm::dvec3 FrameFromUnit(const glm::dvec3& unit) const;

  /// Density at a point; 0 outside.
  [[nodiscard]] double DensityAt(const glm::dvec3& point) const;

  /// Where a line within [0, length_m] is inside.
  [[nodiscard]] std::optional<LineSpan> SpanAlong(const glm::dvec3& origin,
                                                  const glm::dvec3& direction,
                                                  double length_m) const;
  /// The pieces of it where there is something, in order.
  [[nodiscard]] std::vector<DensePiece> PiecesAlong(const glm::dvec3& origin,
                                                    const glm::dvec3& direction,
                                                    double length_m) const;
  /// Integral of the density [m] over [0, length_m]. Relative error below 1e-10.
  [[nodiscard]] double Column(const glm::dvec3& origin, const glm::dvec3& direction,
                              double length_m) const;

 private:
  [[nodiscard]] double DensityIn(const glm::dvec3& unit) const;

  VolumePlacement placement_;
  std::optional<double> scale_height_m_;
  std::shared_ptr<const VolumeGrid> grid_;
};

}  // namespace alpenglow::renderer
