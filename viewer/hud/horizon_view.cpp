// SPDX-License-Identifier: MIT
#include "viewer/hud/horizon_view.h"

#include <glm/geometric.hpp>

#include "atmosphere/sun/sun.h"

namespace alpenglow::viewer {
namespace {

Camera CameraOf(const HudFlight& flight) {
  Camera camera;
  camera.heading_rad = flight.heading_rad;
  camera.pitch_rad = flight.pitch_rad;
  camera.roll_rad = flight.roll_rad;
  camera.fov_rad = flight.fov_rad;
  return camera;
}

}  // namespace

HorizonView::HorizonView(const HudFlight& flight, int width, int height)
    : rays_(CameraOf(flight), width, height), middle_(0.5 * width, 0.5 * height) {}

std::optional<glm::dvec2> HorizonView::PixelOf(const HudDirection& direction) const {
  const auto place =
      rays_.PlaceOf(DirectionFromAngles(direction.climb_rad, direction.heading_rad).xyz);
  if (!place) return std::nullopt;
  constexpr double kFurthest = 8.0;  // half widths
  const glm::dvec2 pixel((*place)[0], (*place)[1]);
  if (glm::distance(pixel, middle_) > kFurthest * middle_.x) return std::nullopt;
  return pixel;
}

}  // namespace alpenglow::viewer
