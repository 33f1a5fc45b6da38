// SPDX-License-Identifier: MIT
#include "renderer/camera_rays.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/constants.h"

namespace alpenglow {

CameraRays::CameraRays(const Camera& camera, int width, int height)
    : width_(width),
      height_(height),
      panorama_(camera.IsPanorama()),
      tangent_(std::tan(0.5 * camera.fov_rad)) {
  const double heading = camera.heading_rad, pitch = camera.pitch_rad, roll = camera.roll_rad;
  forward_ = {std::cos(pitch) * std::sin(heading), std::cos(pitch) * std::cos(heading),
              std::sin(pitch)};
  const glm::dvec3 level_right{std::cos(heading), -std::sin(heading), 0.0};
  const glm::dvec3 level_up = glm::cross(level_right, forward_);
  right_ = std::cos(roll) * level_right - std::sin(roll) * level_up;
  up_ = std::cos(roll) * level_up + std::sin(roll) * level_right;
}

glm::dvec3 CameraRays::Direction(double x, double y) const {
  if (panorama_) {
    const double azimuth = (x / width_ - 0.5) * 2.0 * kPi;
    const double elevation = (0.5 - y / height_) * kPi;
    return std::cos(elevation) * (std::cos(azimuth) * forward_ + std::sin(azimuth) * right_) +
           std::sin(elevation) * up_;
  }
  const double scale = 2.0 * tangent_ / width_;
  return glm::normalize(forward_ + (x - 0.5 * width_) * scale * right_ +
                        (0.5 * height_ - y) * scale * up_);
}

double CameraRays::PixelAngle() const {
  return panorama_ ? 2.0 * kPi / width_ : 2.0 * tangent_ / width_;
}

}  // namespace alpenglow
