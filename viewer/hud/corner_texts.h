// SPDX-License-Identifier: MIT
// What is told in words and numbers at the corners, and what is said once.
#pragma once

#include <string>
#include <vector>

#include "viewer/hud/hud_model.h"
#include "viewer/hud/instruments.h"

namespace alpenglow::viewer {

struct CornerTexts {
  std::vector<std::string> upper_left, upper_right, lower_left, lower_right;
};
/// Mode and autopilot; time, sun and moon; place; light and speed.
[[nodiscard]] CornerTexts CornerTextsOf(const HudModel& model);
/// The same for small pictures: a line or two each.
[[nodiscard]] CornerTexts ShortCornerTextsOf(const HudModel& model);

/// Where the plate of the upper right corner ends, the clock's [pixels from the upper edge].
[[nodiscard]] double BottomOfClock(const Canvas& canvas, const HudFrame& frame,
                                   const CornerTexts& texts);

void DrawCornerTexts(const Canvas& canvas, const HudFrame& frame, const CornerTexts& texts);

/// Messages, progress of loading and warnings, in the lower middle.
void DrawMessages(const Canvas& canvas, const HudFrame& frame, const HudModel& model);

}  // namespace alpenglow::viewer
