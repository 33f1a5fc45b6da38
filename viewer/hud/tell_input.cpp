// SPDX-License-Identifier: MIT
#include "viewer/hud/tell_input.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace alpenglow::viewer {
namespace {

constexpr std::pair<HudKey, int> kInputKeys[] = {{HudKey::kTab, ImGuiKey_Tab},
                                                 {HudKey::kLeft, ImGuiKey_LeftArrow},
                                                 {HudKey::kRight, ImGuiKey_RightArrow},
                                                 {HudKey::kUp, ImGuiKey_UpArrow},
                                                 {HudKey::kDown, ImGuiKey_DownArrow},
                                                 {HudKey::kPageUp, ImGuiKey_PageUp},
                                                 {HudKey::kPageDown, ImGuiKey_PageDown},
                                                 {HudKey::kHome, ImGuiKey_Home},
                                                 {HudKey::kEnd, ImGuiKey_End},
                                                 {HudKey::kInsert, ImGuiKey_Insert},
                                                 {HudKey::kDelete, ImGuiKey_Delete},
                                                 {HudKey::kBackspace, ImGuiKey_Backspace},
                                                 {HudKey::kSpace, ImGuiKey_Space},
                                                 {HudKey::kEnter, ImGuiKey_Enter},
                                                 {HudKey::kEscape, ImGuiKey_Escape},
                                                 {HudKey::kA, ImGuiKey_A},
                                                 {HudKey::kC, ImGuiKey_C},
                                                 {HudKey::kV, ImGuiKey_V},
                                                 {HudKey::kX, ImGuiKey_X},
                                                 {HudKey::kY, ImGuiKey_Y},
                                                 {HudKey::kZ, ImGuiKey_Z}};

#if IMGUI_VERSION_NUM >= 18700
void TellKey(ImGuiIO& io, int key, bool is_down) {
  io.AddKeyEvent(static_cast<ImGuiKey>(key), is_down);
}
void TellModifiers(ImGuiIO& io, const HudInput& input) {
#if IMGUI_VERSION_NUM >= 18900
  io.AddKeyEvent(ImGuiMod_Ctrl, input.control);
  io.AddKeyEvent(ImGuiMod_Shift, input.shift);
#else
  io.AddKeyEvent(ImGuiKey_ModCtrl, input.control);
  io.AddKeyEvent(ImGuiKey_ModShift, input.shift);
#endif
}
#else
// Keys have the numbers of their names.
void TellKey(ImGuiIO& io, int key, bool is_down) {
  io.KeyMap[key] = key;
  io.KeysDown[key] = is_down;
}
void TellModifiers(ImGuiIO& io, const HudInput& input) {
  io.KeyCtrl = input.control;
  io.KeyShift = input.shift;
}
#endif

void TellMouse(ImGuiIO& io, const HudInput& input) {
  constexpr float kNowhere = -std::numeric_limits<float>::max();
  io.MousePos = input.pointer ? ImVec2{static_cast<float>(input.pointer->x),
                                       static_cast<float>(input.pointer->y)}
                              : ImVec2{kNowhere, kNowhere};
  std::copy(input.buttons.begin(), input.buttons.end(), io.MouseDown);
  io.MouseWheel = static_cast<float>(input.wheel);
}

}  // namespace

void TellInput(ImGuiIO& io, const HudInput& input) {
  constexpr float kShortest_s = 1e-4F;  // Dear ImGui wants time to pass
  io.DisplaySize = {static_cast<float>(input.width), static_cast<float>(input.height)};
  io.DeltaTime = std::max(static_cast<float>(input.seconds), kShortest_s);
  TellMouse(io, input);
  TellModifiers(io, input);
  for (const auto& [key, name] : kInputKeys) {
    TellKey(io, name, std::find(input.keys.begin(), input.keys.end(), key) != input.keys.end());
  }
  io.AddInputCharactersUTF8(input.text.c_str());
}

}  // namespace alpenglow::viewer
