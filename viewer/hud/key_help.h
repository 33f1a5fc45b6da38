// SPDX-License-Identifier: MIT
// The keys, as the panel of help lists them: each action once, under the heading of its mode.
#pragma once

#include <cstddef>
#include <vector>

#include "viewer/hud/panel_contents.h"
#include "viewer/input/action.h"

namespace alpenglow::viewer {

/// Draws them into the window of Dear ImGui that is begun, in as many columns as fit side by side.
void ShowKeyHelp(const PanelView& view);

using HelpColumns = std::vector<std::vector<ActionSection>>;
/// The sections in their order in columns of which the longest is as short as it can be.
/// @param most_columns  >= 1.
[[nodiscard]] HelpColumns InColumns(const std::vector<ActionSection>& sections,
                                    std::size_t most_columns);

}  // namespace alpenglow::viewer
