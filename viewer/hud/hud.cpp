// SPDX-License-Identifier: MIT
#include "viewer/hud/hud.h"

// GLFW is included for its key numbers alone.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <utility>

#include "atmosphere/base/error.h"
#include "viewer/hud/imgui_backend.h"
#include "viewer/hud/instruments.h"

namespace alpenglow::viewer {
namespace {

constexpr std::pair<int, HudKey> kKeys[] = {{GLFW_KEY_TAB, HudKey::kTab},
                                            {GLFW_KEY_LEFT, HudKey::kLeft},
                                            {GLFW_KEY_RIGHT, HudKey::kRight},
                                            {GLFW_KEY_UP, HudKey::kUp},
                                            {GLFW_KEY_DOWN, HudKey::kDown},
                                            {GLFW_KEY_PAGE_UP, HudKey::kPageUp},
                                            {GLFW_KEY_PAGE_DOWN, HudKey::kPageDown},
                                            {GLFW_KEY_HOME, HudKey::kHome},
                                            {GLFW_KEY_END, HudKey::kEnd},
                                            {GLFW_KEY_INSERT, HudKey::kInsert},
                                            {GLFW_KEY_DELETE, HudKey::kDelete},
                                            {GLFW_KEY_BACKSPACE, HudKey::kBackspace},
                                            {GLFW_KEY_SPACE, HudKey::kSpace},
                                            {GLFW_KEY_ENTER, HudKey::kEnter},
                                            {GLFW_KEY_KP_ENTER, HudKey::kEnter},
                                            {GLFW_KEY_ESCAPE, HudKey::kEscape},
                                            {GLFW_KEY_A, HudKey::kA},
                                            {GLFW_KEY_C, HudKey::kC},
                                            {GLFW_KEY_V, HudKey::kV},
                                            {GLFW_KEY_X, HudKey::kX},
                                            {GLFW_KEY_Y, HudKey::kY},
                                            {GLFW_KEY_Z, HudKey::kZ}};

bool Has(const std::vector<int>& keys, int key) {
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

}  // namespace

void HudKeys::Note(int glfw_key, bool is_down) {
  std::erase(held_, glfw_key);
  if (!is_down) return;
  held_.push_back(glfw_key);
  if (!Has(pressed_, glfw_key)) pressed_.push_back(glfw_key);
}

HudInput HudKeys::Into(HudInput input) {
  const std::vector<int> pressed = std::exchange(pressed_, {});
  const auto is_down = [&](int key) { return Has(held_, key) || Has(pressed, key); };
  for (const auto& [glfw_key, key] : kKeys) {
    if (is_down(glfw_key)) input.keys.push_back(key);
  }
  input.shift = is_down(GLFW_KEY_LEFT_SHIFT) || is_down(GLFW_KEY_RIGHT_SHIFT);
  input.control = is_down(GLFW_KEY_LEFT_CONTROL) || is_down(GLFW_KEY_RIGHT_CONTROL);
  return input;
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
  bool laid_out = false;  // the last frame produced something to draw
};

Hud::Hud(const HudSettings& settings)
    : state_(std::make_unique<State>()),
      font_(settings.font ? settings.font : InstalledFont()),
      choice_(settings.theme) {
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

HudRequest Hud::Update(const HudModel& model, const HudChoices& choices, const DayStrip* strip,
                       const HudInput& input) {
  state_->context.MakeCurrent();
  state_->laid_out = visible_ && input.width > 0 && input.height > 0;
  if (!state_->laid_out) return {};
  const HudTheme theme = ThemeFor(choice_, model.exposure.ev100, theme_);
  if (theme != theme_) ApplyTheme(theme);
  TellInput(ImGui::GetIO(), input);
  ImGui::NewFrame();
  const Canvas canvas(*ImGui::GetBackgroundDrawList(), ColoursOf(theme_), scale_);
  const HudFrame frame{input.width, input.height, panels_.MenuHeight()};
  DrawInstruments(canvas, frame, model);
  HudRequest request = panels_.Draw({model, choices, strip, theme_, choice_, scale_, input.width,
                                     input.height, ClockHeight(canvas, frame, model)});
  if (request.theme) choice_ = *request.theme;
  ImGui::Render();
  return request;
}

void Hud::Paint(GLuint framebuffer) const {
  if (!state_->laid_out || !visible_) return;
  state_->context.MakeCurrent();
  state_->painter.Paint(*ImGui::GetDrawData(), framebuffer);
}

bool Hud::WantsMouse() const {
  state_->context.MakeCurrent();
  return state_->laid_out && ImGui::GetIO().WantCaptureMouse;
}

bool Hud::WantsKeyboard() const {
  state_->context.MakeCurrent();
  return state_->laid_out && ImGui::GetIO().WantTextInput;
}

}  // namespace alpenglow::viewer
