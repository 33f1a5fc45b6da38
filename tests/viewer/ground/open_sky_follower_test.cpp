// SPDX-License-Identifier: MIT
#include "viewer/ground/open_sky_follower.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

#include "atmosphere/math/constants.h"

namespace alpenglow::viewer {
namespace {

OpenSky SkyOfEarth(double elevation_rad) {
  static const std::shared_ptr<const SolvedAir> air =
      SolveAir(MediumPreset("bruneton2017"), AirSolution::kDraft);
  static const auto single_scattering =
      std::make_shared<const SingleScattering<float>>(air->medium);
  return {air, single_scattering, 800.0, elevation_rad};
}

/// Makes tables, and counts those that the thread that draws had to make.
class CountedMaker {
 public:
  SkyIrradianceGradient operator()(const OpenSky& sky) {
    if (std::this_thread::get_id() == drawing_) ++*while_drawing_;
    ++*all_;
    return OpenSkyFollower::LightOf(sky);
  }
  [[nodiscard]] int while_drawing() const { return *while_drawing_; }
  [[nodiscard]] int all() const { return *all_; }

 private:
  std::thread::id drawing_ = std::this_thread::get_id();
  std::shared_ptr<std::atomic<int>> while_drawing_ = std::make_shared<std::atomic<int>>(0);
  std::shared_ptr<std::atomic<int>> all_ = std::make_shared<std::atomic<int>>(0);
};

// Follows a sky until no more tables are made.
void FollowUntilMade(OpenSkyFollower& follower, const CountedMaker& maker, const OpenSky& sky) {
  constexpr int kStill = 60;  // calls, at least as many milliseconds; a table takes some
  int made = -1;
  for (int still = 0; still < kStill; ++still) {
    follower.Follow(sky);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    if (maker.all() != made) still = 0;
    made = maker.all();
  }
}

// Returns the largest difference on slopes, relative to the light of level ground.
double DifferenceOf(const SkyIrradianceGradient& one, const SkyIrradianceGradient& other) {
  double most = 0.0;
  for (const double tilt : {0.0, 0.5, 1.2}) {
    for (const double sunward : {-1.0, 0.0, 1.0}) {
      const auto light = one.On(std::cos(tilt), sunward * std::sin(tilt));
      const auto exact = other.On(std::cos(tilt), sunward * std::sin(tilt));
      for (std::size_t band = 0; band < 3; ++band)
        most = std::max(most, std::abs(double{light[band]} / double{exact[band]} - 1.0));
    }
  }
  return most;
}

TEST(OpenSkyFollower, ASinkingSunMakesOneTableWhileDrawing) {
  CountedMaker maker;
  OpenSkyFollower follower(maker);
  for (int step = 0; step < 6; ++step) {
    const double elevation_rad = -(6.1 + 0.5 * step) * OpenSkyFollower::kStep_rad;
    FollowUntilMade(follower, maker, SkyOfEarth(elevation_rad));
  }
  EXPECT_EQ(maker.while_drawing(), 1) << "of the first sky; all others are made ahead";
}

TEST(OpenSkyFollower, AtRestNoTableIsMade) {
  CountedMaker maker;
  OpenSkyFollower follower(maker);
  FollowUntilMade(follower, maker, SkyOfEarth(0.1));
  EXPECT_EQ(maker.all(), 4) << "one of the first sky, two around it, and one ahead";
}

// The tolerance is that of the header. Between two tables the error is largest in the middle.
TEST(OpenSkyFollower, BetweenTablesTheLightIsThatOfATable) {
  for (const double elevation_deg : {20.0, 2.0, -1.0, -3.0, -5.0, -7.0}) {
    CountedMaker maker;
    OpenSkyFollower follower(maker);
    const double node = std::floor(elevation_deg * kRadiansPerDegree / OpenSkyFollower::kStep_rad);
    const OpenSky middle = SkyOfEarth((node + 0.5) * OpenSkyFollower::kStep_rad);
    FollowUntilMade(follower, maker, middle);
    EXPECT_LT(DifferenceOf(follower.light(), OpenSkyFollower::LightOf(middle)), 0.003)
        << elevation_deg;
  }
}

TEST(OpenSkyFollower, AnAwaitedSkyIsExact) {
  OpenSkyFollower follower;
  const OpenSky sky = SkyOfEarth(0.0123);
  follower.WaitUntilReady(sky);
  EXPECT_EQ(follower.light().nodes, OpenSkyFollower::LightOf(sky).nodes);
}

TEST(OpenSkyFollower, AnotherAltitudeIsShownAtOnce) {
  CountedMaker maker;
  OpenSkyFollower follower(maker);
  FollowUntilMade(follower, maker, SkyOfEarth(0.1));
  OpenSky higher = SkyOfEarth(0.1);
  higher.altitude_m += 1000.0;
  follower.Follow(higher);
  EXPECT_EQ(follower.light().nodes, OpenSkyFollower::LightOf(higher).nodes);
}

}  // namespace
}  // namespace alpenglow::viewer
