// SPDX-License-Identifier: MIT
#include "renderer/cloud_light/cloud_low_sun.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "renderer/cloud_light/cloud_path_tracer.h"
#include "renderer/cloud_light/cloud_sun_depths.h"
#include "renderer/layer.h"
#include "tests/fixtures/directions.h"
#include "tests/fixtures/sphere_clouds.h"

namespace alpenglow::renderer {
namespace {

constexpr double kRadius_m = 6.371e6;

glm::dvec3 LowSunAt(double elevation_deg, double azimuth_deg = 20.0) {
  return tests::DirectionAt(elevation_deg, azimuth_deg);
}

/// Returns the length of a straight ray between two altitudes over a sphere, by steps.
double LengthInShell(double altitude_m, double elevation_deg, double low_m, double high_m) {
  constexpr double kStep_m = 5.0;
  const double e = elevation_deg * kRadiansPerDegree;
  double length_m = 0.0;
  for (double at = 0.5 * kStep_m; at < 4e5; at += kStep_m) {
    const double along = at * std::cos(e), up = kRadius_m + altitude_m + at * std::sin(e);
    const double here_m = std::hypot(along, up) - kRadius_m;
    if (here_m >= low_m && here_m < high_m) length_m += kStep_m;
  }
  return length_m;
}

TEST(CloudLowSun, PlaneLayerHasTheOpticalDepthOverASphere) {
  // 1e-4 per m, so that depths stay below 32.
  const CloudField field = tests::PlaneLayer(0.04);
  for (const double elevation_deg : {3.0, 1.0, 0.0, -0.5, -1.0, -2.0}) {
    const CloudLowSun sun(field, LowSunAt(elevation_deg));
    for (const double altitude_m : {200.0, 1001.0, 1200.0, 1399.0, 4000.0}) {
      const double exact = 1e-4 * LengthInShell(altitude_m, elevation_deg, 1000.0, 1400.0);
      // Over 150 km, the next term of the altitude moves the borders of the layer by up to 100 m of
      // ground, and the ground at its own altitude is 2e-4 shorter.
      EXPECT_NEAR(sun.OpticalDepth({0.0, 0.0, altitude_m}), exact, 0.01 + 0.003 * exact)
          << elevation_deg << " degrees at " << altitude_m << " m";
    }
  }
}

TEST(CloudLowSun, SunSetsWhereThePlaneBends) {
  const CloudField field = tests::PlaneLayer(0.04);
  const glm::dvec3 to_sun = LowSunAt(1.0, 90.0);
  const CloudLowSun sun(field, to_sun);
  // 111.2 km away from the sun it is a degree lower.
  const double degree_m = kRadius_m * kRadiansPerDegree;
  const CloudLowSun there(field, LowSunAt(0.0, 90.0), {.place_m = {0.0, -degree_m}});
  EXPECT_NEAR(sun.OpticalDepth({0.0, -degree_m, 1100.0}),
              there.OpticalDepth({0.0, -degree_m, 1100.0}), 1e-6)
      << "the same beam but for rounding";
}

TEST(CloudLowSun, MeanIsThatOfPathsOverALevelPlane) {
  const CloudField field = tests::SphereClouds(0.02);
  for (const double elevation_deg : {4.0, 1.5}) {
    const glm::dvec3 to_sun = LowSunAt(elevation_deg);
    const CloudLowSun sun(field, to_sun, {.planet_radius_m = 1e9});
    const CloudPathTracer tracer(field, {CloudPhases(PhaseFunction{})}, {.to_sun = to_sun});

    double followed = 0.0, traced = 0.0, square = 0.0;
    constexpr int kPoints = 3000;
    for (int i = 1; i <= kPoints; ++i) {
      const glm::dvec3 point =
          glm::dvec3(0.0, 0.0, 1000.0) +
          glm::dvec3(1280.0 * Halton(i, 2), 1280.0 * Halton(i, 3), 480.0 * Halton(i, 5));
      const double exact = std::exp(-sun.OpticalDepth(point));
      CloudPathTracer::PathRandom random(1, 2, static_cast<std::uint64_t>(i));
      const double difference = tracer.SunTransmittance(point, random) - exact;
      followed += exact / kPoints;
      traced += difference / kPoints;
      square += difference * difference / kPoints;
    }
    EXPECT_NEAR(traced, 0.0, 4.0 * std::sqrt(square / kPoints) + 0.003)
        << "noise of paths, and steps of 20 m; mean " << followed;
    EXPECT_GT(followed, 0.01);
  }
}

TEST(CloudLowSun, TransmittanceByPathsFollowsTheSameBeam) {
  const CloudField field = tests::SphereClouds(0.004);
  const CloudLowSun sun(field, LowSunAt(-1.0), {.farthest_m = 3e5, .full_m = 1e5});

  double exact = 0.0, traced = 0.0, square = 0.0;
  constexpr int kPoints = 2000;
  for (int i = 1; i <= kPoints; ++i) {
    const glm::dvec3 point(1280.0 * Halton(i, 2), 1280.0 * Halton(i, 3),
                           1000.0 + 480.0 * Halton(i, 5));
    const double depth_light = std::exp(-sun.OpticalDepth(point));
    CloudPathTracer::PathRandom random(3, 4, static_cast<std::uint64_t>(i));
    const double difference = sun.Transmittance(point, random) - depth_light;
    exact += depth_light / kPoints;
    traced += difference / kPoints;
    square += difference * difference / kPoints;
  }
  EXPECT_NEAR(traced, 0.0, 4.0 * std::sqrt(square / kPoints) + 0.003) << exact;
  EXPECT_GT(exact, 0.003);
}

// The beam of a sun at -1 degree leaves the layer at once, and returns 222 km away.
TEST(CloudLowSun, BeamsEndWhereTheyAreToldTo) {
  const CloudField field = tests::PlaneLayer(0.04);
  const glm::dvec3 base(0.0, 0.0, 1000.0);
  EXPECT_EQ(CloudLowSun(field, LowSunAt(-1.0), {.farthest_m = 120e3}).OpticalDepth(base), 0.0);
  EXPECT_GT(CloudLowSun(field, LowSunAt(-1.0)).OpticalDepth(base), 1.0);
}

// The beam returns after 222.4 km, where (300 - 222.4) / (300 - 60) of the beams meet clouds.
TEST(CloudLowSun, FewerBeamsMeetCloudsWithTheDistance) {
  const glm::dvec3 base(0.0, 0.0, 1000.0);
  for (const double optical_depth : {0.0004, 0.04, 40.0}) {
    const CloudField field = tests::PlaneLayer(optical_depth);
    const double whole = std::exp(-CloudLowSun(field, LowSunAt(-1.0)).OpticalDepth(base));
    const CloudLowSun fewer(field, LowSunAt(-1.0), {.farthest_m = 300e3, .full_m = 60e3});
    EXPECT_NEAR(1.0 - std::exp(-fewer.OpticalDepth(base)), 0.3233 * (1.0 - whole), 2e-4);
  }
}

TEST(CloudLowSun, PeriodicDepthsAreThoseOverThePlace) {
  const CloudField field = tests::SphereClouds(0.004);
  const CloudLowSun sun(field, LowSunAt(1.0));
  const glm::dvec3 here(0.0, 0.0, 1100.0), period(1280.0, 0.0, 0.0);
  EXPECT_DOUBLE_EQ(sun.OpticalDepthAsAtPlace(here), sun.OpticalDepth(here));
  EXPECT_NEAR(sun.OpticalDepthAsAtPlace(here + 50.0 * period), sun.OpticalDepth(here), 1e-6);
  const double degrees =
      50.0 * 1280.0 * std::cos(20.0 * kRadiansPerDegree) / kRadius_m / kRadiansPerDegree;
  EXPECT_NEAR(sun.ToSunAt(here + 50.0 * period).z, std::sin((1.0 + degrees) * kRadiansPerDegree),
              1e-9);
}

// A layer is above the points or below them.
TEST(CloudSunDepths, MeanOfAPlaneLayerIsThatOfItsBeams) {
  const CloudField field = tests::PlaneLayer(0.04);
  const CloudSunDepths low(field, LowSunAt(2.0)), high(field, LowSunAt(30.0));
  for (const double altitude_m : {100.0, 1000.0, 2000.0}) {
    const glm::dvec3 point(10.0, 20.0, altitude_m);
    EXPECT_NEAR(low.MeanTransmittance(altitude_m), low.Transmittance(point), 2e-4)
        << "the plane is not level at the point, and the map has values of 12 bits";
    EXPECT_NEAR(high.MeanTransmittance(altitude_m), high.Transmittance(point), 1e-6);
  }
}

TEST(CloudSunDepths, MapAndBeamsAgreeWhereTheyMeet) {
  const CloudField field = tests::SphereClouds(0.05);
  const CloudSunDepths map(field, LowSunAt(3.0)), beams(field, LowSunAt(2.99));
  EXPECT_NE(map.map(), nullptr);
  EXPECT_EQ(beams.map(), nullptr);
  EXPECT_GT(map.bytes(), 0U);
  double by_map = 0.0, by_beams = 0.0;
  constexpr int kPoints = 4000;
  for (int i = 1; i <= kPoints; ++i) {
    const glm::dvec3 point(1280.0 * Halton(i, 2), 1280.0 * Halton(i, 3),
                           1000.0 + 480.0 * Halton(i, 5));
    by_map += map.Transmittance(point) / kPoints;
    by_beams += beams.Transmittance(point) / kPoints;
  }
  // The planet bends by 6 m over the 9 km that a beam stays in the layer, and the maps have cells of
  // 20 m and 50 m.
  EXPECT_NEAR(by_map, by_beams, 0.03 * by_beams);
}

TEST(CloudLowSun, RefusesSunsAndOptionsOutOfRange) {
  const CloudField field = tests::SphereClouds(0.05);
  EXPECT_THROW(CloudLowSun(field, LowSunAt(-4.1)), InputError);
  EXPECT_THROW(CloudLowSun(field, LowSunAt(10.1)), InputError);
  EXPECT_THROW(CloudLowSun(field, {1.0, 0.0, 1.0}), InputError);
  EXPECT_THROW(CloudLowSun(field, LowSunAt(1.0), {.planet_radius_m = 1.0}), InputError);
  EXPECT_THROW(CloudLowSun(field, LowSunAt(1.0), {.step_m = std::nan("")}), InputError);
  EXPECT_THROW(CloudLowSun(field, LowSunAt(1.0), {.farthest_m = 5e5}), InputError);
  EXPECT_THROW(CloudLowSun(field, LowSunAt(1.0), {.full_m = -1.0}), InputError);
  EXPECT_THROW(CloudSunDepths(field, LowSunAt(-5.0)), InputError);
}

}  // namespace
}  // namespace alpenglow::renderer
