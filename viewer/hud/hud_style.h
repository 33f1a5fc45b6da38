// SPDX-License-Identifier: MIT
// Colours and sizes of panels, for the Dear ImGui context that is current.
#pragma once

#include "viewer/hud/hud_theme.h"

namespace alpenglow::viewer {

/// @param scale  pixels a unit.
void ApplyStyle(HudTheme theme, double scale);

}  // namespace alpenglow::viewer
