// SPDX-License-Identifier: MIT
#include "renderer/report/reference_methods.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "atmosphere/reference/airlight_reference.h"
#include "tests/fixtures/media.h"

namespace alpenglow::renderer {
namespace {

TEST(LampWorks, RulesAgreeWithTheReferenceWhenTheyTakeManyPoints) {
  for (int i = 1; i <= 40; ++i) {
    const LampTestCase work = LampTestCaseNumber(i, {.g = 0.5});
    EXPECT_NEAR(AirlightByRule(LampRule::kEquiAngular, work, 20000) / work.truth, 1.0, 1e-4);
    EXPECT_NEAR(AirlightByRule(LampRule::kHalfAngle, work, 64) / work.truth, 1.0, 1e-3);
    EXPECT_NEAR(AirlightByRule(LampRule::kAsinh, work, 64) / work.truth, 1.0, 1e-3);
  }
}

TEST(LampWorks, ClosedFormOfSunEtAlIsTheIntegralInIsotropicFog) {
  const auto logarithmic = [](double low, double high, double u) {
    return low * std::pow(high / low, u);
  };
  for (int i = 1; i <= 50; ++i) {
    const double sigma = logarithmic(1e-3, 0.05, Halton(i, 2));
    const double along = 100.0 * Halton(i, 3), across = logarithmic(0.5, 50.0, Halton(i, 5));
    const double length = i % 4 == 0 ? std::numeric_limits<double>::infinity()
                                     : logarithmic(5.0, 500.0, Halton(i, 7));
    const LampAir air = HomogeneousAir(sigma, sigma, tests::LobeOf(0.0));
    Lamp lamp;
    lamp.position_m = {along, across, 0.0};
    const double truth = reference::AirlightAlong(air, lamp, {.end_m = length}).radiance[0];
    EXPECT_NEAR(AirlightOfSun2005(sigma, sigma, length, along, across) / truth, 1.0, 1e-7)
        << "differences of F lose what lies before the segment: case " << i;
  }
}

TEST(LampWorks, FunctionOfSunEtAlHasItsKnownValues) {
  EXPECT_NEAR(SunFunction(0.0, 1.2), 1.2, 1e-11) << "exp(0) over the angle";
  // F(u, pi/2) = Ci(u) sin(u) + (pi/2 - Si(u)) cos(u); at u = 1 (Abramowitz and Stegun 5.2).
  EXPECT_NEAR(SunFunction(1.0, 0.5 * kPi), 0.6214496242358134, 1e-10);
}

}  // namespace
}  // namespace alpenglow::renderer
