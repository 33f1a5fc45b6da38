// SPDX-License-Identifier: MIT
// The places that have names, in a list that typing makes shorter.
#pragma once

#include <array>
#include <optional>
#include <string>

namespace alpenglow::viewer {

/// A field for a part of a name and the list of places that have it, by name and best first
/// (PlacesByName, places.h), into the window of Dear ImGui that is begun.
/// @return  the name of the place that was clicked on, or of the first one when Enter was pressed.
[[nodiscard]] std::optional<std::string> PlaceSearch(std::array<char, 64>& typed, double width_px);

}  // namespace alpenglow::viewer
