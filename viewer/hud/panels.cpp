// SPDX-License-Identifier: MIT
#include "viewer/hud/panels.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <utility>

#include "viewer/hud/key_help.h"

namespace alpenglow::viewer {
namespace {

/// Placement of a new panel: the point at the fraction (x, y) of the panel lies at the same
/// fraction of the free area.
struct Placement {
  HudPanel panel;
  const char* name;
  float x, y;
};
constexpr std::array<Placement, kHudPanels> kPlacements{
    {{HudPanel::kPlaceAndTime, "Place and time", 0.0F, 0.0F},
     {HudPanel::kAir, "Air", 1.0F, 0.0F},
     {HudPanel::kWeather, "Weather", 1.0F, 0.25F},
     {HudPanel::kLights, "Lights", 1.0F, 0.50F},
     {HudPanel::kExposure, "Exposure", 1.0F, 1.0F},
     {HudPanel::kFlight, "Flight", 0.50F, 1.0F},
     {HudPanel::kTables, "Tables", 0.0F, 1.0F},
     {HudPanel::kCapture, "Capture", 0.50F, 0.0F},
     {HudPanel::kHelp, "Help", 0.50F, 0.50F},
     {HudPanel::kLeave, "Leave", 0.50F, 0.50F}}};

/// The part of the picture that panels may cover [pixels]: below the clock. If large letters would
/// leave less than a quarter of the picture, panels also cover the clock.
struct FreeArea {
  ImVec2 from, size;

  explicit FreeArea(const PanelView& view) {
    const auto margin = static_cast<float>(kPanelMargin * view.scale);
    const auto width = static_cast<float>(view.width), height = static_cast<float>(view.height);
    from = {margin, std::min(static_cast<float>(view.top) + margin, 0.75F * height - margin)};
    size = {width - from.x - margin, height - from.y - margin};
  }
};

// Moves the current window back into the area, unless the user is dragging it.
void KeepInside(const FreeArea& area) {
  if (ImGui::IsMouseDown(ImGuiMouseButton_Left)) return;
  const ImVec2 at = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
  const auto kept = [](float begin, float length, float from, float room) {
    return std::max(std::min(begin, from + room - length), from);
  };
  const ImVec2 inside{kept(at.x, size.x, area.from.x, area.size.x),
                      kept(at.y, size.y, area.from.y, area.size.y)};
  if (inside.x != at.x || inside.y != at.y) ImGui::SetWindowPos(inside);
}

/// A Dear ImGui window, begun in the constructor and ended in the destructor.
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

// Returns whether the user confirms. Enter also confirms, unless text is typed.
bool ConfirmLeaving() {
  ImGui::TextUnformatted("Leave the flight? Enter leaves, Esc stays.");
  const bool enters = ImGui::IsKeyPressed(ImGuiKey_Enter, false) && !ImGui::GetIO().WantTextInput;
  return ImGui::Button("leave") || enters;
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

void Panels::DrawContents(HudPanel panel, const PanelChange& change) {
  switch (panel) {
    case HudPanel::kPlaceAndTime:
      return DrawPlaceAndTime(change, typing_);
    case HudPanel::kAir:
      return DrawAir(change);
    case HudPanel::kWeather:
      return DrawWeather(change);
    case HudPanel::kLights:
      return DrawLights(change);
    case HudPanel::kExposure:
      return DrawExposure(change);
    case HudPanel::kFlight:
      return DrawFlight(change);
    case HudPanel::kTables:
      return DrawTables(change);
    case HudPanel::kCapture:
      return DrawCapture(change, typing_);
    case HudPanel::kHelp:
      return ShowKeyHelp(change.view);
    case HudPanel::kLeave:
      if (ConfirmLeaving()) change.flight.Leave();
  }
}

void Panels::DrawPanel(HudPanel panel, const PanelChange& change) {
  const Placement& placement = kPlacements[static_cast<std::size_t>(panel)];
  const FreeArea area(change.view);
  const ImVec2 share{placement.x, placement.y};
  ImGui::SetNextWindowPos(
      {area.from.x + share.x * area.size.x, area.from.y + share.y * area.size.y},
      resized_ ? ImGuiCond_Always : ImGuiCond_Appearing, share);
  ImGui::SetNextWindowSizeConstraints({0.0F, 0.0F}, area.size);
  const Shown window(placement.name, &Open(panel));
  // Before that Dear ImGui still measures the window and sets its initial position.
  constexpr int kMeasured = 3;
  int& frames = frames_[static_cast<std::size_t>(panel)];
  frames = ImGui::IsWindowAppearing() ? 0 : std::min(frames + 1, kMeasured);
  if (frames == kMeasured) KeepInside(area);
  if (window.visible()) DrawContents(panel, change);
}

void Panels::Draw(const PanelView& view, HudPreferences& preferences, FlightCommands& flight) {
  const std::array<int, 2> size{view.width, view.height};
  resized_ = std::exchange(picture_, size) != size;
  if (menu_) DrawMenu();
  for (const Placement& placement : kPlacements) {
    if (IsOpen(placement.panel)) DrawPanel(placement.panel, {view, preferences, flight});
  }
}

}  // namespace alpenglow::viewer
