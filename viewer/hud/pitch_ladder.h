// SPDX-License-Identifier: MIT
// Where directions lie in the picture, so that instruments lie over what they speak of: by the
// camera of the renderer.
//
// Horizon, ladder of pitch, path of flight and bank: they lie over what the eye sees.
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

  /// Pixels from the upper left corner; nothing for what lies behind the eye or more than four
  /// widths of the picture away from its middle.
  [[nodiscard]] std::optional<glm::dvec2> PixelOf(const HudDirection& direction) const;
  /// Pixels per radian in the middle of the picture.
  [[nodiscard]] double PixelsPerRadian() const { return 1.0 / rays_.PixelAngle(); }

 private:
  CameraRays rays_;
  glm::dvec2 middle_;
};

/// The line of the horizontal plane, with gaps; rungs above and below it, dashed below; where the
/// edge of the sea is more than a few pixels below it, marks for that; and the direction of flight.
void DrawPitchLadder(const Canvas& canvas, const HudFrame& frame, const HudFlight& flight);

/// An arc with marks up to 60 degrees, and a pointer.
void DrawBankScale(const Canvas& canvas, const HudFrame& frame, const HudFlight& flight);

/// Degrees from rung to rung, so that they stand at least 80 units apart.
[[nodiscard]] double RungStep_deg(double units_per_degree);

}  // namespace alpenglow::viewer
