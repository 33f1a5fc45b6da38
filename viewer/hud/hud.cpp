// SPDX-License-Identifier: MIT
#include "viewer/hud/hud.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "atmosphere/base/error.h"
#include "viewer/hud/imgui_backend.h"
#include "viewer/hud/instruments.h"

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

namespace {

/// Owns a Dear ImGui context, which persists from frame to frame.
class Context {
 public:
  Context() : context_(ImGui::CreateContext()) {
    ImGui::SetCurrentContext(context_);
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;  // write no settings file
    io.LogFilename = nullptr;
    io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
    io.ConfigWindowsMoveFromTitleBarOnly = true;
  }
  ~Context() { ImGui::DestroyContext(context_); }
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  /// Makes this context current: Dear ImGui works on one context at a time.
  void MakeCurrent() const { ImGui::SetCurrentContext(context_); }

 private:
  ImGuiContext* context_;
};

}  // namespace

struct Hud::State {
  Context context;
  DrawListPainter painter;
  PanelKeys keys;
  bool laid_out = false;  // the last frame produced something to draw
};

Hud::Hud(const HudSettings& settings)
    : state_(std::make_unique<State>()),
      font_(settings.font ? settings.font : InstalledFont()),
      preferences_(settings.preferences) {
  SetScale(settings.scale);
}

Hud::~Hud() = default;

void Hud::SetScale(double scale) {
  constexpr double kLeast = 0.5, kMost = 8.0;
  if (!(scale >= kLeast && scale <= kMost)) {
    throw InputError(
        fmt::format("the instruments' scale is {}; it must lie in [{}, {}]", scale, kLeast, kMost));
  }
  state_->context.MakeCurrent();
  scale_ = scale;
  LoadFont(*ImGui::GetIO().Fonts, scale, font_);
  state_->painter.UploadAtlas(*ImGui::GetIO().Fonts);
  ApplyTheme(theme_);
}

void Hud::ApplyTheme(HudTheme theme) {
  theme_ = theme;
  ApplyStyle(theme, scale_);
}

void Hud::Update(const HudModel& model, const DayStrip* strip, const InputFrame& input,
                 FlightCommands& flight) {
  state_->context.MakeCurrent();
  state_->keys.Take(input.events);
  const auto& [width, height] = input.size;
  state_->laid_out = visible_ && width > 0 && height > 0;
  if (!state_->laid_out) return;
  const HudTheme theme = ThemeFor(preferences_.theme, model.exposure.ev100, theme_);
  if (theme != theme_) ApplyTheme(theme);
  FeedInput(ImGui::GetIO(), input, state_->keys);
  ImGui::NewFrame();
  const Canvas canvas(*ImGui::GetBackgroundDrawList(), ColoursOf(theme_), scale_);
  const HudFrame frame{width, height, panels_.MenuHeight()};
  DrawInstruments(canvas, frame, model);
  panels_.Draw({model, strip, theme_, scale_, width, height, ClockHeight(canvas, frame, model)},
               preferences_, flight);
  ImGui::Render();
}

void Hud::Paint(GLuint framebuffer) const {
  if (!state_->laid_out || !visible_) return;
  state_->context.MakeCurrent();
  state_->painter.Paint(*ImGui::GetDrawData(), framebuffer);
}

TakenByPanels Hud::Taken() const {
  state_->context.MakeCurrent();
  if (!state_->laid_out) return {};
  return {ImGui::GetIO().WantCaptureMouse, ImGui::GetIO().WantTextInput};
}

}  // namespace alpenglow::viewer
