// SPDX-License-Identifier: MIT
// Tapes that scroll past a fixed mark: heading, speed, height.
#pragma once

#include "viewer/hud/hud_model.h"
#include "viewer/hud/instruments.h"

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

}  // namespace alpenglow::viewer
