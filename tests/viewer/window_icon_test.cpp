// SPDX-License-Identifier: MIT
#include "viewer/window.h"

#include <gtest/gtest.h>

namespace alpenglow::viewer {
namespace {

TEST(WindowIcons, ThePeakIsRedUnderASkyThatIsBlueAbove) {
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
