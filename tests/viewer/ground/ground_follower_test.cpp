// SPDX-License-Identifier: MIT
#include "renderer/picture/ground_follower.h"

#include <gtest/gtest.h>

#include "atmosphere/math/constants.h"
#include "renderer/procedural_mountains/procedural_mountains.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {
namespace {

const GeodeticPosition kFollowedPlace = PlaceFromDegrees(46.5, 8.0, 0.0);
constexpr GroundExtent kSmall{8e3, 128};

GroundFollower::View ViewFrom(const GeodeticPosition& place, double elevation_deg) {
  GroundFollower::View view{place, ParseInstant("2026-06-21T12:00:00Z"), LightSource::kSun, {}};
  view.eye.height_m = 1500.0;
  view.by.elevation_rad = elevation_deg * kRadiansPerDegree;
  view.by.azimuth_rad = 4.0;
  view.by.angular_radius_rad = 0.00465;
  view.by.distance_au = 1.0;
  return view;
}

/// What lies around a place of the built-in range, every `stride`-th sample.
std::optional<ElevationGrid> RangeAround(const GeodeticPosition& place, double half_width_m,
                                         int most_samples) {
  static const ElevationGrid range = ProceduralMountains(kFollowedPlace);
  if (!range.Covers(place.latitude_rad, place.longitude_rad)) return std::nullopt;
  ElevationGrid around;
  around.columns = around.rows = most_samples;
  around.step_lat_rad = 2.0 * half_width_m / 6.37e6 / (most_samples - 1);
  around.step_lon_rad = around.step_lat_rad / std::cos(place.latitude_rad);
  around.north_rad = place.latitude_rad + half_width_m / 6.37e6;
  around.west_rad = place.longitude_rad - 0.5 * (most_samples - 1) * around.step_lon_rad;
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
  static const auto air =
      SolveAir(OnOsculatingSphere(MediumPreset("bruneton2017"), kFollowedPlace.latitude_rad),
               AirSolution::kDraft);
  return air;
}

TEST(GroundFollower, WithoutLandThereIsNoLight) {
  GroundFollower follower({}, nullptr, kSmall);
  static_cast<void>(follower.WaitUntilReady(Air(), ViewFrom(kFollowedPlace, 30.0)));
  EXPECT_EQ(follower.lit(), nullptr);
  EXPECT_FALSE(follower.Light());
  follower.SetGround(
      [](const GeodeticPosition&, double, int) -> std::optional<ElevationGrid> { return {}; });
  static_cast<void>(follower.WaitUntilReady(Air(), ViewFrom(kFollowedPlace, 30.0)));
  EXPECT_EQ(follower.lit(), nullptr) << "no land around here";
}

TEST(GroundFollower, ASeaWithoutLandMirrorsTheSky) {
  GroundCover sea;
  sea.kind = GroundCover::Kind::kWater;
  GroundFollower follower(sea, nullptr, kSmall);
  EXPECT_TRUE(follower.WaitUntilReady(Air(), ViewFrom(kFollowedPlace, 30.0)));
  EXPECT_EQ(follower.lit(), nullptr);
  ASSERT_EQ(follower.sea_mirror(LightSource::kSun).size(), SeaMirror::kSide * SeaMirror::kSide);
  for (const BandTexel& texel : follower.sea_mirror(LightSource::kSun)) EXPECT_GT(texel[1], 0.0F);
}

TEST(GroundFollower, OnTheRangeThereIsLightOfTheSunThatWasAskedFor) {
  GroundFollower follower({}, nullptr, kSmall);
  follower.SetGround(RangeAround);
  EXPECT_TRUE(follower.WaitUntilReady(Air(), ViewFrom(kFollowedPlace, 30.0)));
  ASSERT_NE(follower.lit(), nullptr);
  EXPECT_NEAR(follower.lit()->lighting().to_sun.z, 0.5, 1e-3) << "30 degrees high";
  EXPECT_GT(follower.making_s(), 0.0);
  const std::optional<LightOfVertices> light = follower.Light();
  ASSERT_TRUE(light);
  GeodeticPosition foot = kFollowedPlace;
  LandVertex vertex{};
  vertex.normal = {0.0F, 0.0F, 1.0F};
  vertex.position_m = {0.0F, 0.0F,
                       static_cast<float>(RangeAround(kFollowedPlace, 100.0, 3)->height_m[4])};
  const std::vector<VertexLight> lit = light->at(LocalFrame(kWgs84, foot), {&vertex, 1});
  ASSERT_EQ(lit.size(), 1U);
  EXPECT_GT(lit[0].sky[0], 0.0F) << "level ground sees the sky";
}

TEST(GroundFollower, AHigherEyeHasLightOnLandFurtherOff) {
  EXPECT_EQ(kSmall.HalfWidthUnder(0.0), 8e3);
  EXPECT_EQ(kSmall.HalfWidthUnder(8e3 / 7.0), 8e3);
  EXPECT_EQ(kSmall.HalfWidthUnder(1.01 * 8e3 / 7.0), 16e3);
  EXPECT_EQ(kSmall.HalfWidthUnder(400e3), 32e3) << "no further";
  std::vector<double> widths_m;
  GroundFollower follower({}, nullptr, {8e3, 32});
  follower.SetGround([&](const GeodeticPosition& place, double half_width_m, int most_samples) {
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

TEST(GroundFollower, LightIsMadeAnewForAnotherSunAndNotForTheSame) {
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

TEST(GroundFollower, ARunningSunIsMetWhereItWillStand) {
  GroundFollower::View before = ViewFrom(kFollowedPlace, 5.0), now = ViewFrom(kFollowedPlace, 4.9);
  before.by.azimuth_rad = 6.2831;
  now.by.azimuth_rad = 1e-5;
  const SunPosition ahead = Ahead(before, now, 20.0).by;
  EXPECT_NEAR(ahead.elevation_rad / kRadiansPerDegree, 2.9, 1e-9);
  const double step_rad = 2.0 * kPi + 1e-5 - 6.2831;
  EXPECT_NEAR(ahead.azimuth_rad, 1e-5 + 20.0 * step_rad, 1e-9) << "over the north";
  EXPECT_NEAR(Ahead(before, now, 1e4).by.elevation_rad / kRadiansPerDegree, -5.1, 0.1)
      << "no further than ten degrees";
  EXPECT_EQ(Ahead(ViewFrom(kFollowedPlace, 40.0), now, 20.0).by.elevation_rad, now.by.elevation_rad)
      << "time has jumped";
}

}  // namespace
}  // namespace alpenglow::viewer
