// SPDX-License-Identifier: MIT
// Controls that panels are made of: each tells what was chosen in this frame, if anything.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "viewer/hud/day_strip.h"

namespace alpenglow::viewer {

struct SliderRange {
  double low, high;
  const char* format;  // as Dear ImGui wants it, "%.0f km"
  bool logarithmic = false;
};

[[nodiscard]] std::optional<double> Slider(const char* label, double value,
                                           const SliderRange& range);
/// One of some names.
[[nodiscard]] std::optional<std::string> NameList(const char* label, const std::string& current,
                                                  std::span<const std::string> names);
[[nodiscard]] std::optional<bool> CheckBox(const char* label, bool is_on);

/// Buttons in rows as wide as the panel: the one that was pressed.
[[nodiscard]] std::optional<std::size_t> ButtonRows(std::span<const std::string> names,
                                                    double row_width_px);

struct StripLook {
  double width_px, height_px;
  double brightness = 1.0;  // share of the colours' that is shown
};

/// The day's colours, its hours and the sun's way; the share of the day that is clicked on. With no
/// strip yet its place is kept free.
[[nodiscard]] std::optional<double> DayStripControl(const DayStrip* strip, double day_fraction,
                                                    const StripLook& look);

}  // namespace alpenglow::viewer
