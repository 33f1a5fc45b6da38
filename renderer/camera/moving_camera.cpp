// SPDX-License-Identifier: MIT
#include "renderer/camera/moving_camera.h"

#include <algorithm>

#include "atmosphere/text/error.h"

namespace alpenglow::renderer {

MovingCamera::MovingCamera(std::vector<CameraRays> steps) : steps_(std::move(steps)) {
  ALPENGLOW_ENSURE(steps_.size(), >=, std::size_t{1});
}

CameraRay MovingCamera::Ray(double x, double y, std::array<double, 2> lens, double time) const {
  if (!IsMoving()) return steps_.front().Ray(x, y, lens);
  const double at = time * static_cast<double>(steps_.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(at), steps_.size() - 2);
  return Between(steps_[i], steps_[i + 1], at - static_cast<double>(i)).Ray(x, y, lens);
}

}  // namespace alpenglow::renderer
