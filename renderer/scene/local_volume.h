// SPDX-License-Identifier: MIT
// Local participating media: a cloud of smoke, a fog bank, a plume of gas. Each has a density, 1 by
// default, within a box or an ellipsoid, which multiplies its optical properties per metre.
//
//   homogeneous   1
//   exponential   exp(-z / H), z the height over the bottom of the volume
//   grid          trilinear between samples (VolumeGrid)
//
// A volume is flat: the planet's curvature below it is ignored (over 2 km, 0.1 m).
#pragma once

#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "atmosphere/time_place/geodesy.h"
#include "renderer/layer.h"
#include "renderer/scene/volume_grid.h"

namespace alpenglow::renderer {

/// Position and orientation of a volume, in the frame of SceneGround.
struct VolumePlacement {
  enum class Shape { kBox, kEllipsoid };
  Shape shape = Shape::kBox;
  glm::dvec3 bottom{0.0};            // middle of the underside
  glm::dvec3 across{1.0, 0.0, 0.0};  // orthogonal unit vectors
  glm::dvec3 ahead{0.0, 1.0, 0.0};
  glm::dvec3 up{0.0, 0.0, 1.0};
  glm::dvec3 size_m{1.0};  // across, ahead, up
};

/// An interval of a line, as distances along it [m].
struct LineSpan {
  double begin_m, end_m;
};

/// An interval of a line and an upper bound of the density on it.
struct DensePiece {
  double begin_m, end_m;
  double largest;
};

/// Immutable; safe to use from many threads. Directions are unit vectors.
class LocalVolume {
 public:
  /// @param scale_height_m  of the density; empty: homogeneous. Must be empty if there is a grid.
  LocalVolume(const VolumePlacement& placement, std::optional<double> scale_height_m,
              std::shared_ptr<const VolumeGrid> grid);

  [[nodiscard]] const VolumePlacement& placement() const { return placement_; }
  [[nodiscard]] const VolumeGrid* grid() const { return grid_.get(); }
  /// Returns the middle of the bounding box.
  [[nodiscard]] glm::dvec3 Middle() const;

  /// Returns the point as fractions of size_m: the box becomes the unit cube.
  [[nodiscard]] glm::dvec3 UnitFromFrame(const glm::dvec3& point) const;
  [[nodiscard]] glm::dvec3 FrameFromUnit(const glm::dvec3& unit) const;

  /// Returns the density at a point; 0 outside.
  [[nodiscard]] double DensityAt(const glm::dvec3& point) const;

  /// Returns the interval of a line within [0, length_m] that is inside the volume.
  [[nodiscard]] std::optional<LineSpan> SpanAlong(const glm::dvec3& origin,
                                                  const glm::dvec3& direction,
                                                  double length_m) const;
  /// Returns the intervals of that part with density, in order.
  [[nodiscard]] std::vector<DensePiece> PiecesAlong(const glm::dvec3& origin,
                                                    const glm::dvec3& direction,
                                                    double length_m) const;
  /// Returns the integral of the density [m] over [0, length_m]. Relative error below 1e-10.
  [[nodiscard]] double Column(const glm::dvec3& origin, const glm::dvec3& direction,
                              double length_m) const;

 private:
  [[nodiscard]] double DensityIn(const glm::dvec3& unit) const;

  VolumePlacement placement_;
  std::optional<double> scale_height_m_;
  std::shared_ptr<const VolumeGrid> grid_;
};

}  // namespace alpenglow::renderer
