// SPDX-License-Identifier: MIT
// A camera while its shutter is open: what moves in that time is drawn along its way.
#pragma once

#include <vector>

#include "renderer/camera/camera_rays.h"

namespace alpenglow::renderer {

class MovingCamera {
 public:
  /// A camera that stands.
  MovingCamera(const CameraRays& camera) : steps_{camera} {}  // NOLINT: a camera is one that moves
  /// @param steps  at least one: at even steps of time, the first as the shutter opens, the last as
  ///     it closes. In between the camera goes straight.
  explicit MovingCamera(std::vector<CameraRays> steps);

  [[nodiscard]] bool IsMoving() const { return steps_.size() > 1; }
  /// At half of the time.
  [[nodiscard]] const CameraRays& middle() const { return steps_[steps_.size() / 2]; }

  /// @param time  in [0, 1): share of the time that the shutter is open. Else as CameraRays::Ray.
  [[nodiscard]] CameraRay Ray(double x, double y, std::array<double, 2> lens, double time) const;

 private:
  std::vector<CameraRays> steps_;
};

}  // namespace alpenglow::renderer
