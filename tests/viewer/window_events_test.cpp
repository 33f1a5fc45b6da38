// SPDX-License-Identifier: MIT
// What a window hears, on a display that follows a script (tests/fixtures/scripted_display.cpp).
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "atmosphere/base/error.h"
#include "viewer/layer.h"
#include "viewer/window.h"

namespace alpenglow::viewer {
namespace {

class WindowInput : public ::testing::Test {
 protected:
  /// Opens a window on a display that does this.
  void Open(const std::string& script) {
    setenv("ALPENGLOW_DISPLAY", script.c_str(), 1);
    try {
      window_ = std::make_unique<Window>(WindowSettings{64, 36});
    } catch (const DisplayError& error) {
      GTEST_SKIP() << error.what();
    }
  }
  [[nodiscard]] WindowEvents Next() { return window_->Poll(); }

  std::unique_ptr<Window> window_;
};

TEST_F(WindowInput, KeysArriveInOrderWithModifiersAndLetters) {
  Open("hold:87 key:292,1 text:228 text:8364 text:128169 8x8 let:87 8x8");
  const WindowEvents first = Next();
  ASSERT_EQ(first.keys.size(), 3U);
  EXPECT_EQ(first.keys[0].key, GLFW_KEY_W);
  EXPECT_EQ(first.keys[0].change, GLFW_PRESS);
  EXPECT_EQ(first.keys[0].printed, "z") << "on a French keyboard";
  EXPECT_EQ(first.keys[1].key, GLFW_KEY_F3);
  EXPECT_EQ(first.keys[1].modifiers, GLFW_MOD_SHIFT);
  EXPECT_EQ(first.keys[1].printed, "");
  EXPECT_EQ(first.keys[2].change, GLFW_RELEASE);
  EXPECT_EQ(first.text, "\xC3\xA4\xE2\x82\xAC\xF0\x9F\x92\xA9");
  const WindowEvents second = Next();
  ASSERT_EQ(second.keys.size(), 1U) << "nothing comes twice";
  EXPECT_EQ(second.keys[0].change, GLFW_RELEASE);
  EXPECT_EQ(second.text, "");
}

TEST_F(WindowInput, AClickShorterThanAFrameLastsOneFrame) {
  Open("move:3,4 press:0 release:0 press:1 8x8 8x8 release:1 8x8 8x8");
  const WindowEvents first = Next();
  EXPECT_TRUE(first.buttons[0]);
  EXPECT_TRUE(first.buttons[1]);
  EXPECT_FALSE(first.buttons[2]);
  const WindowEvents second = Next();
  EXPECT_FALSE(second.buttons[0]);
  EXPECT_TRUE(second.buttons[1]) << "still held";
  EXPECT_TRUE(Next().buttons[1]) << "let go in this frame";
  EXPECT_FALSE(Next().buttons[1]);
}

TEST_F(WindowInput, PointerPositionsAreInPixelsOfThePicture) {
  Open("8x8 move:3,1 8x8 leave 8x8 press:0 8x8");
  EXPECT_FALSE(Next().pointer.has_value()) << "not in the window yet";
  const WindowEvents inside = Next();
  ASSERT_TRUE(inside.pointer.has_value());
  EXPECT_EQ(inside.pointer->right, 6.0) << "the desktop's units are two pixels";
  EXPECT_EQ(inside.pointer->down, 2.0);
  EXPECT_FALSE(Next().pointer.has_value()) << "it has left";
  EXPECT_TRUE(Next().pointer.has_value()) << "a button that is held keeps it";
  EXPECT_EQ(window_->content_scale(), 2.0);
}

TEST_F(WindowInput, StepsOfTheWheelAddUp) {
  Open("wheel:1 wheel:2 8x8 wheel:-1 8x8 8x8");
  EXPECT_EQ(Next().wheel, 3.0);
  EXPECT_EQ(Next().wheel, -1.0);
  EXPECT_EQ(Next().wheel, 0.0);
}

TEST_F(WindowInput, LossOfFocusIsReported) {
  Open("8x8 focus:0 8x8 focus:1 minimise:1 8x8 minimise:0 8x8 0x0");
  const WindowEvents open = Next();
  EXPECT_TRUE(open.focused && !open.minimised && !open.close);
  EXPECT_FALSE(Next().focused);
  const WindowEvents minimised = Next();
  EXPECT_TRUE(minimised.focused && minimised.minimised);
  EXPECT_FALSE(Next().minimised);
  EXPECT_TRUE(Next().minimised) << "nothing is seen of a window without a size";
  EXPECT_TRUE(Next().close);
}

TEST_F(WindowInput, TheFirstGamepadIsRead) {
  Open("8x8 pad:0.5,1 8x8");
  EXPECT_FALSE(Next().gamepad.has_value());
  const WindowEvents events = Next();
  ASSERT_TRUE(events.gamepad.has_value());
  EXPECT_EQ(events.gamepad->name, "scripted");
  EXPECT_EQ(events.gamepad->axes[0], 0.5F);
  EXPECT_EQ(events.gamepad->buttons[0], 1);
}

TEST_F(WindowInput, AResetOfTheGpuLosesTheDisplay) {
  Open("8x8 reset 8x8");
  (void)Next();
  EXPECT_NO_THROW(window_->Swap());
  (void)Next();
  EXPECT_THROW(window_->Swap(), DisplayError);
}

// --- the icon ---

TEST(WindowIcons, ShowARedPeakUnderABlueSky) {
  for (const int side : {16, 48}) {
    const std::vector<std::uint8_t> icon = WindowIcon(side);
    ASSERT_EQ(icon.size(), static_cast<std::size_t>(4 * side * side));
    const auto at = [&](double right, double down) {
      const auto pixel = static_cast<std::size_t>(down * side) * static_cast<std::size_t>(side) +
                         static_cast<std::size_t>(right * side);
      return &icon[4 * pixel];
    };
    EXPECT_GT(at(0.1, 0.02)[2], at(0.1, 0.02)[0]) << "the zenith is blue";
    EXPECT_GT(at(0.02, 0.7)[0], at(0.02, 0.7)[2]) << "the glow over the horizon is not";
    EXPECT_GT(at(0.52, 0.45)[0], 2 * at(0.4, 0.45)[0]) << "one side of the peak has the light";
  }
}

}  // namespace
}  // namespace alpenglow::viewer
