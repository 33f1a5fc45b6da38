// SPDX-License-Identifier: MIT
// What pictures lift a sun by that has set, against light of bent rays.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "atmosphere/number/constants.h"
#include "atmosphere/sun/refraction.h"
#include "atmosphere/sun/sun.h"
#include "tests/fixtures/bent_twilight.h"

namespace alpenglow {
namespace {

constexpr std::array kViews{std::array{90.0, 0.0}, std::array{45.0, 0.0}, std::array{45.0, 180.0},
                            std::array{5.0, 0.0}, std::array{20.0, 90.0}};

glm::dvec3 Towards(double elevation_deg, double azimuth_deg) {
  return DirectionFromAngles(elevation_deg * kRadiansPerDegree, azimuth_deg * kRadiansPerDegree)
      .xyz;
}

using Bands = std::array<double, 3>;

/// Largest error by band of straight rays from a lifted sun, over the views.
Bands WorstError(const tests::BentTwilight& air, double truly_deg, double lift_rad) {
  Bands worst{};
  for (const auto& [elevation, azimuth] : kViews) {
    const glm::dvec3 view = Towards(elevation, azimuth);
    const auto bent = air.Radiance(view, Towards(truly_deg, 0.0), true);
    const auto lifted =
        air.Radiance(view, Towards(truly_deg + lift_rad / kRadiansPerDegree, 0.0), false);
    for (std::size_t band = 0; band < worst.size(); ++band)
      worst[band] = std::max(worst[band], std::abs(lifted[band] / bent[band] - 1.0));
  }
  return worst;
}

TEST(TwilightLift, BringsDuskAsMuchLightAsBentRaysDo) {
  const tests::BentTwilight air(MediumPreset("earth", {450.0, 550.0, 650.0}));
  for (const double truly_deg : {-5.0, -6.5, -8.0}) {
    const double lift = RefractionFromHeight(air.air(), truly_deg * kRadiansPerDegree, 0.0);
    const Bands with = WorstError(air, truly_deg, lift), without = WorstError(air, truly_deg, 0.0);
    // One lift for all colours and views: red comes through lower air, which bends more.
    EXPECT_LT(with[0], 0.20) << truly_deg;
    EXPECT_LT(with[1], 0.20) << truly_deg;
    EXPECT_LT(with[2], 0.5) << truly_deg << ", without the lift up to 0.63";
    EXPECT_LT(with[1] + with[2], 0.7 * (without[1] + without[2])) << truly_deg;
  }
}

TEST(TwilightLift, BringsAnEveningSkyAtMostTwoFifthsTooMuch) {
  const tests::BentTwilight air(MediumPreset("earth", {450.0, 550.0, 650.0}));
  for (const double truly_deg : {1.0, -1.5, -3.0}) {
    const double lift = RefractionFromHeight(air.air(), truly_deg * kRadiansPerDegree, 0.0);
    for (const double error : WorstError(air, truly_deg, lift)) EXPECT_LT(error, 0.4) << truly_deg;
  }
}

}  // namespace
}  // namespace alpenglow
