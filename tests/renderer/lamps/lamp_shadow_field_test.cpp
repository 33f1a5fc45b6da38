// SPDX-License-Identifier: MIT
// Plans of the ground that lamps light, against the shadow rays that they stand for.
#include "renderer/lamps/lamp_shadow_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "renderer/lamps/placed_lamp.h"
#include "tests/fixtures/bare_scene.h"
#include "tests/renderer/lamps/ridge.h"

namespace alpenglow::renderer {
namespace {

/// Level ground with a ridge, and a lamp behind it.
struct Valley {
  Scene scene = BareScene(6.0, 0.0, 0.0, 40.0);
  SceneGround ground = Ridge(scene);
  LampStage stage{scene, ground, scene.medium};
  Lamp lamp;

  Valley() { lamp.position_m = {30.0, 400.0, 5.0}; }

  [[nodiscard]] bool IsLit(const glm::dvec3& place) const {
    const auto hit = stage.TerrainAt(place);
    return !stage.Shades(lamp, hit->hit.smooth_point, hit->hit.geometric_normal);
  }
};

/// Returns the distance of a place from the edge of shade on a level [m], as a shader interpolates
/// it.
double FromEdge(const LampShadowField& plan, int level, const glm::dvec3& from_lamp) {
  const double step_m = std::ldexp(kPlanStep_m, level);
  const double x = from_lamp.x / step_m + kPlanSide / 2.0,
               y = from_lamp.y / step_m + kPlanSide / 2.0;
  const int column = static_cast<int>(x), row = static_cast<int>(y);
  const auto texel = [&](int i, int j) {
    const int number = (level * kPlanSide + row + j) * kPlanSide + column + i;
    return static_cast<double>(plan.texels[static_cast<std::size_t>(number)]);
  };
  const double south = std::lerp(texel(0, 0), texel(1, 0), x - column);
  const double north = std::lerp(texel(0, 1), texel(1, 1), x - column);
  return step_m * kPlanRange_steps * (std::lerp(south, north, y - row) - 128.0) / 127.0;
}

/// Returns the share of places on the wrong side, among those between two distances east or north
/// of the lamp.
double WrongShare(const Valley& valley, const LampShadowField& plan, int level, double from_m,
                  double to_m) {
  std::mt19937 random(2);
  std::uniform_real_distribution<> east(-590.0, 590.0), north(-590.0, 590.0);
  int wrong = 0, places = 0;
  while (places < 5000) {
    const glm::dvec3 place(east(random), north(random), 0.0);
    const glm::dvec3 way = place - valley.lamp.position_m;
    const double away_m = std::max(std::abs(way.x), std::abs(way.y));
    if (away_m < from_m || away_m > to_m) continue;
    ++places;
    if ((FromEdge(plan, level, way) > 0.0) != valley.IsLit(place)) ++wrong;
  }
  return wrong / 5000.0;
}

TEST(LampShadowField, GroundIsOnTheSideOfTheEdgeFoundByShadowRays) {
  const Valley valley;
  const LampShadowField plan = LampShadowFieldAround(valley.stage, valley.lamp, 2);
  constexpr double kReach_m = kPlanReach_steps * kPlanStep_m;
  // Triangles are 10 m wide: the edge turns by a corner every few of them, which is rounded.
  EXPECT_LT(WrongShare(valley, plan, 0, 0.0, kReach_m), 2e-3);
  EXPECT_LT(WrongShare(valley, plan, 1, kReach_m, 2.0 * kReach_m), 4e-3);
}

TEST(LampShadowField, TheEdgeBehindAStraightRidgeIsWithinCentimetres) {
  const Valley valley;
  const LampShadowField plan = LampShadowFieldAround(valley.stage, valley.lamp, 1);
  for (double east_m = -160.0; east_m < 220.0; east_m += 17.3) {
    // The slope towards the lamp begins at the crest.
    const glm::dvec3 place(east_m, 150.0, 0.0);
    EXPECT_NEAR(FromEdge(plan, 0, place - valley.lamp.position_m), 0.0, 0.05) << east_m;
  }
}

TEST(LampShadowField, LevelsReachAsFarAsTheLight) {
  EXPECT_EQ(PlanLevelsOf(1.0), 1);
  EXPECT_EQ(PlanLevelsOf(200.0), 1) << "a millilux is at 447 m, the first level ends at 508 m";
  EXPECT_EQ(PlanLevelsOf(600.0), 2) << "775 m";
  EXPECT_EQ(PlanLevelsOf(20e3), 5) << "4.5 km; the fourth level ends at 4.1 km";
  EXPECT_EQ(PlanLevelsOf(1e9), kMostPlanLevels);
}

}  // namespace
}  // namespace alpenglow::renderer
