// SPDX-License-Identifier: MIT
#include "viewer/hud/hud.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

namespace alpenglow::viewer {
namespace {

using Keys = std::vector<HudKey>;

TEST(HudKeys, AKeyPressedAndLetGoBetweenTwoFramesIsSeenOnce) {
  HudKeys keys;
  keys.Note(GLFW_KEY_BACKSPACE, true);
  keys.Note(GLFW_KEY_BACKSPACE, false);
  EXPECT_EQ(keys.Into({}).keys, Keys{HudKey::kBackspace});
  EXPECT_EQ(keys.Into({}).keys, Keys{});
}

TEST(HudKeys, AHeldKeyStaysDownUntilItIsLetGo) {
  HudKeys keys;
  keys.Note(GLFW_KEY_LEFT, true);
  EXPECT_EQ(keys.Into({}).keys, Keys{HudKey::kLeft});
  EXPECT_EQ(keys.Into({}).keys, Keys{HudKey::kLeft});
  keys.Note(GLFW_KEY_LEFT, true);  // repeats
  EXPECT_EQ(keys.Into({}).keys, Keys{HudKey::kLeft});
  keys.Note(GLFW_KEY_LEFT, false);
  EXPECT_EQ(keys.Into({}).keys, Keys{});
}

TEST(HudKeys, EitherSideOfShiftAndControlCounts) {
  HudKeys keys;
  keys.Note(GLFW_KEY_RIGHT_CONTROL, true);
  keys.Note(GLFW_KEY_A, true);
  HudInput input;
  input.width = 640;
  const HudInput told = keys.Into(input);
  EXPECT_TRUE(told.control);
  EXPECT_FALSE(told.shift);
  EXPECT_EQ(told.keys, Keys{HudKey::kA});
  EXPECT_EQ(told.width, 640) << "the rest of the input is kept";
  keys.Release();
  EXPECT_FALSE(keys.Into({}).control) << "the window went out of focus";
}

TEST(HudKeys, KeysThatPanelsDoNotKnowAreTheFlights) {
  HudKeys keys;
  keys.Note(GLFW_KEY_F3, true);
  keys.Note(GLFW_KEY_UNKNOWN, true);
  EXPECT_EQ(keys.Into({}).keys, Keys{});
}

}  // namespace
}  // namespace alpenglow::viewer
