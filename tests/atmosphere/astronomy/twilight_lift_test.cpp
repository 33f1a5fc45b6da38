// SPDX-License-Identifier: MIT
// The sun that lights the air by straight rays, against light of bent rays.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "atmosphere/astronomy/moon.h"
#include "atmosphere/astronomy/sun.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/refraction/refraction.h"
#include "tests/fixtures/refracted_twilight.h"

namespace alpenglow::atmosphere {
namespace {

constexpr std::array kViews{std::array{90.0, 0.0}, std::array{45.0, 0.0}, std::array{45.0, 180.0},
                            std::array{5.0, 0.0}, std::array{20.0, 90.0}};
constexpr double kArcMinute = kRadiansPerDegree / 60.0;

glm::dvec3 Towards(double elevation_deg, double azimuth_deg) {
  return DirectionFromAngles(elevation_deg * kRadiansPerDegree, azimuth_deg * kRadiansPerDegree)
      .xyz;
}

using Bands = std::array<double, 3>;

/// Relative errors by band of straight rays from a lifted sun, over the views.
struct SkyErrors {
  Bands worst{};
  double rms = 0.0;  // of all bands

  SkyErrors(const tests::RefractedTwilight& air, double truly_deg, double lift_rad) {
    for (const auto& [elevation, azimuth] : kViews) {
      const glm::dvec3 view = Towards(elevation, azimuth);
      const auto bent = air.Radiance(view, Towards(truly_deg, 0.0), true);
      const auto lifted =
          air.Radiance(view, Towards(truly_deg + lift_rad / kRadiansPerDegree, 0.0), false);
      for (std::size_t band = 0; band < worst.size(); ++band) {
        const double error = lifted[band] / bent[band] - 1.0;
        worst[band] = std::max(worst[band], std::abs(error));
        rms += error * error / static_cast<double>(kViews.size() * worst.size());
      }
    }
    rms = std::sqrt(rms);
  }
};

TEST(LiftForAir, GivesAnEveningSkyTheLightOfRefractedRays) {
  const tests::RefractedTwilight air(MediumPreset("earth", {450.0, 550.0, 650.0}));
  for (const double truly_deg : {1.0, -1.5, -3.0}) {
    const double lift = LiftForAir(air.air(), truly_deg * kRadiansPerDegree);
    const SkyErrors errors(air, truly_deg, lift);
    // One lift serves all colours and views: low in the west light comes through lower air.
    EXPECT_LT(errors.rms, 0.06) << truly_deg;
    for (const double worst : errors.worst) EXPECT_LT(worst, 0.15) << truly_deg;
  }
}

TEST(LiftForAir, ServesAirBetterThanTheRefractionThatIsSeen) {
  const tests::RefractedTwilight air(MediumPreset("earth", {450.0, 550.0, 650.0}));
  constexpr double kTruly_deg = -1.0;
  const double lift = LiftForAir(air.air(), kTruly_deg * kRadiansPerDegree);
  const double seen = RefractionFromHeight(air.air(), kTruly_deg * kRadiansPerDegree, 0.0);
  EXPECT_LT(SkyErrors(air, kTruly_deg, lift).rms, 0.4 * SkyErrors(air, kTruly_deg, seen).rms)
      << "from where it is seen, the sun lights the air by a third too much";
}

TEST(LiftForAir, GivesDuskMoreOfTheLightOfRefractedRaysThanNoLift) {
  const tests::RefractedTwilight air(MediumPreset("earth", {450.0, 550.0, 650.0}));
  for (const double truly_deg : {-5.0, -6.5, -8.0}) {
    const double lift = LiftForAir(air.air(), truly_deg * kRadiansPerDegree);
    const Bands with = SkyErrors(air, truly_deg, lift).worst,
                without = SkyErrors(air, truly_deg, 0.0).worst;
    // Red comes through lower air, which bends more.
    EXPECT_LT(with[0], 0.20) << truly_deg;
    EXPECT_LT(with[1], 0.25) << truly_deg;
    EXPECT_LT(with[2], 0.5) << truly_deg << ", without the lift up to 0.63";
    EXPECT_LT(with[1] + with[2], 0.75 * (without[1] + without[2])) << truly_deg;
  }
}

TEST(LiftForAir, RisesSmoothlyToAFifthOfTheHorizontalRefraction) {
  const BendingAir air = AlmanacAir();
  EXPECT_NEAR(LiftForAir(air, -34.0 * kArcMinute) / kArcMinute, 0.2 * 34.0, 0.01);
  EXPECT_EQ(LiftForAir(air, -0.7), LiftForAir(air, -34.1 * kArcMinute)) << "nothing ends at night";
  // A sun that sinks by a minute of arc lights the air from 0.9 to 1.04 minutes lower, whatever happens
  // to what is seen of it: refraction itself grows by at most 0.2 of what it sinks by.
  for (double minutes = 120.0; minutes > -600.0; minutes -= 1.0) {
    const double before = minutes * kArcMinute + LiftForAir(air, minutes * kArcMinute);
    const double after =
        (minutes - 1.0) * kArcMinute + LiftForAir(air, (minutes - 1.0) * kArcMinute);
    EXPECT_GT((before - after) / kArcMinute, 0.9) << minutes;
    EXPECT_LT((before - after) / kArcMinute, 1.0 + 1e-6) << minutes;
  }
}

TEST(LiftForAir, IsNothingWithoutAir) {
  BendingAir none = AlmanacAir();
  none.refractivity = 0.0;
  for (const double elevation_deg : {10.0, 0.0, -1.0, -10.0})
    EXPECT_NEAR(LiftForAir(none, elevation_deg * kRadiansPerDegree), 0.0, 1e-12) << elevation_deg;
}

TEST(SunForAir, IsRaisedByTheLiftForAirAtAnyHeight) {
  for (const double height_m : {0.0, 3000.0, 11000.0, 400e3}) {
    const GeodeticPosition eye = PlaceFromDegrees(46.5, 8.0, height_m);
    for (const char* time :
         {"2026-06-21T11:00:00Z", "2026-06-21T19:22:00Z", "2026-06-21T20:20:00Z"}) {
      const UtcInstant now = ParseInstant(time);
      const SunPosition truly = SunAt(eye, now), seen = ApparentSunAt(eye, now);
      EXPECT_NEAR(SunForAir(seen).elevation_rad,
                  truly.elevation_rad + LiftForAir(AlmanacAir(), truly.elevation_rad), 1e-12)
          << time << " " << height_m;
      EXPECT_EQ(SunForAir(seen).azimuth_rad, seen.azimuth_rad);
      EXPECT_EQ(SunForAir(truly).elevation_rad, truly.elevation_rad) << "nothing has lifted it";
      const MoonPosition moon = ApparentMoonAt(eye, now), bare = MoonAt(eye, now);
      EXPECT_NEAR(moon.elevation_rad - moon.lower_for_air_rad,
                  bare.elevation_rad + LiftForAir(AlmanacAir(), bare.elevation_rad), 1e-12);
    }
  }
}

}  // namespace
}  // namespace alpenglow::atmosphere
