// SPDX-License-Identifier: MIT
#include "renderer/picture/prepared_scene.h"

#include <gtest/gtest.h>

#include "atmosphere/astronomy/sun.h"
#include "atmosphere/math/constants.h"
#include "tests/fixtures/bare_scene.h"

namespace alpenglow::renderer {
namespace {

glm::dvec3 SunAtElevation(double degrees) {
  return DirectionFromAngles(degrees * kRadiansPerDegree, 1.0).xyz;
}

TEST(RecentSunlight, IsMadeOnceForTheLastTwoSunsAndAnewForAnyOther) {
  const SceneGround ground = LoadGround(BareScene(2.0, 0.0, 0.0, 60.0));
  RecentSunlight recent(ground);
  constexpr double kRadius = 4.6e-3;
  const auto first = recent.At(SunAtElevation(10.0), kRadius).sunlight;
  const auto second = recent.At(SunAtElevation(11.0), kRadius).sunlight;
  EXPECT_NE(first, second);
  EXPECT_EQ(recent.At(SunAtElevation(10.0), kRadius).sunlight, first);
  EXPECT_EQ(recent.At(SunAtElevation(11.0), kRadius).sunlight, second);
  EXPECT_NE(recent.At(SunAtElevation(11.0), 2.0 * kRadius).sunlight, second) << "a larger disk";
  EXPECT_NE(recent.At(SunAtElevation(10.0), kRadius).sunlight, first) << "two are kept, no more";
}

}  // namespace
}  // namespace alpenglow::renderer
