// SPDX-License-Identifier: MIT
// Controls of the panels: each returns the user's choice in this frame, if any.
//
// DayStripControl shows a DayStrip; a click on it chooses the time. PlaceSearch lists the named
// places and filters them while typing.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>

#include "viewer/hud/day_strip.h"

namespace alpenglow::viewer {

struct SliderRange {
  double low, high;
  const char* format;  // in Dear ImGui's notation, "%.0f km"
  bool logarithmic = false;
};

[[nodiscard]] std::optional<double> Slider(const char* label, double value,
                                           const SliderRange& range);
/// Draws a list and returns the chosen name.
[[nodiscard]] std::optional<std::string> NameList(const char* label, const std::string& current,
                                                  std::span<const std::string> names);
[[nodiscard]] std::optional<bool> CheckBox(const char* label, bool is_on);

/// Draws buttons in rows of the panel's width and returns the index of the pressed one.
[[nodiscard]] std::optional<std::size_t> ButtonRows(std::span<const std::string> names,
                                                    double row_width_px);

struct StripLook {
  double width_px, height_px;
  double brightness = 1.0;  // factor on the displayed colours
};

/// Draws the colours of the day, its hours and the path of the sun; returns the clicked fraction of
/// the day. Without a strip its space stays empty.
[[nodiscard]] std::optional<double> DayStripControl(const DayStrip* strip, double day_fraction,
                                                    const StripLook& look);

/// Draws a field for a part of a name and the list of matching places, the best match first and
/// equal matches by name (PlacesByName, places.h), into the current Dear ImGui window.
/// @return  the name of the clicked place, or of the first one when Enter was pressed.
[[nodiscard]] std::optional<std::string> PlaceSearch(std::array<char, 64>& typed, double width_px);

}  // namespace alpenglow::viewer
