// SPDX-License-Identifier: MIT
// Directions through the pixels of a camera, in the ENU frame of the scene.
#pragma once

#include <glm/vec3.hpp>

#include "renderer/scene.h"

namespace alpenglow {

/// A pinhole (perspective) or a panorama (latitude-longitude: centre = heading, left edge =
/// behind).
class CameraRays {
 public:
  /// @param width, height  of the picture in pixels, >= 1.
  CameraRays(const Camera& camera, int width, int height);

  /// Unit direction through a point of the picture: x in [0, width] to the right, y in [0, height]
  /// down.
  [[nodiscard]] glm::dvec3 Direction(double x, double y) const;

  /// Angle between neighbouring pixels at the centre of the picture [rad].
  [[nodiscard]] double PixelAngle() const;

 private:
  int width_, height_;
  bool panorama_;
  double tangent_;  // of half the horizontal field of view
  glm::dvec3 forward_, right_, up_;
};

}  // namespace alpenglow
