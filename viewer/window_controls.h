// SPDX-License-Identifier: MIT
// What happened to a window, told to the controls.
#pragma once

#include "viewer/input/controls.h"
#include "viewer/window_events.h"

namespace alpenglow::viewer {

/// What the panels under the pointer, or the text that is being typed, keep for themselves.
struct TakenByPanels {
  bool mouse = false, keyboard = false;
};

/// @param width, height  of the picture [pixels]
inline void Tell(const WindowEvents& events, int width, int height, const TakenByPanels& taken,
                 Controls& controls) {
  controls.Minimise(events.minimised);
  controls.Focus(events.focused || events.minimised);
  for (const KeyEvent& key : events.keys) {
    // What goes up is heard in any case.
    if (taken.keyboard && key.change != 0) continue;
    controls.Key(key.key, key.change, key.modifiers, PrintedKey(key.key, key.printed.c_str()));
  }
  controls.IgnoreMouse(taken.mouse);
  controls.MouseButton(events.buttons[0]);
  if (events.pointer && width > 0 && height > 0) {
    controls.MouseAt(events.pointer->right / width, events.pointer->down / height,
                     static_cast<double>(width) / height);
  }
  controls.Wheel(events.wheel);
}

[[nodiscard]] inline std::optional<GamepadState> GamepadOf(const WindowEvents& events) {
  if (!events.gamepad) return std::nullopt;
  return GamepadState{events.gamepad->buttons, events.gamepad->axes};
}

}  // namespace alpenglow::viewer
