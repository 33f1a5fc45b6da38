// SPDX-License-Identifier: MIT
#include "viewer/hud/place_search.h"

#include <fmt/format.h>
#include <imgui.h>

#include "viewer/flight/places.h"

namespace alpenglow::viewer {
namespace {

// "Zürich Airport (LSZH, Kloten)": what it can be found by.
std::string LabelOf(const NamedPlace& place) {
  const std::string both = place.code.empty() || place.also.empty() ? "" : ", ";
  const std::string others = place.code + both + place.also;
  return others.empty() ? place.name : fmt::format("{} ({})", place.name, others);
}

}  // namespace

std::optional<std::string> PlaceSearch(std::array<char, 64>& typed, double width_px) {
  constexpr float kLines = 6.5F;  // a half one shows that there are more
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
