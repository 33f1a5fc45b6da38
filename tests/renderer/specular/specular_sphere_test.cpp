// SPDX-License-Identifier: MIT
// Rays that meet spheres: closed forms of Fresnel, Snell, lenses and rainbows, and refusals.
#include "renderer/specular/specular_sphere.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <random>

#include "atmosphere/math/constants.h"
#include "tests/fixtures/fault_of.h"

namespace alpenglow::renderer {
namespace {

using testing::HasSubstr;

/// Returns the divided ray that enters a sphere around the origin at a distance b from the axis along +x.
DividedRay RayAt(const SpecularSphere& sphere, double b) {
  return {sphere, {-std::sqrt(sphere.radius_m * sphere.radius_m - b * b), b, 0.0}, {1.0, 0.0, 0.0}};
}

TEST(SpecularSphere, RefusesValuesOutsideTheirRange) {
  const auto fault = [](const SpecularSphere& sphere) {
    return tests::FaultOf([&] {
      Validate(sphere);
      return 0;
    });
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double radius_m : {0.0, -1.0, nan, std::numeric_limits<double>::infinity()})
    EXPECT_THAT(fault({.radius_m = radius_m}), HasSubstr("radius_m is "));
  for (const double index : {0.99, 0.0, 4.1, nan})
    EXPECT_THAT(fault({.index = index}), HasSubstr("index is ")) << index;
  EXPECT_EQ(fault({.radius_m = 2.0, .index = 1.0}), "no fault");
}

TEST(SpecularSphere, IsEnteredFromOutsideOnly) {
  const SpecularSphere sphere{.centre = {10.0, 0.0, 0.0}, .radius_m = 2.0};
  const glm::dvec3 ahead{1.0, 0.0, 0.0};
  EXPECT_NEAR(DistanceTo(sphere, {0.0, 0.0, 0.0}, ahead).value(), 8.0, 1e-12);
  EXPECT_FALSE(DistanceTo(sphere, {0.0, 0.0, 0.0}, -ahead)) << "it is behind";
  EXPECT_FALSE(DistanceTo(sphere, {0.0, 2.001, 0.0}, ahead)) << "it is beside";
  EXPECT_FALSE(DistanceTo(sphere, {10.5, 0.0, 0.0}, ahead)) << "the ray starts inside";
  EXPECT_FALSE(DistanceTo(sphere, {12.0, 0.0, 0.0}, ahead)) << "the ray leaves it";
  // From a million kilometres, a difference of squares would have lost all digits of the radius.
  EXPECT_NEAR(DistanceTo(sphere, {-1e9, 1.2, 0.0}, ahead).value(), 1e9 + 8.4, 1e-6);
}

TEST(SpecularSphere, ReflectsByFresnelAtKnownAngles) {
  const SpecularSphere glass{.index = 1.5};
  EXPECT_NEAR(RayAt(glass, 0.0).Share(0), 0.04, 1e-12) << "((n - 1) / (n + 1))^2";
  EXPECT_NEAR(RayAt(glass, 0.0).Share(1), 0.96 * 0.96, 1e-12);
  // At Brewster's angle only light across the plane of incidence is reflected: by
  // ((n^2 - 1) / (n^2 + 1))^2.
  const double across = (1.25 / 3.25) * (1.25 / 3.25);
  EXPECT_NEAR(RayAt(glass, std::sin(std::atan(1.5))).Share(0), 0.5 * across, 1e-12);
  EXPECT_NEAR(RayAt(glass, 1.0 - 1e-12).Share(0), 1.0, 1e-4) << "grazing";
  EXPECT_NEAR(RayAt({.index = 1.0}, 0.7).Share(1), 1.0, 1e-12) << "no sphere at all";
}

TEST(SpecularSphere, KeepsThePowerOfARay) {
  for (const double index : {1.0, 1.33, 1.5, 2.4}) {
    for (const double b : {0.0, 0.3, 0.9, 0.99}) {
      const DividedRay divided = RayAt({.index = index}, b);
      double sum = 0.0;
      for (int order = 0; order < 400; ++order) sum += divided.Share(order);
      EXPECT_NEAR(sum, 1.0, 1e-9) << index << " " << b;
    }
  }
  EXPECT_EQ(RayAt({.material = SphereMaterial::kMirror}, 0.3).Share(0), 1.0);
  EXPECT_EQ(RayAt({.material = SphereMaterial::kMirror}, 0.3).Share(1), 0.0);
}

TEST(SpecularSphere, LosesLittleLightInOrdersThatAreNotSampled) {
  // The mean over the cross-section, by the midpoint rule in b^2.
  constexpr int kRings = 20000;
  double lost = 0.0;
  for (int i = 0; i < kRings; ++i) {
    const DividedRay divided = RayAt({.index = 1.5}, std::sqrt((i + 0.5) / kRings));
    double sum = 0.0;
    for (int order = 0; order <= DividedRay::kMostOrder; ++order) sum += divided.Share(order);
    lost += (1.0 - sum) / kRings;
  }
  EXPECT_LT(lost, 1e-4);
}

TEST(SpecularSphere, SamplesOrdersByTheirPower) {
  const DividedRay divided = RayAt({.index = 1.8}, 0.95);
  std::array<int, 4> counts{};
  constexpr int kDraws = 10000;
  for (int i = 0; i < kDraws; ++i) {
    const auto order = divided.SampleOrder((i + 0.5) / kDraws);
    if (order && *order < 4) ++counts[static_cast<std::size_t>(*order)];
  }
  for (int order = 0; order < 4; ++order) {
    // Even numbers fall into an interval of their share, to within one of them.
    EXPECT_NEAR(counts[static_cast<std::size_t>(order)], kDraws * divided.Share(order), 1.01);
  }
}

TEST(SpecularSphere, FocusesParaxialRaysLikeABallLens) {
  // The focal length of a ball lens, from its centre: n R / (2 (n - 1)).
  for (const double index : {1.33, 1.5, 1.9}) {
    const SpecularSphere ball{.radius_m = 2.0, .index = index};
    const LeavingRay ray = RayAt(ball, 1e-4).Leaving(1);
    const double focus_m = ray.origin.x - ray.origin.y * ray.direction.x / ray.direction.y;
    // Spherical aberration at this height is below (1e-4 / 2)^2.
    EXPECT_NEAR(focus_m, index * 2.0 / (2.0 * (index - 1.0)), 1e-7) << index;
  }
}

TEST(SpecularSphere, DeviatesByTwiceTheDifferenceOfAngles) {
  for (const double b : {-0.8, 0.1, 0.5, 0.999}) {
    const DividedRay divided = RayAt({.index = 1.5}, b);
    const double i = std::asin(std::abs(b)), r = std::asin(std::abs(b) / 1.5);
    EXPECT_NEAR(divided.Deviation(1), 2.0 * (i - r), 1e-12);
    for (int order = 0; order < 5; ++order) {
      const glm::dvec3 direction = divided.Leaving(order).direction;
      EXPECT_NEAR(direction.x, std::cos(divided.Deviation(order)), 1e-12);
      EXPECT_NEAR(glm::length(direction), 1.0, 1e-12);
    }
  }
}

TEST(SpecularSphere, HasTheRainbowAngleOfWater) {
  // Descartes: the least deviation of order 2 is where cos^2 i = (n^2 - 1) / 3: 137.97 degrees for
  // n = 4/3.
  double least = 10.0;
  for (int i = 0; i <= 100000; ++i) {
    const double deviation =
        std::abs(RayAt({.index = 4.0 / 3.0}, 1e-5 * i * 0.999999).Deviation(2));
    least = std::min(least, deviation);
  }
  EXPECT_NEAR(least / kRadiansPerDegree, 137.97, 0.005);
}

TEST(SpecularSphere, RaysArePathsOfSnellStepByStep) {
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  const SpecularSphere sphere{.centre = {3.0, -2.0, 7.0}, .radius_m = 4.0, .index = 1.7};
  for (int i = 0; i < 200; ++i) {
    const glm::dvec3 outward =
        glm::normalize(glm::dvec3(number(engine), number(engine), number(engine) + 1e-3));
    glm::dvec3 direction =
        glm::normalize(glm::dvec3(number(engine), number(engine), number(engine) + 1e-3));
    if (glm::dot(direction, outward) > 0.0) direction = -direction;
    const glm::dvec3 point = sphere.centre + sphere.radius_m * outward;
    const DividedRay divided(sphere, point, direction);
    EXPECT_LT(glm::length(divided.Leaving(0).direction - glm::reflect(direction, outward)), 1e-12);
    glm::dvec3 inside = glm::refract(direction, outward, 1.0 / sphere.index), place = point;
    for (int order = 1; order < 5; ++order) {
      place -= 2.0 * glm::dot(place - sphere.centre, inside) * inside;
      const glm::dvec3 inward = (sphere.centre - place) / sphere.radius_m;
      const LeavingRay ray = divided.Leaving(order);
      // Grazing chords are short differences of the sphere's radius.
      EXPECT_LT(glm::length(ray.origin - place), 1e-10);
      // Near the critical angle refraction loses half of the digits.
      EXPECT_LT(glm::length(ray.direction - glm::refract(inside, inward, sphere.index)), 1e-6);
      inside = glm::reflect(inside, inward);
    }
  }
}

TEST(SpecularSphere, RaysThroughItsCentreGoOn) {
  const DividedRay divided = RayAt({.radius_m = 3.0}, 0.0);
  EXPECT_LT(glm::length(divided.Leaving(0).direction - glm::dvec3(-1.0, 0.0, 0.0)), 1e-12);
  EXPECT_LT(glm::length(divided.Leaving(1).origin - glm::dvec3(3.0, 0.0, 0.0)), 1e-12);
  EXPECT_LT(glm::length(divided.Leaving(1).direction - glm::dvec3(1.0, 0.0, 0.0)), 1e-12);
}

}  // namespace
}  // namespace alpenglow::renderer
