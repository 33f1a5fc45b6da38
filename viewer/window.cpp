// SPDX-License-Identifier: MIT
#include "viewer/window.h"

// libepoxy declares the functions of OpenGL; GLFW must not declare them again.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <utility>

#include "atmosphere/base/error.h"
#include "lut/cli/messages.h"
#include "viewer/gl/gl_context.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {
namespace {

// Colours of the icon: x to the right and y upwards, both in [0, 1]; sRGB.
glm::dvec3 Sky(double y) {
  constexpr glm::dvec3 kZenith{28.0, 44.0, 96.0}, kGlow{255.0, 164.0, 112.0};
  return glm::mix(kGlow, kZenith, std::clamp(1.4 * (y - 0.25), 0.0, 1.0));
}

double Ridge(double x) {
  const double peak = 0.82 - 1.25 * std::abs(x - 0.45);
  const double shoulder = 0.5 - 0.9 * std::abs(x - 0.86);
  return std::max({peak, shoulder, 0.12});
}

glm::dvec3 Rock(double x, double y) {
  constexpr glm::dvec3 kShade{52.0, 40.0, 74.0}, kLit{236.0, 112.0, 122.0};
  const bool faces_sun = x > 0.45 + 0.1 * (0.82 - y) && (x < 0.66 || x > 0.86);
  return faces_sun && y > 0.25 + 0.4 * (x - 0.45) ? kLit : kShade;
}

constexpr double kWait_s = 0.1;  // wait for events while the window is not visible

std::string LastGlfwError() {
  const char* text = nullptr;
  const int code = glfwGetError(&text);
  return code == GLFW_NO_ERROR || text == nullptr ? "GLFW gives no reason" : text;
}

/// Initialises GLFW during its lifetime.
struct Glfw {
  Glfw() {
    if (glfwInit() != GLFW_TRUE) {
      throw DisplayError(fmt::format("no display: {}; --headless needs none", LastGlfwError()));
    }
  }
  ~Glfw() { glfwTerminate(); }
  Glfw(const Glfw&) = delete;
  Glfw& operator=(const Glfw&) = delete;
};

// A driver that cannot report resets of the GPU may reject the request for such reports.
GLFWwindow* NewestWindow(int width, int height, GLFWmonitor* monitor) {
  for (const GlVersion& version : kGlVersions) {
    for (const int robustness : {GLFW_LOSE_CONTEXT_ON_RESET, GLFW_NO_ROBUSTNESS}) {
      glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, version.major);
      glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, version.minor);
      glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
      glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
      glfwWindowHint(GLFW_CONTEXT_ROBUSTNESS, robustness);
      GLFWwindow* window = glfwCreateWindow(width, height, "skyview", monitor, nullptr);
      if (window != nullptr) return window;
    }
  }
  throw DisplayError(
      fmt::format("the display gives no OpenGL 3.3 core context: {}", LastGlfwError()));
}

void SetIcon(GLFWwindow* window) {
  std::vector<std::vector<std::uint8_t>> pixels;
  std::vector<GLFWimage> images;
  for (const int side : {16, 32, 48, 128}) {
    pixels.push_back(WindowIcon(side));
    images.push_back({side, side, pixels.back().data()});
  }
  glfwSetWindowIcon(window, static_cast<int>(images.size()), images.data());
}

struct Size {
  int width = 0, height = 0;
};

/// A rectangle of the desktop, in desktop units.
struct Rectangle {
  int x = 0, y = 0, width = 0, height = 0;
  [[nodiscard]] bool Holds(int right, int down) const {
    return right >= x && right < x + width && down >= y && down < y + height;
  }
};

Rectangle PlaceOf(GLFWwindow* window) {
  Rectangle place;
  glfwGetWindowPos(window, &place.x, &place.y);
  glfwGetWindowSize(window, &place.width, &place.height);
  return place;
}

Rectangle PlaceOf(GLFWmonitor* monitor) {
  Rectangle place;
  glfwGetMonitorPos(monitor, &place.x, &place.y);
  const GLFWvidmode* mode = glfwGetVideoMode(monitor);
  if (mode != nullptr) place.width = mode->width, place.height = mode->height;
  return place;
}

/// Returns the monitor that contains the centre of the window, otherwise the first monitor; null if
/// there is none.
GLFWmonitor* MonitorUnder(GLFWwindow* window) {
  const Rectangle place = PlaceOf(window);
  int count = 0;
  GLFWmonitor** monitors = glfwGetMonitors(&count);
  for (int i = 0; i < count; ++i) {
    if (PlaceOf(monitors[i]).Holds(place.x + place.width / 2, place.y + place.height / 2)) {
      return monitors[i];
    }
  }
  return glfwGetPrimaryMonitor();
}

std::optional<GamepadState> FirstGamepad() {
  for (int id = GLFW_JOYSTICK_1; id <= GLFW_JOYSTICK_LAST; ++id) {
    GLFWgamepadstate state = {};
    if (glfwGetGamepadState(id, &state) != GLFW_TRUE) continue;
    GamepadState reading;
    const char* name = glfwGetGamepadName(id);
    reading.name = name == nullptr ? "" : name;
    std::copy(std::begin(state.buttons), std::end(state.buttons), reading.buttons.begin());
    std::copy(std::begin(state.axes), std::end(state.axes), reading.axes.begin());
    return reading;
  }
  return std::nullopt;
}

void AppendUtf8(std::string& text, unsigned codepoint) {
  const auto put = [&](unsigned byte) { text += static_cast<char>(byte); };
  if (codepoint < 0x80) return put(codepoint);
  const int more = codepoint < 0x800 ? 1 : codepoint < 0x10000 ? 2 : 3;
  constexpr unsigned kFirst[] = {0, 0xC0, 0xE0, 0xF0};
  put(kFirst[more] | codepoint >> (6 * more));
  for (int i = more - 1; i >= 0; --i) put(0x80 | (codepoint >> (6 * i) & 0x3F));
}

}  // namespace

std::vector<std::uint8_t> WindowIcon(int side) {
  constexpr int kSamples = 4;  // samples per side of a pixel
  std::vector<std::uint8_t> bytes;
  const double step = 1.0 / (kSamples * side);
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      glm::dvec3 sum(0.0);
      for (int sample = 0; sample < kSamples * kSamples; ++sample) {
        const double x = (kSamples * column + sample % kSamples + 0.5) * step;
        const double y = 1.0 - (kSamples * row + sample / kSamples + 0.5) * step;
        sum += y > Ridge(x) ? Sky(y) : Rock(x, y);
      }
      for (int channel = 0; channel < 3; ++channel) {
        bytes.push_back(static_cast<std::uint8_t>(sum[channel] / (kSamples * kSamples)));
      }
      bytes.push_back(255);
    }
  }
  return bytes;
}

struct Window::State {
  Glfw glfw;
  GLFWwindow* window = nullptr;
  WindowEvents events;             // since the last Poll, except for the members below
  std::array<bool, 3> held{};      // state of the buttons
  Size picture, desktop;           // size of the window in pixels and in desktop units
  PointerPlace pointer;            // in desktop units
  bool pointer_is_inside = false;  // the pointer is over the window and not captured
  bool captured = false;
  bool vsync = true;
  std::optional<Rectangle> before_fullscreen;
  std::function<void()> at_lost_display;

  State() { Existing() = this; }
  ~State() {
    Existing() = nullptr;
    if (window != nullptr) glfwDestroyWindow(window);
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  // Returns the existing window, for the handler that ends the program.
  static State*& Existing() {
    static State* existing = nullptr;
    return existing;
  }
  static State& Of(GLFWwindow* window) {
    return *static_cast<State*>(glfwGetWindowUserPointer(window));
  }

  static void OnKey(GLFWwindow* window, int key, int scancode, int action, int modifiers) {
    const char* printed = glfwGetKeyName(key, scancode);
    Of(window).events.keys.push_back(
        {key, scancode, action, modifiers, printed == nullptr ? "" : printed});
  }
  static void OnCharacter(GLFWwindow* window, unsigned codepoint) {
    AppendUtf8(Of(window).events.text, codepoint);
  }
  static void OnButton(GLFWwindow* window, int button, int action, int) {
    State& state = Of(window);
    if (button < 0 || button >= static_cast<int>(state.held.size())) return;
    const auto index = static_cast<std::size_t>(button);
    state.held[index] = action == GLFW_PRESS;
    state.events.buttons[index] = state.events.buttons[index] || state.held[index];
  }
  static void OnWheel(GLFWwindow* window, double, double steps) {
    Of(window).events.wheel += steps;
  }
  static void OnPointer(GLFWwindow* window, double right, double down) {
    Of(window).pointer = {right, down};
    Of(window).pointer_is_inside = true;
  }
  static void OnEnter(GLFWwindow* window, int entered) {
    Of(window).pointer_is_inside = entered == GLFW_TRUE;
  }
  static void OnFocus(GLFWwindow* window, int focused) {
    Of(window).events.focused = focused == GLFW_TRUE;
  }
  static void OnPictureSize(GLFWwindow* window, int width, int height) {
    Of(window).picture = {width, height};
  }
  static void OnWindowSize(GLFWwindow* window, int width, int height) {
    Of(window).desktop = {width, height};
  }
  static void OnMinimise(GLFWwindow* window, int minimised) {
    Of(window).events.minimised = minimised == GLFW_TRUE;
  }

  void Listen() {
    glfwSetWindowUserPointer(window, this);
    glfwSetKeyCallback(window, OnKey);
    glfwSetCharCallback(window, OnCharacter);
    glfwSetMouseButtonCallback(window, OnButton);
    glfwSetScrollCallback(window, OnWheel);
    glfwSetCursorPosCallback(window, OnPointer);
    glfwSetCursorEnterCallback(window, OnEnter);
    glfwSetWindowFocusCallback(window, OnFocus);
    glfwSetWindowIconifyCallback(window, OnMinimise);
    glfwSetFramebufferSizeCallback(window, OnPictureSize);
    glfwSetWindowSizeCallback(window, OnWindowSize);
    AskSizes();
  }

  [[nodiscard]] bool HasPicture() const { return picture.width > 0 && picture.height > 0; }

  // Reads the sizes once; callbacks keep them up to date. Each query would wait for a reply of the
  // display.
  void AskSizes() {
    glfwGetFramebufferSize(window, &picture.width, &picture.height);
    glfwGetWindowSize(window, &desktop.width, &desktop.height);
  }

  // Returns the position of the pointer in pixels. GLFW reports it in desktop units, which may be
  // larger than pixels.
  [[nodiscard]] std::optional<PointerPlace> Pointer() const {
    const bool is_held = held[0] || held[1] || held[2];
    if (!pointer_is_inside && !captured && !is_held) return std::nullopt;
    if (desktop.width == 0 || desktop.height == 0) return std::nullopt;
    return PointerPlace{pointer.right * picture.width / desktop.width,
                        pointer.down * picture.height / desktop.height};
  }

  // Resizes the window where desktop units are larger than pixels, because the picture is then
  // larger than requested.
  void FitPicture(int width, int height) const {
    if (!HasPicture() || (picture.width == width && picture.height == height)) return;
    const auto fitted = [](int units, int pixels, int wanted) {
      return std::max(1, static_cast<int>(std::lround(1.0 * units * wanted / pixels)));
    };
    glfwSetWindowSize(window, fitted(desktop.width, picture.width, width),
                      fitted(desktop.height, picture.height, height));
  }

  // Xlib ends the program when the display is lost. This exit handler is the only place that can
  // act before the end.
  static void AtExit() {
    constexpr int kLostDisplay = 5;
    if (Existing() == nullptr) return;
    Log("skyview: the display has gone\n");
    const std::function<void()> last = std::move(Existing()->at_lost_display);
    try {
      if (last) last();
    } catch (const std::exception& error) {
      Log(fmt::format("skyview: {}\n", error.what()));
    }
    _exit(kLostDisplay);
  }
};

Window::Window(const WindowSettings& settings) : state_(std::make_unique<State>()) {
  static const int registered = std::atexit(State::AtExit);
  static_cast<void>(registered);
  GLFWmonitor* monitor = settings.fullscreen ? glfwGetPrimaryMonitor() : nullptr;
  const GLFWvidmode* mode = monitor == nullptr ? nullptr : glfwGetVideoMode(monitor);
  const bool fills = mode != nullptr;
  state_->window = NewestWindow(fills ? mode->width : settings.width,
                                fills ? mode->height : settings.height, fills ? monitor : nullptr);
  state_->Listen();
  SetIcon(state_->window);
  if (!fills) state_->FitPicture(settings.width, settings.height);
  glfwMakeContextCurrent(state_->window);
  SetVsync(settings.vsync);
}

Window::~Window() = default;

WindowEvents Window::Poll() {
  if (state_->events.minimised || !state_->HasPicture()) {
    glfwWaitEventsTimeout(kWait_s);
  } else {
    glfwPollEvents();
  }
  WindowEvents events = state_->events;
  state_->events.keys.clear();
  state_->events.text.clear();
  state_->events.buttons = state_->held;
  state_->events.wheel = 0.0;
  events.pointer = state_->Pointer();
  events.gamepad = FirstGamepad();
  events.minimised = events.minimised || !state_->HasPicture();
  events.close = glfwWindowShouldClose(state_->window) == GLFW_TRUE;
  glfwSetWindowShouldClose(state_->window, GLFW_FALSE);  // each request to close is reported once
  return events;
}

int Window::width() const { return state_->picture.width; }
int Window::height() const { return state_->picture.height; }

double Window::content_scale() const {
  float right = 1.0F, down = 1.0F;
  glfwGetWindowContentScale(state_->window, &right, &down);
  return right > 0.0F ? static_cast<double>(right) : 1.0;
}

bool Window::fullscreen() const { return glfwGetWindowMonitor(state_->window) != nullptr; }

void Window::SetFullscreen(bool fullscreen) {
  if (fullscreen == this->fullscreen()) return;
  if (fullscreen) {
    GLFWmonitor* monitor = MonitorUnder(state_->window);
    const GLFWvidmode* mode = monitor == nullptr ? nullptr : glfwGetVideoMode(monitor);
    if (mode == nullptr) return;
    state_->before_fullscreen = PlaceOf(state_->window);
    glfwSetWindowMonitor(state_->window, monitor, 0, 0, mode->width, mode->height,
                         mode->refreshRate);
  } else {
    const Rectangle place = state_->before_fullscreen.value_or(Rectangle{60, 60, 1280, 720});
    glfwSetWindowMonitor(state_->window, nullptr, place.x, place.y, place.width, place.height,
                         GLFW_DONT_CARE);
  }
  SetVsync(state_->vsync);  // some drivers reset it
}

void Window::SetVsync(bool vsync) {
  state_->vsync = vsync;
  glfwSwapInterval(vsync ? 1 : 0);
}

void Window::CapturePointer(bool captured) {
  state_->captured = captured;
  glfwSetInputMode(state_->window, GLFW_CURSOR,
                   captured ? GLFW_CURSOR_DISABLED : GLFW_CURSOR_NORMAL);
}

void Window::Swap() {
  // Exit handlers run in reverse order. This second registration makes the handler run before the
  // process-wide objects of the first picture are destroyed, while worker threads may still use
  // them.
  static const int registered = std::atexit(State::AtExit);
  static_cast<void>(registered);
  glfwSwapBuffers(state_->window);
  RequireContext();
}

void Window::AtLostDisplay(std::function<void()> last) {
  state_->at_lost_display = std::move(last);
}

}  // namespace alpenglow::viewer
