// SPDX-License-Identifier: MIT
#include "lut/image/eye.h"

#include <gtest/gtest.h>

namespace alpenglow::lut {
namespace {

TEST(EyeAdaptation, FollowsMoreLightAndDuskWithoutALag) {
  EyeAdaptation eye;
  EXPECT_EQ(eye.Follow(-5.0, 0.0), -5.0);
  EXPECT_EQ(eye.Follow(15.0, 1.0), 15.0);
  for (double ev100 = 15.0; ev100 > -5.0; ev100 -= 0.5)
    EXPECT_EQ(eye.Follow(ev100, 60.0), ev100) << "half an EV a minute";
}

// From daylight to the light of a total eclipse within a minute.
TEST(EyeAdaptation, LagsBehindLightThatFallsFasterThanRodsRegenerate) {
  EyeAdaptation eye;
  (void)eye.Follow(13.0, 0.0);
  EXPECT_DOUBLE_EQ(eye.Follow(3.0, 60.0), 13.0 - 0.8 - 4.0);
  EXPECT_DOUBLE_EQ(eye.Follow(3.0, 120.0), 13.0 - 3 * 0.8 - 4.0);
  EXPECT_DOUBLE_EQ(eye.Follow(3.0, 600.0), 3.0) << "13 minutes regenerate 10.4 EV";
}

TEST(EyeAdaptation, AGlanceIntoShadeIsSeenAtOnce) {
  EyeAdaptation eye;
  (void)eye.Follow(15.0, 0.0);
  EXPECT_EQ(eye.Follow(11.0, 0.0), 11.0);
  EXPECT_EQ(eye.Follow(15.0, 0.0), 15.0);
}

}  // namespace
}  // namespace alpenglow::lut
