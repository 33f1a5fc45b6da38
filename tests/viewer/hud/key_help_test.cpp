// SPDX-License-Identifier: MIT
#include "viewer/hud/panels.h"

#include <gtest/gtest.h>
#include <imgui.h>

#include <string>

namespace alpenglow::viewer {
namespace {

/// All that the panel writes, whether it fits into the picture or not.
std::string WrittenHelp(int width) {
  std::string written;
  ImGuiContext* const before = ImGui::GetCurrentContext();
  ImGuiContext* const context = ImGui::CreateContext();
  ImGui::SetCurrentContext(context);
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.DisplaySize = {static_cast<float>(width), 4000.0F};
  io.Fonts->Build();
  io.ClipboardUserData = &written;
  io.SetClipboardTextFn = [](void* to, const char* text) { *static_cast<std::string*>(to) = text; };
  const HudModel model;
  for (int frame = 0; frame < 3; ++frame) {
    ImGui::NewFrame();
    ImGui::Begin("Help", nullptr, ImGuiWindowFlags_AlwaysAutoResize);
    ImGui::LogToClipboard();
    ShowKeyHelp({model, nullptr, HudTheme::kDay, 1.0, width, 4000, 0});
    ImGui::LogFinish();
    ImGui::End();
    ImGui::EndFrame();
  }
  ImGui::DestroyContext(context);
  ImGui::SetCurrentContext(before);
  return written;
}

std::size_t CountOf(const std::string& part, const std::string& text) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++count;
  return count;
}

TEST(KeyHelp, EveryActionIsWrittenUnderItsHeading) {
  for (const int width : {320, 1280}) {
    const std::string written = WrittenHelp(width);
    for (const ActionSection& section : ActionSections()) {
      const std::size_t heading = written.find(section.heading);
      ASSERT_NE(heading, std::string::npos) << section.heading;
      for (const Action& row : section.rows) {
        EXPECT_GE(CountOf(std::string(row.help), written), 1U) << row.help << ", " << width;
        EXPECT_NE(written.find(row.help, heading), std::string::npos) << row.help;
        EXPECT_GE(CountOf(KeysText(row), written), 1U) << KeysText(row);
      }
    }
  }
}

TEST(KeyHelp, ColumnsKeepTheOrderAndAreAboutEven) {
  const std::vector<ActionSection> sections = ActionSections();
  for (const std::size_t most : {1U, 2U, 3U, 40U}) {
    const HelpColumns columns = InColumns(sections, most);
    EXPECT_LE(columns.size(), most);
    std::vector<std::string_view> headings;
    std::size_t longest = 0, all = 0;
    for (const auto& column : columns) {
      std::size_t lines = 0;
      for (const ActionSection& section : column) {
        headings.push_back(section.heading);
        lines += section.rows.size() + 2;
      }
      longest = std::max(longest, lines);
      all += lines;
    }
    ASSERT_EQ(headings.size(), sections.size());
    for (std::size_t i = 0; i < sections.size(); ++i) EXPECT_EQ(headings[i], sections[i].heading);
    if (most > 3) continue;
    EXPECT_LE(longest, all / most + 6) << "a section is not cut, and most have 6 lines or more";
  }
}

}  // namespace
}  // namespace alpenglow::viewer
