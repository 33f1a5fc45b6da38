// SPDX-License-Identifier: MIT
// Texts of the instruments: status in the four corners, and transient messages.
#pragma once

#include <string>
#include <vector>

#include "viewer/hud/hud_model.h"
#include "viewer/hud/instruments.h"

namespace alpenglow::viewer {

struct CornerTexts {
  std::vector<std::string> upper_left, upper_right, lower_left, lower_right;
};
/// Returns mode and autopilot; time, sun and moon; place; light and speed.
[[nodiscard]] CornerTexts CornerTextsOf(const HudModel& model);
/// Returns shorter texts for small pictures, of one or two lines each.
[[nodiscard]] CornerTexts ShortCornerTextsOf(const HudModel& model);

/// Returns the lower end of the upper right plate, which shows the clock [pixels from the upper edge].
[[nodiscard]] double BottomOfClock(const Canvas& canvas, const HudFrame& frame,
                                   const CornerTexts& texts);

void DrawCornerTexts(const Canvas& canvas, const HudFrame& frame, const CornerTexts& texts);

/// Draws messages, loading progress and warnings in the lower middle.
void DrawMessages(const Canvas& canvas, const HudFrame& frame, const HudModel& model);

}  // namespace alpenglow::viewer
