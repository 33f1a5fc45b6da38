// SPDX-License-Identifier: MIT
// Provides the window of skyview: an OpenGL core context on the screen, its icon, and the events of
// keyboard, mouse and gamepad between two frames.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "viewer/input/window_events.h"

namespace alpenglow::viewer {

/// Returns the icon of the window, a peak at sunset: side x side pixels with red, green, blue and
/// alpha of one byte each; row 0 is the top. side >= 1.
[[nodiscard]] std::vector<std::uint8_t> WindowIcon(int side);

/// Initial state of a window.
struct WindowSettings {
  int width = 1280, height = 720;  // of the picture [pixels], if the desktop allows it
  bool fullscreen = false;
  bool vsync = true;  // Swap waits for the display
};

/// The window. Only one can exist at a time.
class Window {
 public:
  /// Creates the window and makes its context current on this thread. Throws DisplayError if there
  /// is no display or its OpenGL is older than 3.3.
  explicit Window(const WindowSettings& settings);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// Returns the events since the last call. While the window is not visible, it waits at most a
  /// tenth of a second, so that a minimised flight uses no processor time and still reacts to
  /// signals.
  [[nodiscard]] WindowEvents Poll();

  [[nodiscard]] int width() const;  // of the picture [pixels]; 0 while there is no picture
  [[nodiscard]] int height() const;
  /// Returns the number of pixels per unit of 1/96 inch, as set by the desktop.
  [[nodiscard]] double content_scale() const;

  [[nodiscard]] bool fullscreen() const;
  /// Switches to full screen on the monitor that contains the centre of the window, or back to the
  /// previous position.
  void SetFullscreen(bool fullscreen);
  void SetVsync(bool vsync);
  /// Hides the pointer and lets it move without limits, to look around.
  void CapturePointer(bool captured);

  /// Displays the drawn picture. Throws DisplayError if the GPU was reset (RequireContext).
  void Swap();

  /// Sets a function that is called before the program ends with status 5 because the display is
  /// lost (Xlib then ends the program). It should only close files. Its exceptions are written to
  /// standard error.
  void AtLostDisplay(std::function<void()> last);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace alpenglow::viewer
