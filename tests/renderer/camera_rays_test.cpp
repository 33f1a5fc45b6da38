// SPDX-License-Identifier: MIT
#include "renderer/camera_rays.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/constants.h"

namespace alpenglow {
namespace {

constexpr double kTolerance = 1e-12;

void ExpectDirection(const glm::dvec3& actual, const glm::dvec3& expected) {
  EXPECT_NEAR(actual.x, expected.x, kTolerance);
  EXPECT_NEAR(actual.y, expected.y, kTolerance);
  EXPECT_NEAR(actual.z, expected.z, kTolerance);
}

TEST(CameraRays, CentreOfThePictureLooksAlongHeadingAndPitch) {
  const CameraRays east(CameraFromDegrees({}, 90.0, 0.0, 0.0, 60.0), 200, 100);
  ExpectDirection(east.Direction(100.0, 50.0), {1.0, 0.0, 0.0});
  const CameraRays up(CameraFromDegrees({}, 0.0, 90.0, 0.0, 60.0), 200, 100);
  ExpectDirection(up.Direction(100.0, 50.0), {0.0, 0.0, 1.0});
}

TEST(CameraRays, RightOfAPictureLookingNorthIsEast) {
  const CameraRays north(CameraFromDegrees({}, 0.0, 0.0, 0.0, 90.0), 200, 100);
  const double half = std::sqrt(0.5);
  ExpectDirection(north.Direction(200.0, 50.0), {half, half, 0.0});
  EXPECT_GT(north.Direction(100.0, 0.0).z, 0.0) << "rows count downwards";
}

TEST(CameraRays, RollOfNinetyDegreesLaysTheHorizonUpright) {
  // Rolled clockwise, the right edge of the picture looks down.
  const CameraRays rolled(CameraFromDegrees({}, 0.0, 0.0, 90.0, 90.0), 200, 100);
  const double half = std::sqrt(0.5);
  ExpectDirection(rolled.Direction(200.0, 50.0), {0.0, half, -half});
}

TEST(CameraRays, PanoramaHasTheHeadingInItsCentreAndTheZenithOnTop) {
  const CameraRays all(CameraFromDegrees({}, 0.0, 0.0, 0.0, 360.0), 360, 180);
  ExpectDirection(all.Direction(180.0, 90.0), {0.0, 1.0, 0.0});
  ExpectDirection(all.Direction(270.0, 90.0), {1.0, 0.0, 0.0});
  ExpectDirection(all.Direction(0.0, 90.0), {0.0, -1.0, 0.0});
  ExpectDirection(all.Direction(123.0, 0.0), {0.0, 0.0, 1.0});
}

TEST(CameraRays, DirectionsAreUnitVectorsForEveryFieldOfView) {
  for (const double fov : {0.1, 1.0, 60.0, 179.0, 360.0}) {
    const CameraRays rays(CameraFromDegrees({}, 33.0, -20.0, 10.0, fov), 7, 5);
    for (int y = 0; y <= 5; ++y) {
      for (int x = 0; x <= 7; ++x)
        EXPECT_NEAR(glm::length(rays.Direction(x, y)), 1.0, kTolerance) << fov;
    }
  }
}

}  // namespace
}  // namespace alpenglow
