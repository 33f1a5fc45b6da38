// SPDX-License-Identifier: MIT
// What mouse and keyboard did since the last frame, as panels want it: no window is needed for it.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace alpenglow::viewer {

/// Keys that edit text or walk through panels.
enum class HudKey {
  kTab,
  kLeft,
  kRight,
  kUp,
  kDown,
  kPageUp,
  kPageDown,
  kHome,
  kEnd,
  kInsert,
  kDelete,
  kBackspace,
  kSpace,
  kEnter,
  kEscape,
  kA,
  kC,
  kV,
  kX,
  kY,
  kZ
};

struct HudPointer {
  double x = 0.0, y = 0.0;  // pixels of the picture from its upper left corner
};

struct HudInput {
  int width = 0, height = 0;               // of the picture [pixels]
  double seconds = 0.0;                    // since the last frame
  std::optional<HudPointer> pointer = {};  // none outside of the window
  std::array<bool, 3> buttons{};           // left, right, middle: held, or pressed and let go
  double wheel = 0.0;                      // steps, away from who turns it
  std::vector<HudKey> keys;                // held, or pressed and let go
  bool shift = false, control = false;
  std::string text;  // typed, UTF-8
};

}  // namespace alpenglow::viewer
