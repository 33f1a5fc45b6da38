// SPDX-License-Identifier: MIT
#include "renderer/media/glow_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <memory>
#include <utility>
#include <vector>

#include "atmosphere/math/constants.h"
#include "renderer/media/local_volume.h"
#include "tests/fixtures/media.h"
#include "tests/fixtures/noise_grid.h"
#include "tests/fixtures/sanitized.h"

namespace alpenglow::renderer {
namespace {

/// Returns a body that absorbs and glows, over the origin.
LocalVolume Fire(VolumePlacement::Shape shape, const glm::dvec3& size_m, double absorption_per_m,
                 std::shared_ptr<const VolumeGrid> grid = nullptr) {
  MediumOptics optics{SpectrumOf<double>(1), SpectrumOf<double>(1), SpectrumOf<double>(1),
                      tests::LobeOf(0.5)};
  optics.extinction_per_m[0] = absorption_per_m;
  optics.emission_per_m[0] = 3.0 * absorption_per_m;
  VolumePlacement placement;
  placement.shape = shape;
  placement.size_m = size_m;
  placement.across = {std::cos(0.4), -std::sin(0.4), 0.0};
  placement.ahead = {std::sin(0.4), std::cos(0.4), 0.0};
  return {placement, std::nullopt, std::move(grid), optics};
}

GlowField FieldOf(const LocalVolume& fire) {
  return {fire, [&](const glm::dvec3&) -> GlowField::SourceAt {
            Spectrum light(1);
            light[0] = static_cast<float>(fire.optics().emission_per_m[0]);
            return [light, &fire](const glm::dvec3&) {
              return GlowField::Source{light, fire.optics().extinction_per_m};
            };
          }};
}

bool SeesAll(const glm::dvec3&) { return true; }

/// Returns the irradiance as an integral over the directions of the upper half space of a surface: the
/// radiance along each ray is summed in small steps.
double IntegratedGlow(const LocalVolume& fire, const glm::dvec3& point, const glm::dvec3& normal,
                      int rays) {
  const glm::dvec3 to_fire = fire.Middle() - point;
  const double distance_m = glm::length(to_fire);
  const double radius_m = 0.5 * glm::length(fire.placement().size_m);
  // The body fills a cone around its middle; nearby it fills the whole sphere.
  const double least_cosine =
      distance_m > radius_m ? std::sqrt(1.0 - std::pow(radius_m / distance_m, 2.0)) : -1.0;
  const glm::dvec3 axis = to_fire / distance_m;
  const glm::dvec3 helper = std::abs(axis.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
  const glm::dvec3 x = glm::normalize(glm::cross(helper, axis)), y = glm::cross(axis, x);
  const double solid_angle = 2.0 * kPi * (1.0 - least_cosine) / (rays * rays);
  double sum = 0.0;
  for (int i = 0; i < rays * rays; ++i) {
    const double cosine = 1.0 - (1.0 - least_cosine) * (i % rays + 0.5) / rays;
    const double phi = 2.0 * kPi * (i / rays + 0.5) / rays;
    const double sine = std::sqrt(1.0 - cosine * cosine);
    const glm::dvec3 way = cosine * axis + sine * (std::cos(phi) * x + std::sin(phi) * y);
    const double weight = glm::dot(way, normal) * solid_angle;
    if (weight <= 0.0) continue;
    // The source function is 3 everywhere, so the radiance follows from the column.
    const double depth = fire.optics().extinction_per_m[0] * fire.Column(point, way, 1e5);
    sum += weight * 3.0 * -std::expm1(-depth);
  }
  return sum;
}

/// Expects irradiance near that of the integral from half the longest side off the box on.
void ExpectIntegrated(const LocalVolume& fire, double error) {
  const GlowField field = FieldOf(fire);
  const glm::dvec3& size_m = fire.placement().size_m;
  const double half_m = 0.5 * std::max({size_m.x, size_m.y, size_m.z});
  const int rays = tests::ScaledDown(240, 100);
  for (const double off : {1.0, 1.5, 3.0, 10.0, 100.0}) {
    for (const double turn : {0.3, 1.4, 2.9, 4.0, 5.5}) {
      const glm::dvec3 level{std::cos(turn), std::sin(turn), 0.0};
      // The distance from the middle at which the box is half_m away.
      const double reach = glm::length(0.5 * size_m) + off * half_m;
      const glm::dvec3 point(reach * level.x, reach * level.y, 0.0);
      for (const glm::dvec3& normal :
           {glm::dvec3(0.0, 0.0, 1.0), glm::normalize(glm::dvec3(0.0, 0.0, 0.4) - level)}) {
        const double exact = IntegratedGlow(fire, point, normal, rays);
        EXPECT_NEAR(static_cast<double>(field.On(point, normal, SeesAll)[0]) / exact, 1.0, error)
            << off << ", " << turn << ", " << normal.z;
      }
    }
  }
}

TEST(GlowField, ThinBodiesHaveTheIrradianceOfTheIntegral) {
  ExpectIntegrated(Fire(VolumePlacement::Shape::kEllipsoid, {10.0, 20.0, 30.0}, 0.001), 0.03);
  ExpectIntegrated(Fire(VolumePlacement::Shape::kBox, {20.0, 20.0, 20.0}, 0.001), 0.03);
}

TEST(GlowField, DeepBodiesHaveTheIrradianceOfTheIntegral) {
  ExpectIntegrated(Fire(VolumePlacement::Shape::kEllipsoid, {10.0, 20.0, 30.0}, 0.3), 0.05);
  ExpectIntegrated(Fire(VolumePlacement::Shape::kBox, {20.0, 20.0, 20.0}, 0.5), 0.05);
}

TEST(GlowField, OpaqueSlabsAreTooBrightNearTheirPlane) {
  ExpectIntegrated(Fire(VolumePlacement::Shape::kBox, {20.0, 30.0, 5.0}, 5.0), 0.25);
}

TEST(GlowField, TurbulentFireHasTheIrradianceOfTheIntegral) {
  ExpectIntegrated(Fire(VolumePlacement::Shape::kBox, {20.0, 20.0, 40.0}, 0.2,
                        tests::NoiseGrid(tests::ScaledDown(40, 16), 4.0, 0.1, 3)),
                   0.03);
}

TEST(GlowField, FarAwayItIsALampOfItsIntensity) {
  const LocalVolume ball = Fire(VolumePlacement::Shape::kEllipsoid, glm::dvec3(20.0), 1e-6);
  const GlowField field = FieldOf(ball);
  EXPECT_LT(glm::length(field.middle() - ball.Middle()), 0.05);
  const double intensity = 3e-6 * 4.0 / 3.0 * kPi * 1000.0;
  const double found =
      1e6 * static_cast<double>(field.On({1e3, 0.0, 10.0}, {-1.0, 0.0, 0.0}, SeesAll)[0]);
  EXPECT_NEAR(found / intensity, 1.0, 0.01) << "chords of 18 rays along each side";
}

TEST(GlowField, SurfacesThatFaceAwayAndHiddenOnesAreDark) {
  const LocalVolume ball = Fire(VolumePlacement::Shape::kEllipsoid, glm::dvec3(20.0), 0.1);
  const GlowField field = FieldOf(ball);
  EXPECT_EQ(field.On({30.0, 0.0, 10.0}, {1.0, 0.0, 0.0}, SeesAll)[0], 0.0F);
  const auto none = [](const glm::dvec3&) { return false; };
  EXPECT_EQ(field.On({30.0, 0.0, 10.0}, {-1.0, 0.0, 0.0}, none)[0], 0.0F);
  const auto upper = [](const glm::dvec3& place) { return place.z > 10.0; };
  const float all = field.On({15.0, 0.0, 10.0}, {-1.0, 0.0, 0.0}, SeesAll)[0];
  EXPECT_NEAR(static_cast<double>(field.On({15.0, 0.0, 10.0}, {-1.0, 0.0, 0.0}, upper)[0] / all),
              0.5, 0.02)
      << "eight parts are tested, of which four lie above the middle";
}

TEST(GlowField, PointsInsideHaveFiniteLight) {
  const LocalVolume ball = Fire(VolumePlacement::Shape::kEllipsoid, glm::dvec3(20.0), 0.1);
  const GlowField field = FieldOf(ball);
  for (int i = 0; i < 400; ++i) {
    const glm::dvec3 point(0.05 * i - 10.0, 0.0, 10.0);
    const auto light = static_cast<double>(field.On(point, {0.0, 0.0, 1.0}, SeesAll)[0]);
    EXPECT_GE(light, 0.0);
    EXPECT_LE(light, 3.0 * kPi) << "nothing is brighter than the source function";
  }
}

TEST(GlowField, ExtremeBodiesHaveFiniteLight) {
  for (const glm::dvec3& size_m :
       {glm::dvec3(0.01), glm::dvec3(2e5), glm::dvec3(2e5, 0.01, 30.0)}) {
    for (const double absorption_per_m : {1e-30, 1e4}) {
      const LocalVolume body = Fire(VolumePlacement::Shape::kBox, size_m, absorption_per_m * 1e8);
      const GlowField field = FieldOf(body);
      for (const double off_m : {0.0, 0.005, 1.0, 1e7}) {
        const float light = field.On({off_m, off_m, 0.0}, {0.0, 0.0, 1.0}, SeesAll)[0];
        EXPECT_TRUE(std::isfinite(light) && light >= 0.0F) << size_m.x << ", " << off_m;
      }
    }
  }
}

TEST(GlowField, CountsFewTestsOfSight) {
  const LocalVolume ball = Fire(VolumePlacement::Shape::kEllipsoid, glm::dvec3(20.0), 0.1);
  const GlowField field = FieldOf(ball);
  for (const double distance_m : {11.0, 15.0, 40.0, 4000.0}) {
    int tests = 0;
    (void)field.On({distance_m, 0.0, 10.0}, {-1.0, 0.0, 0.0}, [&](const glm::dvec3&) {
      ++tests;
      return true;
    });
    EXPECT_LE(tests, distance_m > 100.0 ? 1 : 8) << distance_m;
  }
}

}  // namespace
}  // namespace alpenglow::renderer
