// SPDX-License-Identifier: MIT
#include "renderer/camera/camera_rays.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/math/constants.h"

namespace alpenglow::renderer {
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

// Hard case 44.
TEST(CameraRays, RollOfNinetyDegreesLaysTheHorizonUpright) {
  // Rolled clockwise, the right edge of the picture looks down.
  const CameraRays rolled(CameraFromDegrees({}, 0.0, 0.0, 90.0, 90.0), 200, 100);
  const double half = std::sqrt(0.5);
  ExpectDirection(rolled.Direction(200.0, 50.0), {0.0, half, -half});
}

TEST(CameraRays, APolariserTurnsWithTheCameraAndAbsorbsAlongOneAxisOfItsSheet) {
  const auto camera = [](double roll, double polariser) {
    Camera with = CameraFromDegrees({}, 0.0, 0.0, roll, 90.0);
    with.polariser_rad = polariser * kRadiansPerDegree;
    return CameraRays(with, 200, 100);
  };
  EXPECT_FALSE(CameraRays(CameraFromDegrees({}, 0.0, 0.0, 0.0, 90.0), 2, 2).PassedBy({0, 1, 0}));
  const glm::dvec3 north{0.0, 1.0, 0.0};
  ExpectDirection(*camera(0.0, 0.0).PassedBy(north), {0.0, 0.0, 1.0});
  ExpectDirection(*camera(0.0, 90.0).PassedBy(north), {1.0, 0.0, 0.0});
  const double half = std::sqrt(0.5);
  ExpectDirection(*camera(0.0, 45.0).PassedBy(north), {half, 0.0, half});
  ExpectDirection(*camera(45.0, 0.0).PassedBy(north), {half, 0.0, half});
  const CameraRays rays = camera(0.0, 30.0);
  const glm::dvec3 absorbed(std::cos(30.0 * kRadiansPerDegree), 0.0, -0.5);
  const glm::dvec3 oblique = rays.Direction(190.0, 5.0);
  EXPECT_NEAR(glm::dot(*rays.PassedBy(oblique), oblique), 0.0, kTolerance);
  EXPECT_NEAR(glm::dot(*rays.PassedBy(oblique), absorbed), 0.0, kTolerance);
  const PictureAxes axes = rays.AxesAt(oblique);
  EXPECT_NEAR(glm::dot(axes.up, oblique), 0.0, kTolerance);
  ExpectDirection(glm::cross(oblique, axes.up), axes.right);
}

TEST(CameraRays, PanoramaHasTheHeadingInItsCentreAndTheZenithOnTop) {
  const CameraRays all(CameraFromDegrees({}, 0.0, 0.0, 0.0, 360.0), 360, 180);
  ExpectDirection(all.Direction(180.0, 90.0), {0.0, 1.0, 0.0});
  ExpectDirection(all.Direction(270.0, 90.0), {1.0, 0.0, 0.0});
  ExpectDirection(all.Direction(0.0, 90.0), {0.0, -1.0, 0.0});
  ExpectDirection(all.Direction(123.0, 0.0), {0.0, 0.0, 1.0});
}

TEST(CameraRays, APlaceInThePictureIsFoundBackFromItsDirection) {
  for (const double fov : {1.0, 60.0, 170.0, 360.0}) {
    const CameraRays rays(CameraFromDegrees({}, 33.0, -20.0, 10.0, fov), 70, 50);
    for (double y = 0.5; y < 50.0; y += 7.0) {
      for (double x = 0.5; x < 70.0; x += 7.0) {
        const auto place = rays.PlaceOf(rays.Direction(x, y));
        ASSERT_TRUE(place.has_value());
        EXPECT_NEAR((*place)[0], x, 1e-9) << fov;
        EXPECT_NEAR((*place)[1], y, 1e-9) << fov;
      }
    }
  }
  const CameraRays north(CameraFromDegrees({}, 0.0, 0.0, 0.0, 60.0), 200, 100);
  EXPECT_FALSE(north.PlaceOf({0.0, -1.0, 0.0}).has_value()) << "behind the camera";
}

// Hard case 44.
TEST(CameraRays, DirectionsAreUnitVectorsForEveryFieldOfView) {
  for (const double fov : {0.1, 1.0, 60.0, 179.0, 360.0}) {
    const CameraRays rays(CameraFromDegrees({}, 33.0, -20.0, 10.0, fov), 7, 5);
    for (int y = 0; y <= 5; ++y) {
      for (int x = 0; x <= 7; ++x)
        EXPECT_NEAR(glm::length(rays.Direction(x, y)), 1.0, kTolerance) << fov;
    }
  }
}

constexpr double kFocal_m = 0.085, kFNumber = 1.4, kFocus_m = 12.0;

CameraRays LensCamera(int blades = 0) {
  Camera camera = CameraFromDegrees({}, 33.0, -20.0, 10.0, 24.0);
  camera.lens = ThinLens{kFNumber, kFocal_m, kFocus_m, blades, 0.2};
  return {camera, 300, 200, {{5.0, -7.0, 100.0}}};
}

TEST(CameraRays, RaysOfALensMeetInThePlaneOfFocus) {
  const CameraRays camera = LensCamera();
  const glm::dvec3 ahead = camera.Direction(150.0, 100.0);
  for (const auto& [x, y] : {std::array{10.0, 20.0}, {150.0, 100.0}, {299.0, 199.0}}) {
    const glm::dvec3 middle = camera.Direction(x, y);
    const glm::dvec3 in_focus = camera.eye() + kFocus_m / glm::dot(middle, ahead) * middle;
    for (const double u : {0.05, 0.35, 0.8}) {
      const CameraRay ray = camera.Ray(x, y, {u, 0.9});
      EXPECT_NEAR(glm::length(ray.origin - camera.eye()),
                  0.5 * kFocal_m / kFNumber * std::sqrt(0.9), kTolerance);
      EXPECT_NEAR(glm::dot(ray.origin - camera.eye(), ahead), 0.0, kTolerance);
      const glm::dvec3 offset = in_focus - ray.origin;
      EXPECT_NEAR(glm::length(offset - glm::dot(offset, ray.direction) * ray.direction), 0.0, 1e-9);
    }
  }
}

TEST(CameraRays, BlurOnTheSensorIsTheCircleOfConfusion) {
  const CameraRays camera = LensCamera();
  const glm::dvec3 ahead = camera.Direction(150.0, 100.0);
  // Behind the lens at v stands a sensor of width 2 v tan(fov / 2).
  const double v = kFocal_m * kFocus_m / (kFocus_m - kFocal_m);
  for (const double z : {2.0, 11.0, 12.0, 40.0, 1e5}) {
    const double circle_m =
        kFocal_m / kFNumber * std::abs(z - kFocus_m) / z * kFocal_m / (kFocus_m - kFocal_m);
    EXPECT_NEAR(2.0 * camera.BlurRadius(z * ahead) * v, circle_m, 1e-12) << z;
    // The rays of one point of the picture are spread as much at that depth.
    const CameraRay edge = camera.Ray(150.0, 100.0, {0.0, 1.0});
    const glm::dvec3 there =
        edge.origin + z / glm::dot(edge.direction, ahead) * edge.direction - camera.eye();
    EXPECT_NEAR(glm::length(there - z * ahead) / z * v, 0.5 * circle_m, 1e-12) << z;
  }
}

TEST(CameraRays, APinholeBlursNothing) {
  const CameraRays camera(CameraFromDegrees({}, 90.0, 0.0, 0.0, 60.0), 200, 100);
  EXPECT_EQ(camera.BlurRadius({5.0, 0.0, 0.0}), 0.0);
  const CameraRay ray = camera.Ray(30.0, 40.0, {0.3, 0.9});
  EXPECT_EQ(ray.origin, camera.eye());
  EXPECT_EQ(ray.direction, camera.Direction(30.0, 40.0));
}

TEST(CameraRays, BlurKeepsTheLightOfAPoint) {
  const double soft = 0.9 * LensCamera().PixelAngle();
  for (const int blades : {0, 5, 6}) {
    const CameraRays camera = LensCamera(blades);
    for (const double z : {3.0, 11.8, 12.0, 30.0, 1000.0}) {
      const glm::dvec3 point = z * (camera.Direction(170.0, 90.0) / 0.98);
      double sum = 0.0;
      constexpr int kSub = 8;
      for (int y = 60 * kSub; y < 120 * kSub; ++y) {
        for (int x = 140 * kSub; x < 200 * kSub; ++x) {
          const glm::dvec3 way = camera.Direction((x + 0.5) / kSub, (y + 0.5) / kSub);
          const auto blur = camera.BlurAt(point, way, soft);
          if (!blur) continue;
          const double cosine = glm::dot(way, camera.Direction(150.0, 100.0));
          sum += blur->per_sr * std::pow(camera.PixelAngle() / kSub, 2) * std::pow(cosine, 3);
        }
      }
      EXPECT_NEAR(sum, 1.0, 0.01) << blades << " blades at " << z << ", 64 points a pixel";
    }
  }
}

TEST(CameraRays, ThePointOfTheLensThatSeesABlurredPointLooksThroughTheSamePointInFocus) {
  const CameraRays camera = LensCamera(5);
  const glm::dvec3 ahead = camera.Direction(150.0, 100.0);
  for (const double z : {3.0, 300.0}) {
    const glm::dvec3 point = z * camera.Direction(150.0, 100.0);
    const glm::dvec3 way = camera.Direction(151.0, 100.8);
    // Softened by next to nothing, so that the lens is not drawn wider than it is.
    const auto blur = camera.BlurAt(point, way, 1e-9);
    ASSERT_TRUE(blur) << z;
    const glm::dvec3 in_focus = camera.eye() + kFocus_m / glm::dot(way, ahead) * way;
    const glm::dvec3 a = glm::normalize(point - blur->on_lens);
    const glm::dvec3 b = glm::normalize(in_focus - camera.eye() - blur->on_lens);
    EXPECT_NEAR(glm::length(glm::cross(a, b)), 0.0, 1e-6) << z;
    EXPECT_NEAR(glm::dot(blur->on_lens, ahead), 0.0, 1e-9) << z;
  }
}

}  // namespace
}  // namespace alpenglow::renderer
