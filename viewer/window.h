// SPDX-License-Identifier: MIT
// The window: an OpenGL core context on the screen, and what keyboard, mouse and gamepad do.
#pragma once

#include <functional>
#include <memory>

#include "viewer/window_events.h"

namespace alpenglow::viewer {

/// Where a window begins.
struct WindowSettings {
  int width = 1280, height = 720;  // of the picture [pixels], where the desktop lets it
  bool fullscreen = false;
  bool vsync = true;  // Swap waits for the display
};

/// One at a time.
class Window {
 public:
  /// Its context is current on this thread from here on. Throws DisplayError when there is no
  /// display or its OpenGL is older than 3.3.
  explicit Window(const WindowSettings& settings);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// What has happened since the last call. While nothing of the window is seen, waits for a tenth
  /// of a second at most, so that a minimised flight costs nothing and signals are heard.
  [[nodiscard]] WindowEvents Poll();

  [[nodiscard]] int width() const;  // of the picture [pixels]; 0 while it has none
  [[nodiscard]] int height() const;
  /// Pixels for a unit of 1/96 inch, as the desktop has it.
  [[nodiscard]] double content_scale() const;

  [[nodiscard]] bool fullscreen() const;
  /// On the screen that the window's middle is on; back to where the window was.
  void SetFullscreen(bool fullscreen);
  void SetVsync(bool vsync);
  /// Hides the pointer and lets it move without end, to look around.
  void CapturePointer(bool captured);

  /// Shows what was drawn. Throws DisplayError when the graphics card was reset (RequireContext).
  void Swap();

  /// What is done before the program ends with status 5 because the display itself has gone (Xlib
  /// ends programs then): no more than to close files. Exceptions are said.
  void AtLostDisplay(std::function<void()> last);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace alpenglow::viewer
