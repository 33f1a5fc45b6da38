// SPDX-License-Identifier: MIT
#include "viewer/hud/key_help.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace alpenglow::viewer {
namespace {

constexpr double kColumnWidth = 400.0;  // units
constexpr float kKeysShare = 0.40F;     // fraction of a column

ImVec4 Accent(HudTheme theme) {
  const HudColour& colour = ColoursOf(theme).accent;
  return {colour[0], colour[1], colour[2], colour[3]};
}

void ShowSection(const ActionSection& section, float width, HudTheme theme) {
  ImGui::PushStyleColor(ImGuiCol_Text, Accent(theme));
  ImGui::TextUnformatted(section.heading.data(), section.heading.data() + section.heading.size());
  ImGui::PopStyleColor();
  if (!ImGui::BeginTable(std::string(section.heading).c_str(), 2, ImGuiTableFlags_RowBg,
                         {width, 0.0F}))
    return;
  ImGui::TableSetupColumn("keys", ImGuiTableColumnFlags_WidthFixed, kKeysShare * width);
  ImGui::TableSetupColumn("what they do", ImGuiTableColumnFlags_WidthStretch);
  for (const Action& action : section.rows) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextWrapped("%s", KeysText(action).c_str());
    ImGui::TableNextColumn();
    ImGui::TextWrapped("%s", std::string(action.help).c_str());
  }
  ImGui::EndTable();
  ImGui::Spacing();
}

// Counts heading and space below as two lines.
std::size_t LinesOf(const ActionSection& section) { return section.rows.size() + 2; }

// Fills columns of at most `most_lines` lines; only a longer section exceeds this.
HelpColumns Filled(const std::vector<ActionSection>& sections, std::size_t most_lines) {
  HelpColumns columns;
  std::size_t lines = 0;
  for (const ActionSection& section : sections) {
    lines += LinesOf(section);
    if (columns.empty() || lines > most_lines) {
      columns.emplace_back();
      lines = LinesOf(section);
    }
    columns.back().push_back(section);
  }
  return columns;
}

}  // namespace

HelpColumns InColumns(const std::vector<ActionSection>& sections, std::size_t most_columns) {
  for (std::size_t lines = 1;; ++lines) {
    HelpColumns columns = Filled(sections, lines);
    if (columns.size() <= most_columns) return columns;
  }
}

void ShowKeyHelp(const PanelView& view) {
  const ImGuiStyle& style = ImGui::GetStyle();
  const double sides = static_cast<double>(2.0F * style.WindowPadding.x + style.ScrollbarSize);
  const double room = view.width - 2.0 * kPanelMargin * view.scale - sides;
  const double column_px = kColumnWidth * view.scale + static_cast<double>(style.ItemSpacing.x);
  const double columns = std::clamp(std::floor(room / column_px), 1.0, 3.0);
  const double width = std::min(kColumnWidth * view.scale, std::max(room, 1.0));
  bool is_first = true;
  for (const std::vector<ActionSection>& column :
       InColumns(ActionSections(), static_cast<std::size_t>(columns))) {
    if (!std::exchange(is_first, false)) ImGui::SameLine();
    ImGui::BeginGroup();
    for (const ActionSection& section : column)
      ShowSection(section, static_cast<float>(width), view.theme);
    ImGui::EndGroup();
  }
}

}  // namespace alpenglow::viewer
