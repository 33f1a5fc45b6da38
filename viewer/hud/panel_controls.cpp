// SPDX-License-Identifier: MIT
#include "viewer/hud/panel_controls.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "atmosphere/math/constants.h"
#include "renderer/scene/places.h"

namespace alpenglow::viewer {
namespace {

ImU32 Colour(const std::array<float, 3>& rgb, double brightness) {
  const auto share = static_cast<float>(brightness);
  return ImGui::ColorConvertFloat4ToU32({share * rgb[0], share * rgb[1], share * rgb[2], 1.0F});
}

/// Rectangle of the strip [pixels].
struct StripBox {
  ImVec2 from, size;

  [[nodiscard]] ImVec2 At(double x_share, double y_share) const {
    return {from.x + size.x * static_cast<float>(x_share),
            from.y + size.y * static_cast<float>(y_share)};
  }
};

// Draws the colours, interpolated between the centres of columns and rows.
void DrawColours(ImDrawList& list, const DayStrip& strip, const StripBox& box, double brightness) {
  const auto colour = [&](int column, int row) {
    return Colour(strip.at(column, row), brightness);
  };
  const auto x_of = [&](int column) { return (column + 0.5) / strip.columns; };
  for (int row = 0; row + 1 < strip.rows; ++row) {
    const double top = static_cast<double>(row) / (strip.rows - 1);
    const double bottom = (row + 1.0) / (strip.rows - 1);
    for (int column = -1; column < strip.columns; ++column) {
      const int left = std::max(column, 0), right = std::min(column + 1, strip.columns - 1);
      list.AddRectFilledMultiColor(
          box.At(std::max(x_of(column), 0.0), top), box.At(std::min(x_of(column + 1), 1.0), bottom),
          colour(left, row), colour(right, row), colour(right, row + 1), colour(left, row + 1));
    }
  }
}

void DrawHours(ImDrawList& list, const StripBox& box, ImU32 colour) {
  for (int hour = 0; hour <= 24; hour += 3) {
    const ImVec2 foot = box.At(hour / 24.0, 1.0);
    const float mark = box.size.y * (hour % 6 == 0 ? 0.18F : 0.10F);
    list.AddLine({foot.x, foot.y - mark}, foot, colour);
    const std::string text = fmt::format("{}", hour);
    const float half = 0.5F * ImGui::CalcTextSize(text.c_str()).x;
    // Large letters can be wider than a narrow strip.
    const float last = std::max(box.from.x + box.size.x - 2.0F * half, box.from.x);
    const float x = std::clamp(foot.x - half, box.from.x, last);
    list.AddText({x, foot.y}, ImGui::GetColorU32(ImGuiCol_Text), text.c_str());
  }
}

// Draws the path of the sun; noon at the zenith would touch the upper edge.
void DrawSunPath(ImDrawList& list, const DayStrip& strip, const StripBox& box, ImU32 colour) {
  const auto point = [&](int column) {
    const double elevation = strip.sun_elevation_rad[static_cast<std::size_t>(column)];
    return box.At((column + 0.5) / strip.columns, 0.5 - elevation / kPi);
  };
  for (int column = 0; column + 1 < strip.columns; ++column)
    list.AddLine(point(column), point(column + 1), colour, 1.5F);
  list.AddLine(box.At(0.0, 0.5), box.At(1.0, 0.5), (colour & 0xFFFFFFU) | 0x60000000U);
}

void DrawNow(ImDrawList& list, double day_fraction, const StripBox& box) {
  const ImVec2 from = box.At(day_fraction, 0.0), to = box.At(day_fraction, 1.0);
  list.AddLine(from, to, IM_COL32(0, 0, 0, 200), 4.0F);
  list.AddLine(from, to, ImGui::GetColorU32(ImGuiCol_CheckMark), 2.0F);
}

// Returns the time of day.
std::string ClockText(double day_fraction) {
  const auto minutes = std::lround(day_fraction * 24.0 * 60.0);
  return fmt::format("{:02d}:{:02d}", minutes / 60, minutes % 60);
}

// Returns the searchable names: "Zürich Airport (LSZH, Kloten)".
std::string LabelOf(const NamedPlace& place) {
  const std::string both = place.code.empty() || place.also.empty() ? "" : ", ";
  const std::string others = place.code + both + place.also;
  return others.empty() ? place.name : fmt::format("{} ({})", place.name, others);
}

}  // namespace

std::optional<double> Slider(const char* label, double value, const SliderRange& range) {
  const ImGuiSliderFlags flags =
      ImGuiSliderFlags_AlwaysClamp | (range.logarithmic ? ImGuiSliderFlags_Logarithmic : 0);
  const bool changed = ImGui::SliderScalar(label, ImGuiDataType_Double, &value, &range.low,
                                           &range.high, range.format, flags);
  return changed ? std::optional(value) : std::nullopt;
}

std::optional<std::string> NameList(const char* label, const std::string& current,
                                    std::span<const std::string> names) {
  if (!ImGui::BeginCombo(label, current.c_str())) return std::nullopt;
  std::optional<std::string> chosen;
  for (const std::string& name : names) {
    if (ImGui::Selectable(name.c_str(), name == current)) chosen = name;
  }
  ImGui::EndCombo();
  return chosen;
}

std::optional<bool> CheckBox(const char* label, bool is_on) {
  return ImGui::Checkbox(label, &is_on) ? std::optional(is_on) : std::nullopt;
}

std::optional<std::size_t> ButtonRows(std::span<const std::string> names, double row_width_px) {
  std::optional<std::size_t> pressed;
  const ImGuiStyle& style = ImGui::GetStyle();
  double used = 0.0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double width = static_cast<double>(ImGui::CalcTextSize(names[i].c_str()).x +
                                             2.0F * style.FramePadding.x + style.ItemSpacing.x);
    if (i > 0 && used + width <= row_width_px) ImGui::SameLine();
    used = i > 0 && used + width <= row_width_px ? used + width : width;
    if (ImGui::Button(names[i].c_str())) pressed = i;
  }
  return pressed;
}

std::optional<double> DayStripControl(const DayStrip* strip, double day_fraction,
                                      const StripLook& look) {
  const StripBox box{ImGui::GetCursorScreenPos(),
                     {static_cast<float>(look.width_px), static_cast<float>(look.height_px)}};
  ImGui::InvisibleButton("day", box.size);
  const bool is_held = ImGui::IsItemActive(), is_hovered = ImGui::IsItemHovered();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImU32 line = (ImGui::GetColorU32(ImGuiCol_Text) & 0xFFFFFFU) | 0xAA000000U;
  if (strip == nullptr) {
    list.AddRectFilled(box.from, box.At(1.0, 1.0), ImGui::GetColorU32(ImGuiCol_FrameBg));
  } else {
    DrawColours(list, *strip, box, look.brightness);
    DrawSunPath(list, *strip, box, line);
  }
  DrawHours(list, box, line);
  DrawNow(list, std::clamp(day_fraction, 0.0, 1.0), box);
  const double share = std::clamp(
      static_cast<double>(ImGui::GetIO().MousePos.x - box.from.x) / look.width_px, 0.0, 1.0);
  if (is_held || is_hovered) ImGui::SetTooltip("%s", ClockText(share).c_str());
  ImGui::Dummy({box.size.x, ImGui::GetTextLineHeight()});
  return is_held ? std::optional(share) : std::nullopt;
}

std::optional<std::string> PlaceSearch(std::array<char, 64>& typed, double width_px) {
  constexpr float kLines = 6.5F;  // a half line shows that the list continues
  const auto width = static_cast<float>(width_px);
  ImGui::SetNextItemWidth(width);
  const bool entered =
      ImGui::InputTextWithHint("##search", "name of a place, Enter: fly there", typed.data(),
                               typed.size(), ImGuiInputTextFlags_EnterReturnsTrue);
  const std::vector<const NamedPlace*> places = PlacesByName(typed.data());
  std::optional<std::string> chosen;
  if (entered && !places.empty()) chosen = places.front()->name;
  const float height = kLines * ImGui::GetTextLineHeightWithSpacing();
  if (!ImGui::BeginListBox("##places", {width, height})) return chosen;
  if (places.empty()) ImGui::TextUnformatted("There is no such place in the list.");
  for (const NamedPlace* place : places) {
    if (ImGui::Selectable(LabelOf(*place).c_str())) chosen = place->name;
  }
  ImGui::EndListBox();
  return chosen;
}

}  // namespace alpenglow::viewer
