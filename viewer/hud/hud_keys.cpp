// SPDX-License-Identifier: MIT
#include "viewer/hud/hud_keys.h"

// Only its numbers of keys.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <utility>

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

}  // namespace alpenglow::viewer
