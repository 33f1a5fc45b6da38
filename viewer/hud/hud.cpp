// SPDX-License-Identifier: MIT
#include "viewer/hud/hud.h"

#include <fmt/format.h>
#include <imgui.h>

#include "atmosphere/base/error.h"
#include "viewer/hud/imgui_backend.h"
#include "viewer/hud/instruments.h"

namespace alpenglow::viewer {
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
