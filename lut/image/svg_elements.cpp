// SPDX-License-Identifier: MIT
#include "lut/image/svg_elements.h"

#include <fmt/format.h>

#include <array>
#include <string_view>

namespace alpenglow::lut {

std::string XmlText(const std::string& text) {
  constexpr std::string_view kReserved = "&<>\"'";
  constexpr std::array<const char*, 5> kEntities{"&amp;", "&lt;", "&gt;", "&quot;", "&#39;"};
  std::string result;
  for (const char c : text) {
    const std::size_t at = kReserved.find(c);
    result += at == std::string_view::npos ? std::string(1, c) : kEntities[at];
  }
  return result;
}

std::string SvgText(const SvgPoint& at, const std::string& attributes, const std::string& text) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" {}>{}</text>\n", at.x, at.y, attributes,
                     XmlText(text));
}

std::string SvgLine(const SvgPoint& from, const SvgPoint& to, const std::string& attributes) {
  return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n", from.x,
                     from.y, to.x, to.y, attributes);
}

std::string SvgPolyline(const std::vector<SvgPoint>& points, const std::string& attributes) {
  std::string text = fmt::format("<polyline {} points=\"", attributes);
  for (const SvgPoint& point : points) text += fmt::format("{:.1f},{:.1f} ", point.x, point.y);
  return text + "\"/>\n";
}

}  // namespace alpenglow::lut
