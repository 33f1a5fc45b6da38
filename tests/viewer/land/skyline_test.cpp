// SPDX-License-Identifier: MIT
#include "renderer/terrain/seen_chunks.h"
#include "viewer/layer.h"

#include <gtest/gtest.h>

namespace alpenglow::viewer {
namespace {

// A wall 1 km north of the eye, 2 km wide and 100 m over the eye.
std::vector<LandSkyline::Between> Wall() {
  std::vector<LandSkyline::Between> wall;
  for (double x = -1000.0; x <= 1000.0; x += 50.0)
    wall.push_back({{x, 1000.0, 100.0}, {x, 1000.0, 110.0}});
  return wall;
}

TEST(LandSkyline, AWallHidesWhatStandsBehindItAndIsLower) {
  LandSkyline skyline;
  skyline.Add(Wall());
  EXPECT_FALSE(skyline.Hides({0.0, 500.0, 0.0}, 10.0, 0.0)) << "before it";
  EXPECT_TRUE(skyline.Hides({0.0, 3000.0, 0.0}, 50.0, 150.0))
      << "under the line of sight over its corners, 100 m in 1414 m";
  EXPECT_FALSE(skyline.Hides({0.0, 3000.0, 0.0}, 50.0, 301.0)) << "over it";
  EXPECT_FALSE(skyline.Hides({3000.0, 3000.0, 0.0}, 50.0, 0.0)) << "half behind its end";
  EXPECT_FALSE(skyline.Hides({3000.0, 0.0, 0.0}, 50.0, 0.0)) << "beside it";
  EXPECT_FALSE(skyline.Hides({0.0, -3000.0, 0.0}, 50.0, 0.0)) << "opposite";
}

TEST(LandSkyline, TheLowerOfTwoLevelsCounts) {
  std::vector<LandSkyline::Between> turning = Wall();
  for (LandSkyline::Between& vertex : turning) vertex.other.z = 20.0;
  LandSkyline skyline;
  skyline.Add(turning);
  EXPECT_FALSE(skyline.Hides({0.0, 3000.0, 0.0}, 50.0, 100.0));
  EXPECT_TRUE(skyline.Hides({0.0, 3000.0, 0.0}, 50.0, 20.0));
}

TEST(LandSkyline, AWallThatIsFartherHidesNothing) {
  LandSkyline skyline;
  skyline.Add(Wall());
  EXPECT_FALSE(skyline.Hides({0.0, 1400.0, 0.0}, 50.0, -10.0)) << "the wall's ends are 1414 m away";
  EXPECT_TRUE(skyline.Hides({0.0, 1500.0, 0.0}, 50.0, -10.0));
}

TEST(LandSkyline, SeenFromAboveTheGroundBehindACrestIsHiddenToo) {
  std::vector<LandSkyline::Between> crest = Wall();
  for (LandSkyline::Between& vertex : crest) {
    vertex.one.z = -100.0;
    vertex.other.z = -100.0;
  }
  LandSkyline skyline;
  skyline.Add(crest);
  EXPECT_TRUE(skyline.Hides({0.0, 2000.0, 0.0}, 50.0, -300.0));
  EXPECT_FALSE(skyline.Hides({0.0, 2000.0, 0.0}, 50.0, -150.0));
}

TEST(LandSkyline, AGapInAWallHidesNothing) {
  LandSkyline skyline;
  const std::vector<LandSkyline::Between> wall = Wall();
  skyline.Add(std::span(wall).first(18));
  skyline.Add(std::span(wall).last(18));  // 250 m are open in the middle
  EXPECT_FALSE(skyline.Hides({0.0, 3000.0, 0.0}, 50.0, 0.0));
}

}  // namespace
}  // namespace alpenglow::viewer
