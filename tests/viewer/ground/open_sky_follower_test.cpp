// SPDX-License-Identifier: MIT
#include "viewer/ground/open_sky_follower.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

#include "atmosphere/math/constants.h"

namespace alpenglow::viewer {
namespace {

OpenSky SkyOfEarth(double elevation_rad) {
  static const std::shared_ptr<const SolvedAir> air =
      std::make_shared<const SolvedAir>(MediumPreset("bruneton2017"), AirSolution::kDraft);
  return {air, 800.0, elevation_rad};
}

/// Makes tables, and counts those that the thread that draws had to make.
class CountedMaker {
 public:
  SkyIrradianceGradient operator()(const OpenSky& sky) {
    SkyIrradianceGradient light = OpenSkyFollower::LightOf(sky);
    if (std::this_thread::get_id() == drawing_) ++*while_drawing_;
    ++*all_;
    return light;
  }
  [[nodiscard]] int while_drawing() const { return *while_drawing_; }
  [[nodiscard]] int all() const { return *all_; }

 private:
  std::thread::id drawing_ = std::this_thread::get_id();
  std::shared_ptr<std::atomic<int>> while_drawing_ = std::make_shared<std::atomic<int>>(0);
  std::shared_ptr<std::atomic<int>> all_ = std::make_shared<std::atomic<int>>(0);
};

// Follows a sky until a number of tables has been made, for a minute at most, and some calls
// longer: these take the last one over, and would make more if they were missing.
void FollowUntilMade(OpenSkyFollower& follower, const CountedMaker& maker, const OpenSky& sky,
                     int tables) {
  constexpr int kMostWaits = 60000, kCallsMore = 25;  // a millisecond apart
  const auto follow = [&] {
    follower.Follow(sky);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  };
  for (int wait = 0; wait < kMostWaits && maker.all() < tables; ++wait) follow();
  for (int call = 0; call < kCallsMore; ++call) follow();
  EXPECT_EQ(maker.all(), tables);
}

// One of the first sky, two around it, and one ahead.
constexpr int kFirstTables = 4;

// Returns the largest difference on slopes, relative to the light of level ground.
double DifferenceOf(const SkyIrradianceGradient& one, const SkyIrradianceGradient& other) {
  double most = 0.0;
  for (const double tilt : {0.0, 0.5, 1.2}) {
    for (const double sunward : {-1.0, 0.0, 1.0}) {
      const auto light = one.On(std::cos(tilt), sunward * std::sin(tilt));
      const auto exact = other.On(std::cos(tilt), sunward * std::sin(tilt));
      for (std::size_t band = 0; band < light.size(); ++band)
        most = std::max(most, std::abs(double{light[band]} / double{exact[band]} - 1.0));
    }
  }
  return most;
}

// The sun passes a table at every second step, and another one ahead is then made. At the second
// step it is known to sink: the first table ahead was for a rising sun.
TEST(OpenSkyFollower, ASinkingSunNeedsOneTableWhileDrawing) {
  CountedMaker maker;
  OpenSkyFollower follower(maker);
  constexpr std::array kTables{kFirstTables, 5, 6, 6, 7, 7};
  for (std::size_t step = 0; step < kTables.size(); ++step) {
    const double steps = 6.1 + 0.5 * static_cast<double>(step);
    FollowUntilMade(follower, maker, SkyOfEarth(-steps * OpenSkyFollower::kStep_rad),
                    kTables[step]);
  }
  EXPECT_EQ(maker.while_drawing(), 1) << "of the first sky; all others are made ahead";
}

TEST(OpenSkyFollower, NoTableIsMadeAtRest) {
  CountedMaker maker;
  OpenSkyFollower follower(maker);
  FollowUntilMade(follower, maker, SkyOfEarth(0.1), kFirstTables);
  for (int call = 0; call < 25; ++call) follower.Follow(SkyOfEarth(0.1));
  EXPECT_EQ(maker.all(), kFirstTables);
}

// The tolerance is that of the header. Between two tables the error is largest in the middle.
TEST(OpenSkyFollower, InterpolatedLightEqualsThatOfATable) {
  for (const double elevation_deg : {20.0, 2.0, -1.0, -3.0, -5.0, -7.0}) {
    CountedMaker maker;
    OpenSkyFollower follower(maker);
    const double node = std::floor(elevation_deg * kRadiansPerDegree / OpenSkyFollower::kStep_rad);
    const OpenSky middle = SkyOfEarth((node + 0.5) * OpenSkyFollower::kStep_rad);
    FollowUntilMade(follower, maker, middle, kFirstTables);
    EXPECT_NE(follower.light().nodes, OpenSkyFollower::LightOf(middle).nodes)
        << "it is interpolated between two tables";
    EXPECT_LT(DifferenceOf(follower.light(), OpenSkyFollower::LightOf(middle)), 0.003)
        << elevation_deg;
  }
}

TEST(OpenSkyFollower, SkyIsExactAfterWaiting) {
  OpenSkyFollower follower;
  const OpenSky sky = SkyOfEarth(0.0123);
  follower.WaitUntilReady(sky);
  EXPECT_EQ(follower.light().nodes, OpenSkyFollower::LightOf(sky).nodes);
}

TEST(OpenSkyFollower, ANewAltitudeIsShownAtOnce) {
  CountedMaker maker;
  OpenSkyFollower follower(maker);
  FollowUntilMade(follower, maker, SkyOfEarth(0.1), kFirstTables);
  OpenSky higher = SkyOfEarth(0.1);
  higher.altitude_m += 1000.0;
  follower.Follow(higher);
  EXPECT_EQ(follower.light().nodes, OpenSkyFollower::LightOf(higher).nodes);
}

}  // namespace
}  // namespace alpenglow::viewer
