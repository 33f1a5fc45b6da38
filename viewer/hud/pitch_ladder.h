// SPDX-License-Identifier: MIT
// Horizon, ladder of pitch, path of flight and bank: they lie over what the eye sees.
#pragma once

#include "viewer/hud/canvas.h"
#include "viewer/hud/hud_model.h"
#include "viewer/hud/instruments.h"

namespace alpenglow::viewer {

/// The line of the horizontal plane, with gaps; rungs above and below it, dashed below; where the
/// edge of the sea is more than a few pixels below it, marks for that; and the direction of flight.
void DrawPitchLadder(const Canvas& canvas, const HudFrame& frame, const HudFlight& flight);

/// An arc with marks up to 60 degrees, and a pointer.
void DrawBankScale(const Canvas& canvas, const HudFrame& frame, const HudFlight& flight);

/// Degrees from rung to rung, so that they stand at least 80 units apart.
[[nodiscard]] double RungStep_deg(double units_per_degree);

}  // namespace alpenglow::viewer
