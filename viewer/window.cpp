// SPDX-License-Identifier: MIT
#include "viewer/window.h"

// libepoxy has the functions of OpenGL; GLFW must not declare them again.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <utility>

#include "atmosphere/text/error.h"
#include "viewer/gl/gl_context.h"

namespace alpenglow {
namespace {

std::string LastGlfwError() {
  const char* text = nullptr;
  const int code = glfwGetError(&text);
  return code == GLFW_NO_ERROR || text == nullptr ? "GLFW gives no reason" : text;
}

/// The library, while it is used.
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

GLFWwindow* NewestWindow(int width, int height, GLFWmonitor* monitor) {
  for (const GlVersion& version : kGlVersions) {
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, version.major);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, version.minor);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    GLFWwindow* window = glfwCreateWindow(width, height, "skyview", monitor, nullptr);
    if (window != nullptr) return window;
  }
  throw DisplayError(
      fmt::format("the display gives no OpenGL 3.3 core context: {}", LastGlfwError()));
}

std::optional<Command> CommandOf(int key, bool shift) {
  switch (key) {
    case GLFW_KEY_T:
      return shift ? Command::kSlowerTime : Command::kFasterTime;
    case GLFW_KEY_X:
      return shift ? Command::kWiderView : Command::kNarrowerView;
    case GLFW_KEY_F3:
      return Command::kScreenshot;
    case GLFW_KEY_H:
      return Command::kHud;
    case GLFW_KEY_ESCAPE:
      return Command::kQuit;
    default:
      return std::nullopt;
  }
}

}  // namespace

struct Window::State {
  Glfw glfw;
  GLFWwindow* window = nullptr;
  Events events;
  double mouse_x = 0.0, mouse_y = 0.0;

  ~State() {
    if (window != nullptr) glfwDestroyWindow(window);
  }

  static State& Of(GLFWwindow* window) {
    return *static_cast<State*>(glfwGetWindowUserPointer(window));
  }
  static void OnKey(GLFWwindow* window, int key, int, int action, int modifiers) {
    if (action == GLFW_RELEASE) return;
    const auto command = CommandOf(key, (modifiers & GLFW_MOD_SHIFT) != 0);
    if (command) Of(window).events.commands.push_back(*command);
  }
  static void OnMouse(GLFWwindow* window, double x, double y) {
    State& state = Of(window);
    if (glfwGetMouseButton(window, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS) {
      int width = 1, height = 1;
      glfwGetWindowSize(window, &width, &height);
      state.events.drag_right += (x - state.mouse_x) / std::max(width, 1);
      state.events.drag_up -= (y - state.mouse_y) / std::max(width, 1);
    }
    state.mouse_x = x;
    state.mouse_y = y;
  }

  // -1, 0 or 1 from two keys that oppose each other.
  [[nodiscard]] double Axis(int positive, int negative) const {
    return (glfwGetKey(window, positive) == GLFW_PRESS ? 1.0 : 0.0) -
           (glfwGetKey(window, negative) == GLFW_PRESS ? 1.0 : 0.0);
  }
};

Window::Window(int width, int height, bool fullscreen) : state_(std::make_unique<State>()) {
  GLFWmonitor* monitor = fullscreen ? glfwGetPrimaryMonitor() : nullptr;
  if (monitor != nullptr) {
    const GLFWvidmode* mode = glfwGetVideoMode(monitor);
    width = mode->width;
    height = mode->height;
  }
  state_->window = NewestWindow(width, height, monitor);
  glfwSetWindowUserPointer(state_->window, state_.get());
  glfwSetKeyCallback(state_->window, State::OnKey);
  glfwSetCursorPosCallback(state_->window, State::OnMouse);
  glfwMakeContextCurrent(state_->window);
  glfwSwapInterval(1);
}

Window::~Window() = default;

Window::Events Window::Poll() {
  if (width() == 0 || height() == 0) {
    glfwWaitEvents();
  } else {
    glfwPollEvents();
  }
  Events events = std::exchange(state_->events, {});
  events.close = glfwWindowShouldClose(state_->window) == GLFW_TRUE;
  events.steering = {state_->Axis(GLFW_KEY_W, GLFW_KEY_S), state_->Axis(GLFW_KEY_D, GLFW_KEY_A),
                     state_->Axis(GLFW_KEY_R, GLFW_KEY_F),
                     state_->Axis(GLFW_KEY_RIGHT, GLFW_KEY_LEFT),
                     state_->Axis(GLFW_KEY_UP, GLFW_KEY_DOWN)};
  return events;
}

int Window::width() const {
  int width = 0, height = 0;
  glfwGetFramebufferSize(state_->window, &width, &height);
  return width;
}

int Window::height() const {
  int width = 0, height = 0;
  glfwGetFramebufferSize(state_->window, &width, &height);
  return height;
}

void Window::SetTitle(const std::string& title) {
  glfwSetWindowTitle(state_->window, title.c_str());
}

void Window::Swap() { glfwSwapBuffers(state_->window); }

}  // namespace alpenglow
