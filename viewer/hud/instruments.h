// SPDX-License-Identifier: MIT
// All instruments of a flight over one picture: which there are, and where they stand.
#pragma once

#include "viewer/hud/canvas.h"
#include "viewer/hud/hud_model.h"

namespace alpenglow::viewer {

/// The picture [pixels].
struct HudFrame {
  int width = 0, height = 0;
  int top = 0;  // height of what lies over its upper edge, the menu

  [[nodiscard]] glm::dvec2 middle() const { return {0.5 * width, 0.5 * height}; }
};

/// Draws them. Pictures of less than 800 x 540 units get numbers instead of tapes.
void DrawInstruments(const Canvas& canvas, const HudFrame& frame, const HudModel& model);

/// Height of the part of the picture that the clock needs, the menu's included [pixels].
[[nodiscard]] int ClockHeight(const Canvas& canvas, const HudFrame& frame, const HudModel& model);

}  // namespace alpenglow::viewer
