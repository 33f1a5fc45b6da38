// SPDX-License-Identifier: MIT
#include "renderer/camera/camera_rays.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "atmosphere/number/constants.h"

namespace alpenglow::renderer {

CameraRays::CameraRays(const Camera& camera, int width, int height, const CameraStand& stand)
    : width_(width),
      height_(height),
      panorama_(camera.IsPanorama()),
      tangent_(std::tan(0.5 * camera.fov_rad)),
      eye_(stand.eye),
      polariser_rad_(camera.polariser_rad) {
  const double heading = camera.heading_rad, pitch = camera.pitch_rad, roll = camera.roll_rad;
  const glm::dvec3 forward{std::cos(pitch) * std::sin(heading), std::cos(pitch) * std::cos(heading),
                           std::sin(pitch)};
  const glm::dvec3 level_right{std::cos(heading), -std::sin(heading), 0.0};
  const glm::dvec3 level_up = glm::cross(level_right, forward);
  forward_ = stand.frame_from_enu * forward;
  right_ = stand.frame_from_enu * (std::cos(roll) * level_right - std::sin(roll) * level_up);
  up_ = stand.frame_from_enu * (std::cos(roll) * level_up + std::sin(roll) * level_right);
  if (camera.lens && !panorama_) {
    const ThinLens& lens = *camera.lens;
    lens_ = Lens{Iris(lens.blades, lens.blade_rotation_rad),
                 0.5 * lens.focal_length_m / lens.f_number, lens.focus_m};
  }
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

CameraRay CameraRays::MiddleRay(double x, double y) const {
  const glm::dvec3 direction = Direction(x, y);
  return {eye_, eye_, direction, direction};
}

CameraRay CameraRays::Ray(double x, double y, std::array<double, 2> lens) const {
  if (!lens_) return MiddleRay(x, y);
  const glm::dvec3 through = Direction(x, y);
  const glm::dvec2 point = lens_->radius_m * lens_->iris.Point(lens);
  const glm::dvec3 offset = point.x * right_ + point.y * up_;
  const glm::dvec3 in_focus = lens_->focus_m / glm::dot(through, forward_) * through;
  return {eye_, eye_ + offset, glm::normalize(in_focus - offset), through};
}

std::optional<std::array<double, 2>> CameraRays::PlaceOf(const glm::dvec3& direction) const {
  const double ahead = glm::dot(direction, forward_);
  const double right = glm::dot(direction, right_), up = glm::dot(direction, up_);
  if (panorama_) {
    const double elevation = std::asin(std::clamp(up / glm::length(direction), -1.0, 1.0));
    return std::array{width_ * (0.5 + std::atan2(right, ahead) / (2.0 * kPi)),
                      height_ * (0.5 - elevation / kPi)};
  }
  if (ahead <= 0.0) return std::nullopt;
  const double scale = 2.0 * tangent_ / width_;
  return std::array{0.5 * width_ + right / (ahead * scale), 0.5 * height_ - up / (ahead * scale)};
}

PictureAxes CameraRays::AxesAt(const glm::dvec3& direction) const {
  const glm::dvec3 level = panorama_ ? glm::cross(direction, up_) : right_;
  const glm::dvec3 up = glm::normalize(glm::cross(level, direction));
  return {up, glm::cross(direction, up)};
}

std::optional<glm::dvec3> CameraRays::PassedBy(const glm::dvec3& direction) const {
  if (!polariser_rad_) return std::nullopt;
  const double cosine = std::cos(*polariser_rad_), sine = std::sin(*polariser_rad_);
  if (panorama_) {
    const PictureAxes axes = AxesAt(direction);
    return cosine * axes.up + sine * axes.right;
  }
  return glm::normalize(glm::cross(cosine * right_ - sine * up_, direction));
}

double CameraRays::PixelAngle() const {
  return panorama_ ? 2.0 * kPi / width_ : 2.0 * tangent_ / width_;
}

double CameraRays::BlurRadius(const glm::dvec3& offset) const {
  const double depth_m = glm::dot(offset, forward_);
  if (!lens_ || !(depth_m > 0.0)) return 0.0;
  return lens_->radius_m * std::abs(1.0 / depth_m - 1.0 / lens_->focus_m);
}

std::optional<CameraRays::Blur> CameraRays::BlurAt(const glm::dvec3& offset,
                                                   const glm::dvec3& through,
                                                   double soft_radius) const {
  const double depth_m = glm::dot(offset, forward_);
  const double ahead = glm::dot(through, forward_);
  if (!(depth_m > 0.0) || !(ahead > 0.0)) return std::nullopt;
  const glm::dvec2 point(glm::dot(offset, right_) / depth_m, glm::dot(offset, up_) / depth_m);
  const glm::dvec2 seen(glm::dot(through, right_) / ahead, glm::dot(through, up_) / ahead);
  const double unsharpness = 1.0 / depth_m - 1.0 / lens_->focus_m;  // signed
  const double blur = lens_->radius_m * std::abs(unsharpness);
  // The line from the point in focus to this one meets the lens at (point - seen) / (1/z - 1/s).
  const glm::dvec2 apart = (unsharpness > 0.0 ? 1.0 : -1.0) * (point - seen);
  const double edge = lens_->iris.EdgeTowards(apart);
  const double outer = blur + soft_radius;
  const double t = glm::length(apart) / (outer * edge);
  if (t >= 1.0) return std::nullopt;
  // Half of the height is where the lens has its edge, at a blur much wider than the softness.
  const double n = 1.0 + 0.614 * blur / soft_radius;
  // Of the plane one metre ahead, as solid angle.
  const double area = lens_->iris.area() * outer * outer * ahead * ahead * ahead;
  const double mean = 1.0 - 2.0 / (n + 1.0) + 1.0 / (2.0 * n + 1.0);
  const double falloff = 1.0 - std::pow(t, 2.0 * n);
  const double reach = lens_->radius_m / outer;  // of the lens, per unit of the blur
  const glm::dvec2 on_lens = reach * apart;
  return Blur{on_lens.x * right_ + on_lens.y * up_, falloff * falloff / (area * mean)};
}

CameraRays Between(const CameraRays& from, const CameraRays& to, double share) {
  CameraRays between = from;
  const auto mixed = [&](const auto& a, const auto& b) { return (1.0 - share) * a + share * b; };
  between.eye_ = mixed(from.eye_, to.eye_);
  between.tangent_ = mixed(from.tangent_, to.tangent_);
  between.forward_ = glm::normalize(mixed(from.forward_, to.forward_));
  between.right_ = glm::normalize(glm::cross(between.forward_, mixed(from.up_, to.up_)));
  between.up_ = glm::cross(between.right_, between.forward_);
  return between;
}

}  // namespace alpenglow::renderer
