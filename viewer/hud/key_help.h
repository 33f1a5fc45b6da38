// SPDX-License-Identifier: MIT
// The help panel with the keys: each action once, under the heading of its mode.
#pragma once

#include <cstddef>
#include <vector>

#include "viewer/hud/panel_contents.h"
#include "viewer/input/action.h"

namespace alpenglow::viewer {

/// Draws the keys into the current Dear ImGui window, in as many columns as fit side by side.
void ShowKeyHelp(const PanelView& view);

using HelpColumns = std::vector<std::vector<ActionSection>>;
/// Returns the sections in their order, in columns with the smallest possible maximum length.
/// @param most_columns  >= 1.
[[nodiscard]] HelpColumns InColumns(const std::vector<ActionSection>& sections,
                                    std::size_t most_columns);

}  // namespace alpenglow::viewer
