// SPDX-License-Identifier: MIT
#include "viewer/shade/shafts.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <thread>

#include "atmosphere/math/constants.h"
#include "tests/viewer/shaders/headless.h"

namespace alpenglow::viewer {
namespace {

const GeodeticPosition kPlace = PlaceFromDegrees(46.5, 8.0, 0.0);
constexpr int kUnit = 3;

GeodeticPosition Eye(double degrees_north) {
  return {kPlace.latitude_rad + degrees_north * kRadiansPerDegree, kPlace.longitude_rad, 900.0};
}

SunPosition SunAtDegrees(double elevation) {
  SunPosition sun{};
  sun.elevation_rad = elevation * kRadiansPerDegree;
  sun.azimuth_rad = 2.0;
  sun.angular_radius_rad = 0.00465;
  return sun;
}

/// A mountain at the place, whoever asks from near; counts how often it was asked.
GroundSampler Mountain(std::atomic<int>& asked) {
  return [&asked](const GeodeticPosition& place, double half_width_m, int most_samples) {
    ++asked;
    ElevationGrid grid;
    grid.columns = grid.rows = most_samples;
    const double half_rad = half_width_m / 6.37e6;
    grid.step_lat_rad = 2.0 * half_rad / (most_samples - 1);
    grid.step_lon_rad = grid.step_lat_rad / std::cos(place.latitude_rad);
    grid.north_rad = place.latitude_rad + half_rad;
    grid.west_rad = place.longitude_rad - half_rad / std::cos(place.latitude_rad);
    for (int row = 0; row < grid.rows; ++row) {
      for (int column = 0; column < grid.columns; ++column) {
        const double y = (grid.LatitudeOfRow(row) - kPlace.latitude_rad) * 6.37e6;
        const double x = (grid.LongitudeOfColumn(column) - kPlace.longitude_rad) * 4.38e6;
        grid.height_m.push_back(static_cast<float>(2000.0 * std::exp(-1e-7 * (x * x + y * y))));
      }
    }
    return std::optional<ElevationGrid>(std::move(grid));
  };
}

class ShadeFollowerTest : public tests::Headless {
 protected:
  static constexpr ShadeSize kSmall{20e3, 201, 2, 256};
  std::atomic<int> asked_{0};
};

TEST_F(ShadeFollowerTest, WithoutGroundThereIsNoShade) {
  ShadeFollower follower(kWgs84);
  follower.WaitUntilReady(Eye(0.0), SunAtDegrees(5.0), kUnit);
  EXPECT_FALSE(follower.shade().Shades());
  follower.SetGround([](const GeodeticPosition&, double, int) -> std::optional<ElevationGrid> {
    return std::nullopt;
  });
  follower.WaitUntilReady(Eye(0.0), SunAtDegrees(5.0), kUnit);
  EXPECT_FALSE(follower.shade().Shades());
}

TEST_F(ShadeFollowerTest, GroundIsAskedForAnewOnlyWhenTheEyeHasLeftIt) {
  ShadeFollower follower(kWgs84);
  follower.SetSize(kSmall);
  follower.SetGround(Mountain(asked_));
  follower.WaitUntilReady(Eye(0.0), SunAtDegrees(5.0), kUnit);
  ASSERT_TRUE(follower.shade().Shades());
  const glm::dvec3 first_sun = follower.shade().map().to_sun;
  follower.WaitUntilReady(Eye(0.01), SunAtDegrees(5.0 + 0.04), kUnit);
  EXPECT_EQ(follower.shade().map().to_sun, first_sun) << "a sixth of the disk's radius";
  follower.WaitUntilReady(Eye(0.01), SunAtDegrees(4.0), kUnit);
  EXPECT_NEAR(follower.shade().map().to_sun.z, std::sin(4.0 * kRadiansPerDegree), 1e-3)
      << "of another sun, in the frame of a kilometre away";
  EXPECT_EQ(asked_, 1);
  follower.WaitUntilReady(Eye(0.08), SunAtDegrees(4.0), kUnit);
  EXPECT_EQ(asked_, 2) << "nine kilometres of twenty";
  follower.SetGround(Mountain(asked_));
  follower.WaitUntilReady(Eye(0.08), SunAtDegrees(4.0), kUnit);
  EXPECT_EQ(asked_, 3) << "other ground";
}

TEST_F(ShadeFollowerTest, TheMapLiesUnderTheEye) {
  ShadeFollower follower(kWgs84);
  follower.SetSize(kSmall);
  follower.SetGround(Mountain(asked_));
  follower.WaitUntilReady(Eye(0.0), SunAtDegrees(5.0), kUnit);
  ASSERT_TRUE(follower.shade().Shades());
  const glm::dmat4 here = follower.MapFromEye(Eye(0.0));
  EXPECT_NEAR(glm::length(glm::dvec3(here[3]) - glm::dvec3(0.0, 0.0, 900.0)), 0.0, 1e-6);
  const glm::dvec3 north = follower.MapFromEye(Eye(0.01))[3];
  EXPECT_NEAR(north.y, 1112.0, 2.0) << "a hundredth of a degree of latitude";
  EXPECT_NEAR(north.z, 900.0 - 0.5 * 1112.0 * 1112.0 / 6.37e6, 0.01) << "round the earth";
}

TEST_F(ShadeFollowerTest, ASunThatOutrunsTheMapsIsStillFollowed) {
  ShadeFollower follower(kWgs84);
  follower.SetSize(kSmall);
  follower.SetGround(Mountain(asked_));
  double elevation = 2.0;
  int maps = 0;
  glm::dvec3 last(0.0);
  while (maps < 4) {
    elevation += elevation < 40.0 ? 0.06 : -38.0;  // more than a fifth of the radius every frame
    follower.Follow(Eye(0.0), SunAtDegrees(elevation), kUnit);
    if (follower.shade().Shades() && follower.shade().map().to_sun != last) {
      last = follower.shade().map().to_sun;
      ++maps;
    }
    std::this_thread::yield();
  }
  SUCCEED() << "else it would not have come to an end";
}

}  // namespace
}  // namespace alpenglow::viewer
