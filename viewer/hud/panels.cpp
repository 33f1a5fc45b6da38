// SPDX-License-Identifier: MIT
#include "viewer/hud/panels.h"

#include <imgui.h>

#include <algorithm>
#include <utility>

namespace alpenglow {
namespace {

/// Where a panel appears: this share of the free picture, the same share of the panel put there.
struct Placement {
  HudPanel panel;
  const char* name;
  float x, y;
};
constexpr std::array<Placement, kHudPanels> kPlacements{
    {{HudPanel::kPlaceAndTime, "Place and time", 0.0F, 0.06F},
     {HudPanel::kAir, "Air", 1.0F, 0.06F},
     {HudPanel::kLights, "Lights", 1.0F, 0.50F},
     {HudPanel::kExposure, "Exposure", 1.0F, 0.94F},
     {HudPanel::kFlight, "Flight", 0.0F, 0.94F},
     {HudPanel::kTables, "Tables", 0.50F, 0.94F},
     {HudPanel::kCapture, "Capture", 0.50F, 0.10F},
     {HudPanel::kHelp, "Help", 0.50F, 0.50F},
     {HudPanel::kLeave, "Leave", 0.50F, 0.50F}}};

/// A window of Dear ImGui: begun here, ended with it.
class Shown {
 public:
  Shown(const char* name, bool* open)
      : visible_(ImGui::Begin(name, open,
                              ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse |
                                  ImGuiWindowFlags_NoSavedSettings |
                                  ImGuiWindowFlags_HorizontalScrollbar)) {}
  ~Shown() { ImGui::End(); }
  Shown(const Shown&) = delete;
  Shown& operator=(const Shown&) = delete;

  [[nodiscard]] bool visible() const { return visible_; }

 private:
  bool visible_;
};

bool AskToLeave() {
  ImGui::TextUnformatted("Leave the flight?");
  return ImGui::Button("leave");
}

}  // namespace

bool Panels::CloseAll() {
  const bool any = std::any_of(open_.begin(), open_.end(), [](bool open) { return open; });
  open_.fill(false);
  return any;
}

int Panels::MenuHeight() const { return menu_ ? static_cast<int>(ImGui::GetFrameHeight()) : 0; }

void Panels::DrawMenu() {
  if (!ImGui::BeginMainMenuBar()) return;
  for (const Placement& placement : kPlacements)
    ImGui::MenuItem(placement.name, nullptr, &Open(placement.panel));
  ImGui::EndMainMenuBar();
}

HudRequest Panels::Contents(HudPanel panel, const PanelView& view, HudRequest request) {
  switch (panel) {
    case HudPanel::kPlaceAndTime:
      return WithPlaceAndTime(view, typing_, std::move(request));
    case HudPanel::kAir:
      return WithAir(view, std::move(request));
    case HudPanel::kLights:
      return WithLights(view, std::move(request));
    case HudPanel::kExposure:
      return WithExposure(view, std::move(request));
    case HudPanel::kFlight:
      return WithFlight(view, std::move(request));
    case HudPanel::kTables:
      return WithTables(view, std::move(request));
    case HudPanel::kCapture:
      return WithCapture(view, typing_, std::move(request));
    case HudPanel::kHelp:
      ShowHelp(view);
      return request;
    case HudPanel::kLeave:
      request.quit = AskToLeave();
      return request;
  }
  return request;
}

HudRequest Panels::DrawPanel(HudPanel panel, const PanelView& view, HudRequest request) {
  const Placement& placement = kPlacements[static_cast<std::size_t>(panel)];
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const auto menu = static_cast<float>(MenuHeight());
  const ImVec2 share{placement.x, placement.y};
  const auto margin = static_cast<float>(kPanelMargin * view.scale);
  const ImVec2 free{size.x - 2.0F * margin, size.y - menu - 2.0F * margin};
  ImGui::SetNextWindowPos({margin + share.x * free.x, menu + margin + share.y * free.y},
                          resized_ ? ImGuiCond_Always : ImGuiCond_Appearing, share);
  ImGui::SetNextWindowSizeConstraints({0.0F, 0.0F}, free);
  const Shown window(placement.name, &Open(panel));
  return window.visible() ? Contents(panel, view, std::move(request)) : request;
}

HudRequest Panels::Draw(const PanelView& view) {
  const std::array<int, 2> size{view.width, view.height};
  resized_ = std::exchange(picture_, size) != size;
  if (menu_) DrawMenu();
  HudRequest request;
  for (const Placement& placement : kPlacements) {
    if (IsOpen(placement.panel)) request = DrawPanel(placement.panel, view, std::move(request));
  }
  return request;
}

}  // namespace alpenglow
