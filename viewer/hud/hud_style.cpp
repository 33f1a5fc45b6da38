// SPDX-License-Identifier: MIT
#include "viewer/hud/hud_style.h"

#include <imgui.h>

namespace alpenglow::viewer {
namespace {

ImVec4 Vec4(const HudColour& colour) { return {colour[0], colour[1], colour[2], colour[3]}; }

ImVec4 Dimmed(const HudColour& colour, float opacity) {
  return {colour[0], colour[1], colour[2], colour[3] * opacity};
}

void ApplyColours(ImGuiStyle& style, const HudColours& colours) {
  const ImVec4 panel = Vec4(colours.panel), control = Vec4(colours.control);
  const ImVec4 active = Vec4(colours.active), quiet = Vec4(colours.quiet);
  for (const int part : {ImGuiCol_WindowBg, ImGuiCol_PopupBg, ImGuiCol_MenuBarBg, ImGuiCol_TitleBg,
                         ImGuiCol_TitleBgCollapsed}) {
    style.Colors[part] = panel;
  }
  // Frames stay as they are under the mouse: the grab of a slider differs from them.
  for (const int part :
       {ImGuiCol_FrameBg, ImGuiCol_FrameBgHovered, ImGuiCol_FrameBgActive, ImGuiCol_Button,
        ImGuiCol_Header, ImGuiCol_TitleBgActive, ImGuiCol_ScrollbarGrab, ImGuiCol_TableHeaderBg}) {
    style.Colors[part] = control;
  }
  for (const int part :
       {ImGuiCol_SliderGrab, ImGuiCol_SliderGrabActive, ImGuiCol_TextSelectedBg,
        ImGuiCol_ButtonHovered, ImGuiCol_ButtonActive, ImGuiCol_HeaderHovered,
        ImGuiCol_HeaderActive, ImGuiCol_ScrollbarGrabHovered, ImGuiCol_ScrollbarGrabActive,
        ImGuiCol_ResizeGripHovered, ImGuiCol_ResizeGripActive, ImGuiCol_SeparatorHovered,
        ImGuiCol_SeparatorActive}) {
    style.Colors[part] = active;
  }
  for (const int part : {ImGuiCol_ScrollbarBg, ImGuiCol_TableRowBg, ImGuiCol_TableRowBgAlt}) {
    style.Colors[part] = Dimmed(colours.control, 0.4F);
  }
  style.Colors[ImGuiCol_CheckMark] = Vec4(colours.accent);
  style.Colors[ImGuiCol_Text] = Vec4(colours.text);
  style.Colors[ImGuiCol_TextDisabled] = quiet;
  for (const int part : {ImGuiCol_Border, ImGuiCol_Separator, ImGuiCol_ResizeGrip,
                         ImGuiCol_TableBorderLight, ImGuiCol_TableBorderStrong}) {
    style.Colors[part] = Dimmed(colours.quiet, 0.3F);
  }
}

}  // namespace

void ApplyStyle(HudTheme theme, double scale) {
  ImGuiStyle style;
  style.WindowRounding = 4.0F;
  style.FrameRounding = 3.0F;
  style.GrabRounding = 3.0F;
  style.FramePadding = {6.0F, 3.0F};
  style.ScaleAllSizes(static_cast<float>(scale));
  ApplyColours(style, ColoursOf(theme));
  ImGui::GetStyle() = style;
}

}  // namespace alpenglow::viewer
