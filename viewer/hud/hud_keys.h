// SPDX-License-Identifier: MIT
// Keys of a window, as GLFW numbers them, gathered for panels.
#pragma once

#include <vector>

#include "viewer/hud/hud_input.h"

namespace alpenglow::viewer {

/// Which of the keys that panels know are held, or were pressed and let go since the last frame.
class HudKeys {
 public:
  /// @param glfw_key  GLFW_KEY_...; others than panels know are passed over.
  /// @param is_down   false when it was let go; repeats count as down.
  void Note(int glfw_key, bool is_down);
  /// All keys are up: the window no longer hears the keyboard.
  void Release() { held_.clear(); }

  /// Once a frame: the input with its keys, shift and control filled in.
  [[nodiscard]] HudInput Into(HudInput input);

 private:
  std::vector<int> held_;     // of GLFW
  std::vector<int> pressed_;  // since the last frame
};

}  // namespace alpenglow::viewer
