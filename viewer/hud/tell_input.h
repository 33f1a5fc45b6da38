// SPDX-License-Identifier: MIT
// Mouse and keyboard as Dear ImGui wants them told, in its versions before and since 1.87.
#pragma once

#include <imgui.h>

#include "viewer/hud/hud_input.h"

namespace alpenglow::viewer {

/// Before each NewFrame.
void TellInput(ImGuiIO& io, const HudInput& input);

}  // namespace alpenglow::viewer
