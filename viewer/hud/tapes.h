// SPDX-License-Identifier: MIT
// Scales that run past a mark: heading, speed, height.
#pragma once

#include "viewer/hud/hud_model.h"
#include "viewer/hud/instruments.h"

namespace alpenglow::viewer {

/// Heading over the middle of the upper edge, 60 degrees of it, with a bug where it is held, a disk
/// where the sun stands and a ring where the moon does.
void DrawHeadingTape(const Canvas& canvas, const HudFrame& frame, const HudModel& model);
/// The same as a number.
void DrawHeadingNumber(const Canvas& canvas, const HudFrame& frame, const HudModel& model);

/// Speed on the left, height over the sea on the right, with climb and height over ground below.
void DrawSpeedTape(const Canvas& canvas, const HudFrame& frame, const HudModel& model);
void DrawHeightTape(const Canvas& canvas, const HudFrame& frame, const HudModel& model);
/// The same as numbers.
void DrawSpeedAndHeightNumbers(const Canvas& canvas, const HudFrame& frame, const HudModel& model);

/// Distance of the marks of a scale around `value`: 1, 2 or 5 times a power of ten, at least `least`.
[[nodiscard]] double MarkStep(double value, double least);

}  // namespace alpenglow::viewer
