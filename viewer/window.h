// SPDX-License-Identifier: MIT
// The window: an OpenGL core context on the screen, and what keys and mouse say.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "viewer/flight/flight.h"
#include "viewer/flythrough.h"

namespace alpenglow {

/// Keys: W A S D and R F move along, across and up; arrows turn; a drag with the left button looks;
/// t T change the rate of time, x X the field of view; F3 writes a screenshot, h hides the title's
/// numbers, Esc quits.
class Window {
 public:
  /// Throws DisplayError when there is no display or its OpenGL is older than 3.3.
  Window(int width, int height, bool fullscreen);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// What has happened since the last call.
  struct Events {
    Steering steering;                       // controls held now
    double drag_right = 0.0, drag_up = 0.0;  // of the mouse, in widths of the window
    std::vector<Command> commands;
    bool close = false;
  };
  /// Waits for the next event while the window is minimised.
  [[nodiscard]] Events Poll();

  [[nodiscard]] int width() const;  // of the picture [pixels]; 0 while minimised
  [[nodiscard]] int height() const;
  void SetTitle(const std::string& title);
  /// Shows what was drawn.
  void Swap();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace alpenglow
