// SPDX-License-Identifier: MIT
// Scales of the instruments: tapes of heading, speed and height that scroll past a fixed mark, and
// horizon, pitch ladder, flight path marker and bank scale, aligned with the picture by the camera
// of the renderer.
#pragma once

#include <glm/vec2.hpp>
#include <optional>

#include "renderer/camera/camera_rays.h"
#include "viewer/hud/hud_model.h"
#include "viewer/hud/instruments.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// Draws 60 degrees of heading at the middle of the upper edge, with a bug at the held heading, a
/// disk at the sun and a ring at the moon.
void DrawHeadingTape(const Canvas& canvas, const HudFrame& frame, const HudModel& model);
/// Draws the heading as a number.
void DrawHeadingNumber(const Canvas& canvas, const HudFrame& frame, const HudModel& model);

/// Draw speed on the left, and height above sea level on the right, with climb and height above
/// ground below it.
void DrawSpeedTape(const Canvas& canvas, const HudFrame& frame, const HudModel& model);
void DrawHeightTape(const Canvas& canvas, const HudFrame& frame, const HudModel& model);
/// Draws speed and height as numbers.
void DrawSpeedAndHeightNumbers(const Canvas& canvas, const HudFrame& frame, const HudModel& model);

/// Returns the distance of the marks of a scale around `value`: 1, 2 or 5 times a power of ten, at
/// least `least`.
[[nodiscard]] double MarkStep(double value, double least);

class HorizonView {
 public:
  /// @param width, height  of the picture [pixels], >= 1.
  HorizonView(const HudFlight& flight, int width, int height);

  /// Returns pixels from the upper left corner; no value for directions behind the eye or more than
  /// four picture widths from the middle.
  [[nodiscard]] std::optional<glm::dvec2> PixelOf(const Course& direction) const;
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
