// SPDX-License-Identifier: MIT
#include "viewer/passes/small_disk_painter.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "viewer/passes/picture_programs.h"
#include "viewer/shaders/pass_setup.h"

namespace alpenglow::viewer {
namespace {

// Half the width of the picture of a disk, in radii of the disk.
constexpr double kReach = 1.3;

// Returns the pixel in which a vector from the eye points, in the coordinates of gl_FragCoord.
glm::dvec2 PixelOf(const glm::dvec3& towards, const PaintedView& view) {
  const ViewAxes axes = AxesOf(view);
  const double along = glm::dot(towards, axes.forward);
  const auto share = [&](const glm::dvec3& axis) {
    return glm::dot(towards, axis) / glm::dot(axis, axis) / along;
  };
  const glm::dvec2 at(share(axes.right) - view.part.x * view.part.z,
                      share(axes.up) - view.part.y * view.part.w);
  return 0.5 * glm::dvec2(view.width, view.height) * (1.0 + at);
}

}  // namespace

bool IsSmallDisk(const glm::dvec3& towards, double radius_rad, const PaintedView& view) {
  constexpr double kLeast_pixels = 2.5;
  const double along = glm::dot(towards, AxesOf(view).forward);
  return radius_rad < kLeast_pixels * PixelAngle(view) * along;
}

SmallDiskPainter::SmallDiskPainter()
    : program_(FullScreenProgram(WithViewerPieces(
          SharedTexts(),
          {"viewer/shaders/view/block.glsl", "viewer/shaders/picture/small_disk.frag.glsl"}))),
      light_(kSide, kSide),
      outline_(kSide, kSide) {
  program_.BindBlock("View", kViewBinding);
  program_.BindSampler("disk_light", kUploadUnit);
  light_.UseDepthOf(outline_);
}

PaintedView SmallDiskPainter::ViewOf(const glm::dvec3& towards, double radius_rad,
                                     const PaintedView& whole) {
  PaintedView view{whole.eye, whole.now, kSide, kSide};
  view.eye.heading_rad = std::atan2(towards.x, towards.y);
  view.eye.pitch_rad = std::asin(std::clamp(towards.z, -1.0, 1.0));
  view.eye.roll_rad = 0.0;
  view.eye.fov_rad = 2.0 * std::atan(kReach * std::tan(radius_rad));
  return view;
}

double SmallDiskPainter::SmallestRadius(const PaintedView& whole) {
  constexpr double kResolved_rad = 1e-4;
  return std::min(kResolved_rad, 0.5 * PixelAngle(whole));
}

// The map from one picture to the other is linear over the disk: its ends are off by a share of
// r tan(a), with the angle a from the middle of the view.
void SmallDiskPainter::AddTo(const PaintedView& whole, const PaintedView& alone) const {
  const ViewAxes axes = AxesOf(alone);
  const auto place = [&](double x, double y) {
    return PixelOf(axes.forward + x * axes.right + y * axes.up, whole);
  };
  constexpr double kStep = 2.0 / kSide, kFirst = 0.5 * kStep - 1.0;
  const glm::dvec2 middle = place(0.0, 0.0);
  const glm::dvec2 right = 0.5 * (place(kStep, 0.0) - place(-kStep, 0.0));
  const glm::dvec2 up = 0.5 * (place(0.0, kStep) - place(0.0, -kStep));
  const glm::dvec2 first = middle + kFirst / kStep * (right + up);
  const glm::dvec2 width = glm::max(glm::ceil(glm::abs(right) + glm::abs(up)), 1.0);
  const double shares = PixelAngle(alone) / PixelAngle(whole);
  program_.Use();
  light_.BindTexture(kUploadUnit);
  const glm::vec4 places(first, width), steps(right, up);
  glUniform4fv(program_.Uniform("disk_place"), 1, &places.x);
  glUniform4fv(program_.Uniform("disk_steps"), 1, &steps.x);
  glUniform1f(program_.Uniform("texel_per_pixel"), static_cast<float>(shares * shares));
  DrawFullScreen(program_, no_vertices_);
}

}  // namespace alpenglow::viewer
