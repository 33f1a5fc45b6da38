// SPDX-License-Identifier: MIT
// Provides FrameTransform, which transforms points and directions between two local frames.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "atmosphere/time_place/geodesy.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// A rigid transform from one local frame (east, north, up) to another of the same ellipsoid.
class FrameTransform {
 public:
  FrameTransform(const LocalFrame& to, const LocalFrame& from);

  /// Returns a point [m] of the frame `from` in the frame `to`.
  [[nodiscard]] glm::dvec3 Point(const glm::dvec3& point_m) const {
    return origin_m_ + axes_ * point_m;
  }
  /// Returns a direction of the frame `from` in the frame `to`.
  [[nodiscard]] glm::dvec3 Along(const glm::dvec3& direction) const { return axes_ * direction; }
  /// Returns a point [m] of the frame `to` in the frame `from`.
  [[nodiscard]] glm::dvec3 PointBack(const glm::dvec3& point_m) const {
    return (point_m - origin_m_) * axes_;
  }

  /// Returns east, north and up of the frame `from`, as columns, in the frame `to`.
  [[nodiscard]] const glm::dmat3& axes() const { return axes_; }
  /// Returns the origin of the frame `from` in the frame `to` [m].
  [[nodiscard]] const glm::dvec3& origin_m() const { return origin_m_; }

 private:
  glm::dmat3 axes_;
  glm::dvec3 origin_m_;
};

/// Returns the distance between the origins of two frames of the same ellipsoid [m].
[[nodiscard]] double DistanceBetween(const LocalFrame& a, const LocalFrame& b);

}  // namespace alpenglow::renderer
