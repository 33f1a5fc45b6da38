// SPDX-License-Identifier: MIT
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include "viewer/hud/imgui_backend.h"

namespace alpenglow::viewer {
namespace {

WindowEvents Keys(std::vector<KeyEvent> keys) {
  WindowEvents events;
  events.keys = std::move(keys);
  return events;
}

TEST(PanelKeys, AKeyPressedAndLetGoBetweenTwoFramesIsSeenOnce) {
  PanelKeys keys;
  keys.Take(Keys({{GLFW_KEY_BACKSPACE, 0, GLFW_PRESS}, {GLFW_KEY_BACKSPACE, 0, GLFW_RELEASE}}));
  EXPECT_TRUE(keys.IsDown(GLFW_KEY_BACKSPACE));
  keys.Take({});
  EXPECT_FALSE(keys.IsDown(GLFW_KEY_BACKSPACE));
}

TEST(PanelKeys, AHeldKeyStaysDownUntilItIsLetGo) {
  PanelKeys keys;
  keys.Take(Keys({{GLFW_KEY_LEFT, 0, GLFW_PRESS}}));
  EXPECT_TRUE(keys.IsDown(GLFW_KEY_LEFT));
  keys.Take({});
  EXPECT_TRUE(keys.IsDown(GLFW_KEY_LEFT));
  keys.Take(Keys({{GLFW_KEY_LEFT, 0, GLFW_REPEAT}}));
  EXPECT_TRUE(keys.IsDown(GLFW_KEY_LEFT));
  keys.Take(Keys({{GLFW_KEY_LEFT, 0, GLFW_RELEASE}}));
  EXPECT_FALSE(keys.IsDown(GLFW_KEY_LEFT));
}

TEST(PanelKeys, AWindowOutOfFocusReleasesAllKeys) {
  PanelKeys keys;
  keys.Take(Keys({{GLFW_KEY_RIGHT_CONTROL, 0, GLFW_PRESS}}));
  WindowEvents away;
  away.focused = false;
  keys.Take(away);
  EXPECT_FALSE(keys.IsDown(GLFW_KEY_RIGHT_CONTROL));
}

}  // namespace
}  // namespace alpenglow::viewer
