// SPDX-License-Identifier: MIT
// This header writes the elements of SVG plots.
//
// Coordinates are pixels of the plot and are written with one decimal. Attributes are written as
// they are given, for example `class="tick"`.
#pragma once

#include <string>
#include <vector>

namespace alpenglow::lut {

struct SvgPoint {
  double x = 0.0, y = 0.0;
};

/// Returns `text` with the five characters that XML reserves written as entities.
[[nodiscard]] std::string XmlText(const std::string& text);

/// Returns a <text> element. @param text  plain text, whose reserved characters are replaced.
[[nodiscard]] std::string SvgText(const SvgPoint& at, const std::string& attributes,
                                  const std::string& text);

/// Returns a <line> element.
[[nodiscard]] std::string SvgLine(const SvgPoint& from, const SvgPoint& to,
                                  const std::string& attributes);

/// Returns a <polyline> element.
[[nodiscard]] std::string SvgPolyline(const std::vector<SvgPoint>& points,
                                      const std::string& attributes);

}  // namespace alpenglow::lut
