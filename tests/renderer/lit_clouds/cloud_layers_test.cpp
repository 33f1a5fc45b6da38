// SPDX-License-Identifier: MIT
#include "renderer/lit_clouds/cloud_layers.h"

#include <gtest/gtest.h>

#include "renderer/scene/scene_clouds.h"
#include "tests/fixtures/bare_scene.h"
#include "tests/fixtures/directions.h"

namespace alpenglow::renderer {
namespace {

constexpr double kPlanetRadius_m = 6.371e6;

/// Cumulus with tops below 3 km and a short period over bare ground.
CloudsByTime FairClouds() {
  Scene scene = QuickScene(2.0, 0.0, 0.0, 60.0);
  scene.time = TimeFromText("2026-06-21T10:00:00Z");
  scene.clouds = CloudsFromText("cumulus 0.3");
  scene.clouds.front().options.period_m = 2560.0;
  return {scene, 0.0, kPlanetRadius_m};
}

CloudsByTime::Light LightAt(double elevation_deg, double eye_altitude_m = 2.0) {
  return {tests::DirectionAt(elevation_deg, 20.0), eye_altitude_m};
}

bool IsSolvedFor(CloudsByTime& clouds, const CloudsByTime::Light& light) {
  const auto solved = clouds.At(TimeFromText("2026-06-21T10:00:00Z"), light);
  const CloudLight& first = solved->light.front();
  EXPECT_EQ(first.sun_moments().sweeps == 0, first.sun().IsUnlit());
  EXPECT_GT(first.sky_moments().down_at_base, 0.0) << "the light of the sky is always solved";
  return !first.sun().IsUnlit();
}

// From the ground, tops at 3 km at the horizon see a sun at -2 * 1.76 degrees and refraction.
TEST(CloudsByTime, NoSunIsSolvedThatNoCloudInSightSees) {
  CloudsByTime clouds = FairClouds();
  EXPECT_TRUE(IsSolvedFor(clouds, LightAt(40.0)));
  EXPECT_TRUE(IsSolvedFor(clouds, LightAt(-3.0)));
  EXPECT_FALSE(IsSolvedFor(clouds, LightAt(-5.5)));
  EXPECT_TRUE(IsSolvedFor(clouds, LightAt(-5.5, 400e3))) << "from space clouds far away are lit";
  EXPECT_FALSE(IsSolvedFor(clouds, LightAt(-60.0, 400e3)));
}

TEST(CloudsByTime, EyesAtOtherHeightsShareTheSolution) {
  CloudsByTime clouds = FairClouds();
  const UtcTime time = TimeFromText("2026-06-21T10:00:00Z");
  const auto by_day = clouds.At(time, LightAt(40.0));
  EXPECT_EQ(clouds.At(time, LightAt(40.0, 9000.0)), by_day);
  const auto by_night = clouds.At(time, LightAt(-20.0));
  EXPECT_EQ(clouds.At(time, LightAt(-20.0, 9000.0)), by_night);
  EXPECT_NE(clouds.At(time, LightAt(-20.0, 4e6)), by_night);
}

}  // namespace
}  // namespace alpenglow::renderer
