// SPDX-License-Identifier: MIT
// Horizon, pitch ladder, flight path marker and bank scale, aligned with the picture by the camera
// of the renderer.
#pragma once

#include <glm/vec2.hpp>
#include <optional>

#include "renderer/camera/camera_rays.h"
#include "viewer/hud/hud_model.h"
#include "viewer/hud/instruments.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

class HorizonView {
 public:
  /// @param width, height  of the picture [pixels], >= 1.
  HorizonView(const HudFlight& flight, int width, int height);

  /// Returns pixels from the upper left corner; no value for directions behind the eye or more than
  /// four picture widths from the middle.
  [[nodiscard]] std::optional<glm::dvec2> PixelOf(const HudDirection& direction) const;
  /// Returns the pixels per radian in the middle of the picture.
  [[nodiscard]] double PixelsPerRadian() const { return 1.0 / rays_.PixelAngle(); }

 private:
  CameraRays rays_;
  glm::dvec2 middle_;
};

/// Draws the line of the horizontal plane, with gaps; rungs above and below it, dashed below; marks
/// for the sea horizon where it is more than a few pixels below that line; and the direction of
/// flight.
void DrawPitchLadder(const Canvas& canvas, const HudFrame& frame, const HudFlight& flight);

/// Draws an arc with marks up to 60 degrees, and a pointer.
void DrawBankScale(const Canvas& canvas, const HudFrame& frame, const HudFlight& flight);

/// Returns the degrees between rungs, so that they are at least 80 units apart.
[[nodiscard]] double RungStep_deg(double units_per_degree);

}  // namespace alpenglow::viewer
