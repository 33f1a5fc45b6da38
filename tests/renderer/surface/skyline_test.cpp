// SPDX-License-Identifier: MIT
#include "renderer/surface/skyline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/math/constants.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {
namespace {

const glm::dvec3 kLeaningUp = glm::normalize(glm::dvec3(0.02, -0.01, 1.0));
constexpr double kStep_rad = 0.002;

/// Ridges around an eye, by azimuth from the frame's x over y.
double RidgeAt(double azimuth_rad) {
  return 0.1 + 0.08 * std::sin(3.0 * azimuth_rad) + 0.02 * std::sin(40.0 * azimuth_rad);
}

double ElevationOf(const glm::dvec3& direction) {
  return std::asin(std::clamp(glm::dot(direction, kLeaningUp), -1.0, 1.0));
}

bool SeesSky(const glm::dvec3& direction) {
  return ElevationOf(direction) > RidgeAt(Skyline::AzimuthOf(direction, kLeaningUp));
}

/// Directions over the sphere, as many as tell.
template <typename Visit>
void VisitDirections(const Visit& visit) {
  for (double azimuth = -3.1; azimuth < 3.1; azimuth += 0.037) {
    for (double elevation = -0.3; elevation < 1.5; elevation += 0.0173) {
      visit(glm::dvec3(std::cos(elevation) * std::cos(azimuth),
                       std::cos(elevation) * std::sin(azimuth), std::sin(elevation)));
    }
  }
}

TEST(Skyline, WhatIsOverItSeesSkyAllAround) {
  constexpr double kAround_rad = 0.02;
  const Skyline skyline(kLeaningUp, {0.0, 2.0 * kPi}, kStep_rad, SeesSky);
  int over = 0;
  VisitDirections([&](const glm::dvec3& direction) {
    if (!skyline.IsBelow(direction, kAround_rad)) return;
    ++over;
    const glm::dvec3 a = glm::normalize(glm::cross(direction, glm::dvec3(0.6, 0.7, 0.4)));
    const glm::dvec3 b = glm::cross(direction, a);
    for (double turn = 0.0; turn < 2.0 * kPi; turn += 0.4) {
      const glm::dvec3 beside = std::cos(turn) * a + std::sin(turn) * b;
      EXPECT_TRUE(SeesSky(glm::normalize(direction + std::tan(0.99 * kAround_rad) * beside)));
    }
  });
  EXPECT_GT(over, 1000) << "most of the sky";
}

TEST(Skyline, SkyThatIsFarOverItIsKnownToBe) {
  const Skyline skyline(kLeaningUp, {0.0, 2.0 * kPi}, kStep_rad, SeesSky);
  VisitDirections([&](const glm::dvec3& direction) {
    if (ElevationOf(direction) < 0.25) return;
    EXPECT_TRUE(skyline.IsBelow(direction, 0.02)) << "0.03 over the highest ridge";
  });
}

TEST(Skyline, NothingIsKnownBesideItsArc) {
  const Skyline skyline(kLeaningUp, {-0.5, 1.0}, kStep_rad, SeesSky);
  const auto at = [&](double azimuth) {
    return glm::dvec3(std::cos(0.4) * std::cos(azimuth), std::cos(0.4) * std::sin(azimuth),
                      std::sin(0.4));
  };
  EXPECT_TRUE(skyline.IsBelow(at(0.0), 0.01));
  EXPECT_TRUE(skyline.IsBelow(at(0.4), 0.01));
  EXPECT_FALSE(skyline.IsBelow(at(0.6), 0.01));
  EXPECT_FALSE(skyline.IsBelow(at(kPi), 0.01));
}

}  // namespace
}  // namespace alpenglow::renderer
