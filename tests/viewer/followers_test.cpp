// SPDX-License-Identifier: MIT
// Tests of values that threads compute while frames are drawn: air, ground and shade follow an eye
// and a sun.
#include "atmosphere/base/async_value.h"

#ifdef __linux__
#include <sys/resource.h>
#include <unistd.h>
#endif

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <future>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/constants.h"
#include "renderer/lit_ground/ground_follower.h"
#include "renderer/procedural_mountains/procedural_mountains.h"
#include "tests/lut/camera_tables/air_reference.h"
#include "tests/viewer/shaders/headless.h"
#include "viewer/air/air_follower.h"
#include "viewer/shade/shafts.h"

namespace alpenglow::viewer {
namespace {

TEST(AsyncValue, ReplacedRequestIsNotComputed) {
  std::promise<void> begun, go_on;
  std::vector<int> made;
  AsyncValue<int, int> value([&](const int& number) {
    if (number == 1) {
      begun.set_value();
      go_on.get_future().wait();
    }
    made.push_back(number);
    return 10 * number;
  });
  value.Request(1);
  begun.get_future().wait();
  value.Request(2);
  value.Request(3);
  EXPECT_TRUE(value.IsBusy());
  go_on.set_value();
  value.Wait();
  EXPECT_EQ(value.Poll(), std::optional(30));
  EXPECT_EQ(value.Poll(), std::nullopt) << "a value is taken over once";
  EXPECT_EQ(made, (std::vector{1, 3}));
}

TEST(AsyncValue, ExceptionsReachTheCallerAndTheThreadContinues) {
  AsyncValue<int, int> value([](const int& number) {
    if (number == 1) throw std::runtime_error("no air");
    return number;
  });
  value.Request(1);
  value.Wait();
  EXPECT_THROW(static_cast<void>(value.Poll()), std::runtime_error);
  value.Request(2);
  value.Wait();
  EXPECT_EQ(value.Poll(), std::optional(2));
}

TEST(AsyncValue, CanBeDestroyedWithAWaitingRequest) {
  AsyncValue<int, int> value([](const int& number) { return number; });
  value.Request(1);
  SUCCEED() << "the destructor returns";
}

#ifdef __linux__
int PriorityOfThisThread() { return getpriority(PRIO_PROCESS, static_cast<id_t>(gettid())); }

// 19 is the lowest priority of Linux.
TEST(AsyncValue, LowersThreadPriorityOnlyOnRequest) {
  AsyncValue<int, int> value([](const int&) { return PriorityOfThisThread(); },
                             std::equal_to<int>());
  const int usual = PriorityOfThisThread();
  value.WaitUntilReady(1);
  EXPECT_EQ(value.Poll(), std::optional(usual));
  value.RequestWhenIdle(2);
  value.Wait();
  EXPECT_EQ(value.Poll(), std::optional(std::min(usual + 10, 19)));
  value.RequestWhenIdle(3);
  value.Wait();
  EXPECT_EQ(value.Poll(), std::optional(std::min(usual + 10, 19)));
  EXPECT_EQ(PriorityOfThisThread(), usual);
}
#endif

TEST(AsyncValue, RequestsFollowThePolicy) {
  AsyncValue<double, double> value([](const double& input) { return 2.0 * input; },
                                   [](const double& requested, const double& wanted) {
                                     return std::abs(requested - wanted) < 0.5;
                                   });
  EXPECT_FALSE(value.Update());
  EXPECT_EQ(value.value(), std::nullopt);
  value.WaitUntilReady(1.0);
  EXPECT_TRUE(value.Update());
  EXPECT_FALSE(value.RequestIfNeeded(1.2)) << "the newest request suits";
  EXPECT_FALSE(value.Update());
  EXPECT_EQ(value.value(), std::optional(2.0));
  value.RestFor(1e6);
  value.RequestWhenIdle(3.0);
  EXPECT_EQ(value.requested(), std::optional(1.0)) << "it rests";
  value.WaitUntilReady(3.0);
  EXPECT_EQ(value.Poll(), std::optional(6.0)) << "who waits does not rest";
  value.Forget();
  value.RequestWhenIdle(3.0);
  value.Wait();
  EXPECT_EQ(value.Poll(), std::optional(6.0)) << "a forgotten request is made again";
}

// --- tables of the air ---

using AirFollowerOnGpu = tests::Headless;

const std::shared_ptr<const TabulatedAir>& Earth() {
  static const auto earth = TabulateAir(MediumPreset("earth"));
  return earth;
}

Place PlaceAt(double altitude_m) { return PlaceFromRadians(0.8, 0.0, altitude_m); }

DistantLight SunUp(double elevation_deg) {
  return {LightSource::kSun, tests::EyeUnderSun(0.0, elevation_deg).light, kSunAngularRadius_rad,
          Spectrum(4)};
}

// Frames with the same eye and sun until the tables shown are for them.
void Frames(AirFollower& follower, const Place& eye, const DistantLight& sun) {
  while (follower.eye().altitude_m != eye.height_m) {
    follower.Follow(eye, sun);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

TEST_F(AirFollowerOnGpu, HasTablesForTheFirstFrame) {
  const AirFollower follower(Earth(), AirQuality::kLow, PlaceAt(2.0), SunUp(30.0));
  EXPECT_EQ(follower.eye().altitude_m, 2.0);
  EXPECT_EQ(follower.tabulated(), Earth());
  EXPECT_EQ(follower.making_s(), 0.0) << "made before drawing, not beside it";
}

TEST_F(AirFollowerOnGpu, ShowsExactTablesWhenNothingMoves) {
  AirFollower follower(Earth(), AirQuality::kLow, PlaceAt(2.0), SunUp(30.0));
  Frames(follower, PlaceAt(2.5), SunUp(30.0));
  EXPECT_EQ(follower.eye().altitude_m, 2.5) << "however small the change";
  EXPECT_GT(follower.making_s(), 0.0);
}

TEST_F(AirFollowerOnGpu, IgnoresTinyChangesWhileTheEyeMoves) {
  AirFollower follower(Earth(), AirQuality::kLow, PlaceAt(1000.0), SunUp(30.0));
  follower.WaitUntilReady(PlaceAt(1000.0), SunUp(30.0));
  for (int i = 1; i <= 10; ++i) {
    follower.Follow(PlaceAt(1000.0 + 0.01 * i), SunUp(30.0));
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_EQ(follower.eye().altitude_m, 1000.0);
}

TEST_F(AirFollowerOnGpu, TablesAreMadeForTheFutureSun) {
  AirFollower follower(Earth(), AirQuality::kLow, PlaceAt(2.0), SunUp(3.0));
  follower.WaitUntilReady(PlaceAt(2.0), SunUp(3.0));
  // The sun moves so fast that it sinks by about 0.2 degrees until the tables are shown, however
  // long this machine takes for them: by less, no tables would be due; after a jump, small tables
  // for the present sun would be shown instead.
  constexpr double kFrame_s = 0.04, kSink_deg = 0.2;
  const DistantLight now = SunUp(3.0 - kSink_deg * kFrame_s / (follower.making_s() + kFrame_s));
  follower.Follow(PlaceAt(2.0), now, kFrame_s);  // asks
  const double made_mu_s = follower.eye().mu_s();
  while (follower.eye().mu_s() == made_mu_s) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    follower.Follow(PlaceAt(2.0), now, kFrame_s);
  }
  EXPECT_LT(follower.eye().mu_s(), now.direction.for_air.z) << "lower, for the sun sinks";
}

TEST_F(AirFollowerOnGpu, WaitingShowsTheLastRequest) {
  AirFollower follower(Earth(), AirQuality::kLow, PlaceAt(2.0), SunUp(30.0));
  follower.Follow(PlaceAt(500.0), SunUp(20.0));
  follower.WaitUntilReady(PlaceAt(9000.0), SunUp(-3.0));
  EXPECT_EQ(follower.eye().altitude_m, 9000.0);
  EXPECT_NEAR(follower.eye().mu_s(), std::sin(-3.0 * kRadiansPerDegree), 1e-12);
}

TEST_F(AirFollowerOnGpu, ANewMediumIsShownAsADraftFirst) {
  AirFollower follower(Earth(), AirQuality::kLow, PlaceAt(2.0), SunUp(30.0));
  follower.Replace(MediumPreset("hazy"));
  follower.Follow(PlaceAt(2.0), SunUp(30.0));
  EXPECT_EQ(follower.air()->medium().name, "earth") << "until then the last one";
  while (follower.tabulated() == Earth()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    follower.Follow(PlaceAt(2.0), SunUp(30.0));
  }
  EXPECT_EQ(follower.air()->medium().name, "hazy");
  EXPECT_EQ(follower.air()->solution(), AirSolution::kDraft);
  follower.WaitUntilReady(PlaceAt(2.0), SunUp(30.0));
  EXPECT_EQ(follower.air()->medium().name, "hazy");
  EXPECT_EQ(follower.air()->solution(), AirSolution::kFull);
}

// --- what is left alone ---

/// Tables made for one eye, as another sees them: root mean square of relative errors of the sky.
double ErrorOfOld(const EyeUnderLight& made, const EyeUnderLight& now) {
  const SolvedAir& air = tests::Earth();
  static const MediumTables medium = MakeMediumTables(air);
  const AirTablesSize size = AirTablesSizeOf(AirQuality::kHigh, now.altitude_m);
  const AirTables old = MakeAirTables(air, medium, made, size);
  const AirMap map(air.medium(), now.altitude_m,
                   static_cast<double>(air.multiple_scattering().grid().twilight_fall));
  return tests::SkyErrors(tests::AirReference(air, now), tests::AirReading(old, now), map, 200)
      .Rms();
}

TEST(AirChange, EstimatesTheErrorOfOldTables) {
  constexpr std::array<std::array<double, 4>, 9> kChanges{{{1500.0, 40.0, 1500.0, 39.0},
                                                           {1500.0, 5.0, 1500.0, 4.9},
                                                           {1500.0, 0.1, 1500.0, 0.05},
                                                           {2.0, -4.0, 2.0, -4.03},
                                                           {2.0, -9.0, 2.0, -9.03},
                                                           {200.0, 20.0, 260.0, 20.0},
                                                           {9000.0, 20.0, 9100.0, 20.0},
                                                           {30e3, 20.0, 31e3, 20.0},
                                                           {400e3, 20.0, 402e3, 20.0}}};
  for (const auto& [altitude_m, elevation_deg, later_m, later_deg] : kChanges) {
    const EyeUnderLight made = tests::EyeUnderSun(altitude_m, elevation_deg);
    const EyeUnderLight now = tests::EyeUnderSun(later_m, later_deg);
    const double error = ErrorOfOld(made, now);
    const double guess = AirChange(made, now);
    EXPECT_LT(error, 2.0 * guess + 1e-3) << now.altitude_m << " m, sun " << now.mu_s();
    EXPECT_GT(error, 0.2 * guess) << now.altitude_m << " m, sun " << now.mu_s()
                                  << ": tables would be made anew for nothing";
  }
}

TEST_F(AirFollowerOnGpu, RefusesAnUnsupportedMediumAtOnce) {
  AirFollower follower(Earth(), AirQuality::kLow, PlaceAt(2.0), SunUp(30.0));
  EXPECT_THROW(follower.Replace(MediumPreset("earth", WavelengthSet(8))), InputError);
  Medium broken = MediumPreset("earth");
  broken.mie_scale_height_m = -1.0;
  EXPECT_THROW(follower.Replace(broken), InputError);
}

// --- light on the ground ---

const Place kFollowedPlace{46.5, 8.0, 0.0};
constexpr GroundExtent kSmall{8e3, 128};

DistantLight SunAt(double elevation_deg, double azimuth_rad) {
  SunInSky sun{};
  sun.elevation_deg = elevation_deg;
  sun.azimuth_deg = azimuth_rad / kRadiansPerDegree;
  sun.angular_radius_deg = 0.00465 / kRadiansPerDegree;
  sun.distance_au = 1.0;
  return SunlightOf(sun, MediumPreset("bruneton2017"));
}

GroundFollower::View ViewFrom(const Place& place, double elevation_deg) {
  GroundFollower::View view{place, ParseInstant("2026-06-21T12:00:00Z"), SunAt(elevation_deg, 4.0)};
  view.eye.height_m = 1500.0;
  return view;
}

/// Returns every `stride`-th sample of the built-in range around a place.
std::optional<ElevationGrid> RangeAround(const Place& place, double half_width_m,
                                         int most_samples) {
  static const ElevationGrid range = ProceduralMountains(kFollowedPlace);
  if (!range.Covers(place.latitude_rad(), place.longitude_rad())) return std::nullopt;
  ElevationGrid around;
  around.columns = around.rows = most_samples;
  around.step_lat_rad = 2.0 * half_width_m / 6.37e6 / (most_samples - 1);
  around.step_lon_rad = around.step_lat_rad / std::cos(place.latitude_rad());
  around.north_rad = place.latitude_rad() + half_width_m / 6.37e6;
  around.west_rad = place.longitude_rad() - 0.5 * (most_samples - 1) * around.step_lon_rad;
  for (int row = 0; row < around.rows; ++row) {
    for (int column = 0; column < around.columns; ++column) {
      const auto height =
          range.HeightAt(around.LatitudeOfRow(row), around.LongitudeOfColumn(column));
      around.height_m.push_back(static_cast<float>(height.value_or(0.0)));
    }
  }
  return around;
}

/// Solved once for all of these tests.
const std::shared_ptr<const SolvedAir>& Air() {
  static const auto air = std::make_shared<const SolvedAir>(
      OnOsculatingSphere(MediumPreset("bruneton2017"), kFollowedPlace.latitude_rad()),
      AirSolution::kDraft);
  return air;
}

TEST(GroundFollower, WithoutLandThereIsNoLight) {
  GroundFollower follower({}, nullptr, kSmall);
  static_cast<void>(follower.WaitUntilReady(Air(), ViewFrom(kFollowedPlace, 30.0)));
  EXPECT_EQ(follower.lit(), nullptr);
  EXPECT_FALSE(follower.Light());
  follower.SetGround([](const Place&, double, int) -> std::optional<ElevationGrid> { return {}; });
  static_cast<void>(follower.WaitUntilReady(Air(), ViewFrom(kFollowedPlace, 30.0)));
  EXPECT_EQ(follower.lit(), nullptr) << "no land around here";
}

TEST(GroundFollower, SeaWithoutLandMirrorsTheSky) {
  GroundCover sea;
  sea.kind = GroundCover::Kind::kWater;
  GroundFollower follower(sea, nullptr, kSmall);
  EXPECT_TRUE(follower.WaitUntilReady(Air(), ViewFrom(kFollowedPlace, 30.0)));
  EXPECT_EQ(follower.lit(), nullptr);
  const GlossMirror& mirror = follower.gloss_mirror(LightSource::kSun);
  constexpr std::size_t kLayer = GlossMirror::kSide * GlossMirror::kSide;
  ASSERT_EQ(mirror.waves.size(), kLayer * GlossMirror::kLayers);
  EXPECT_TRUE(mirror.land.empty()) << "nothing else mirrors";
  for (std::size_t i = 0; i < kLayer; ++i) EXPECT_GT(mirror.waves[i][1], 0.0F) << "no horizon";
}

TEST(GroundFollower, LightOnTheRangeIsThatOfTheRequestedSun) {
  GroundFollower follower({}, nullptr, kSmall);
  follower.SetGround(RangeAround);
  EXPECT_TRUE(follower.WaitUntilReady(Air(), ViewFrom(kFollowedPlace, 30.0)));
  ASSERT_NE(follower.lit(), nullptr);
  EXPECT_NEAR(follower.lit()->lighting().source.direction.seen.z, 0.5, 1e-3) << "30 degrees high";
  EXPECT_GT(follower.making_s(), 0.0);
  const std::optional<LightOfVertices> light = follower.Light();
  ASSERT_TRUE(light);
  Place foot = kFollowedPlace;
  LandVertex vertex{};
  vertex.normal = {0.0F, 0.0F, 1.0F};
  vertex.position_m = {0.0F, 0.0F,
                       static_cast<float>(RangeAround(kFollowedPlace, 100.0, 3)->height_m[4])};
  const std::vector<VertexLight> lit = light->at(LocalFrame(kWgs84, foot), {&vertex, 1});
  ASSERT_EQ(lit.size(), 1U);
  EXPECT_GT(lit[0].sky[0], 0.0F) << "level ground sees the sky";
}

TEST(GroundFollower, AHigherEyeHasLightOnMoreDistantLand) {
  EXPECT_EQ(kSmall.HalfWidthUnder(0.0), 8e3);
  EXPECT_EQ(kSmall.HalfWidthUnder(8e3 / 7.0), 8e3);
  EXPECT_EQ(kSmall.HalfWidthUnder(1.01 * 8e3 / 7.0), 16e3);
  EXPECT_EQ(kSmall.HalfWidthUnder(400e3), 32e3) << "no further";
  std::vector<double> widths_m;
  GroundFollower follower({}, nullptr, {8e3, 32});
  follower.SetGround([&](const Place& place, double half_width_m, int most_samples) {
    widths_m.push_back(half_width_m);
    return RangeAround(place, half_width_m, most_samples);
  });
  auto view = ViewFrom(kFollowedPlace, 30.0);
  for (const double height_m : {1000.0, 1200.0, 1100.0, 800.0}) {
    view.eye.height_m = height_m;
    static_cast<void>(follower.WaitUntilReady(Air(), view));
  }
  EXPECT_EQ(widths_m, (std::vector{8e3, 16e3, 8e3})) << "at 1100 m that of 1200 m is kept";
}

TEST(GroundFollower, LightIsComputedAgainOnlyForAnotherSun) {
  GroundFollower follower({}, nullptr, kSmall);
  follower.SetGround(RangeAround);
  static_cast<void>(follower.WaitUntilReady(Air(), ViewFrom(kFollowedPlace, 30.0)));
  const auto first = follower.lit();
  EXPECT_FALSE(follower.WaitUntilReady(Air(), ViewFrom(kFollowedPlace, 30.02)))
      << "a thirteenth of the disk";
  EXPECT_EQ(follower.lit(), first);
  EXPECT_TRUE(follower.WaitUntilReady(Air(), ViewFrom(kFollowedPlace, 20.0)));
  EXPECT_NE(follower.lit(), first);
  EXPECT_EQ(&follower.lit()->site(), &first->site()) << "horizons are kept";
}

TEST(GroundFollower, LightIsComputedForTheFutureSun) {
  const GroundFollower::View before = ViewFrom(kFollowedPlace, 5.0),
                             now = ViewFrom(kFollowedPlace, 4.9);
  const auto elevation_deg = [](const GroundFollower::View& view) {
    return std::asin(view.by.direction.seen.z) / kRadiansPerDegree;
  };
  const LightDirection ahead = Ahead(before, now, 20.0).by.direction;
  EXPECT_NEAR(std::asin(ahead.seen.z) / kRadiansPerDegree, 2.9, 1e-9);
  EXPECT_NEAR(std::asin(ahead.for_air.z) / kRadiansPerDegree, 2.9, 1e-9);
  EXPECT_NEAR(std::atan2(ahead.seen.x, ahead.seen.y), 4.0 - 2.0 * kPi, 1e-9);
  EXPECT_NEAR(elevation_deg(Ahead(before, now, 1e4)), -5.1, 0.1) << "no further than ten degrees";
  EXPECT_EQ(Ahead(ViewFrom(kFollowedPlace, 40.0), now, 20.0).by.direction, now.by.direction)
      << "time has jumped";
}

// --- shade of the terrain ---

const Place kShadePlace{46.5, 8.0, 0.0};
constexpr int kShadeUnit = 3;

Place Eye(double degrees_north) {
  return {kShadePlace.latitude_deg + degrees_north, kShadePlace.longitude_deg, 900.0};
}

DistantLight SunAtDegrees(double elevation) { return SunAt(elevation, 2.0); }

/// A mountain at the place, whoever asks from near; counts how often it was asked.
GroundSampler Mountain(std::atomic<int>& asked) {
  return [&asked](const Place& place, double half_width_m, int most_samples) {
    ++asked;
    ElevationGrid grid;
    grid.columns = grid.rows = most_samples;
    const double half_rad = half_width_m / 6.37e6;
    grid.step_lat_rad = 2.0 * half_rad / (most_samples - 1);
    grid.step_lon_rad = grid.step_lat_rad / std::cos(place.latitude_rad());
    grid.north_rad = place.latitude_rad() + half_rad;
    grid.west_rad = place.longitude_rad() - half_rad / std::cos(place.latitude_rad());
    for (int row = 0; row < grid.rows; ++row) {
      for (int column = 0; column < grid.columns; ++column) {
        const double y = (grid.LatitudeOfRow(row) - kShadePlace.latitude_rad()) * 6.37e6;
        const double x = (grid.LongitudeOfColumn(column) - kShadePlace.longitude_rad()) * 4.38e6;
        grid.height_m.push_back(static_cast<float>(2000.0 * std::exp(-1e-7 * (x * x + y * y))));
      }
    }
    return std::optional<ElevationGrid>(std::move(grid));
  };
}

class ShadeFollowerTest : public tests::Headless {
 protected:
  static constexpr ShadeSize kSmall{20e3, 201, 2, 256};
  std::atomic<int> requested_{0};
};

TEST_F(ShadeFollowerTest, WithoutGroundThereIsNoShade) {
  ShadeFollower follower(kWgs84);
  follower.WaitUntilReady(Eye(0.0), SunAtDegrees(5.0), kShadeUnit);
  EXPECT_FALSE(follower.shade().Shades());
  follower.SetGround(
      [](const Place&, double, int) -> std::optional<ElevationGrid> { return std::nullopt; });
  follower.WaitUntilReady(Eye(0.0), SunAtDegrees(5.0), kShadeUnit);
  EXPECT_FALSE(follower.shade().Shades());
}

TEST_F(ShadeFollowerTest, GroundIsRequestedAgainOnlyWhenTheEyeHasLeftIt) {
  ShadeFollower follower(kWgs84);
  follower.SetSize(kSmall);
  follower.SetGround(Mountain(requested_));
  follower.WaitUntilReady(Eye(0.0), SunAtDegrees(5.0), kShadeUnit);
  ASSERT_TRUE(follower.shade().Shades());
  const glm::dvec3 first_sun = follower.shade().map().to_light;
  follower.WaitUntilReady(Eye(0.01), SunAtDegrees(5.0 + 0.04), kShadeUnit);
  EXPECT_EQ(follower.shade().map().to_light, first_sun) << "a sixth of the disk's radius";
  follower.WaitUntilReady(Eye(0.01), SunAtDegrees(4.0), kShadeUnit);
  EXPECT_NEAR(follower.shade().map().to_light.z, std::sin(4.0 * kRadiansPerDegree), 1e-3)
      << "of another sun, in the frame of a kilometre away";
  EXPECT_EQ(requested_, 1);
  follower.WaitUntilReady(Eye(0.08), SunAtDegrees(4.0), kShadeUnit);
  EXPECT_EQ(requested_, 2) << "nine kilometres of twenty";
  follower.SetGround(Mountain(requested_));
  follower.WaitUntilReady(Eye(0.08), SunAtDegrees(4.0), kShadeUnit);
  EXPECT_EQ(requested_, 3) << "other ground";
}

TEST_F(ShadeFollowerTest, MapIsCentredBelowTheEye) {
  ShadeFollower follower(kWgs84);
  follower.SetSize(kSmall);
  follower.SetGround(Mountain(requested_));
  follower.WaitUntilReady(Eye(0.0), SunAtDegrees(5.0), kShadeUnit);
  ASSERT_TRUE(follower.shade().Shades());
  const glm::dmat4 here = follower.MapFromEye(Eye(0.0));
  EXPECT_NEAR(glm::length(glm::dvec3(here[3]) - glm::dvec3(0.0, 0.0, 900.0)), 0.0, 1e-6);
  const glm::dvec3 north = follower.MapFromEye(Eye(0.01))[3];
  EXPECT_NEAR(north.y, 1112.0, 2.0) << "a hundredth of a degree of latitude";
  EXPECT_NEAR(north.z, 900.0 - 0.5 * 1112.0 * 1112.0 / 6.37e6, 0.01) << "round the earth";
}

TEST_F(ShadeFollowerTest, MapsFollowASunThatMovesFasterThanTheyAreMade) {
  ShadeFollower follower(kWgs84);
  follower.SetSize(kSmall);
  follower.SetGround(Mountain(requested_));
  double elevation = 2.0;
  int maps = 0;
  glm::dvec3 last(0.0);
  while (maps < 4) {
    elevation += elevation < 40.0 ? 0.06 : -38.0;  // more than a fifth of the radius every frame
    follower.Follow(Eye(0.0), SunAtDegrees(elevation), 1.0, kShadeUnit);
    if (follower.shade().Shades() && follower.shade().map().to_light != last) {
      last = follower.shade().map().to_light;
      ++maps;
    }
    std::this_thread::yield();
  }
  SUCCEED() << "else it would not have come to an end";
}

TEST_F(ShadeFollowerTest, MapsOfALightThatBringsLittleMayBeOlder) {
  constexpr double kRadius_deg = 0.267;
  ShadeFollower follower(kWgs84);
  follower.SetSize(kSmall);
  follower.SetGround(Mountain(requested_));
  follower.WaitUntilReady(Eye(0.0), SunAtDegrees(5.0), kShadeUnit);
  const glm::dvec3 first = follower.shade().map().to_light;
  const auto map_after = [&](double share, double moved_radii) {
    follower.Follow(Eye(0.0), SunAtDegrees(5.0 + moved_radii * kRadius_deg), share, kShadeUnit);
    // Suits the first map, but no map that Follow has requested.
    follower.WaitUntilReady(Eye(0.0), SunAtDegrees(5.0 + 0.15 * kRadius_deg), kShadeUnit);
    return follower.shade().map().to_light;
  };
  EXPECT_EQ(map_after(0.1, 1.9), first) << "two radii";
  EXPECT_EQ(map_after(0.4, 0.45), first) << "0.2 radii over the share";
  EXPECT_NE(map_after(0.4, 0.55), first);
}

}  // namespace
}  // namespace alpenglow::viewer
