// SPDX-License-Identifier: MIT
#include "renderer/lit_clouds/mirrored_clouds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/math/constants.h"

namespace alpenglow::renderer {
namespace {

constexpr double kMirrorRadius_m = 6.371e6;

/// A sky whose light depends on the direction alone.
CloudChange ByDirection(const glm::dvec3&, const glm::dvec3& direction) {
  return {Spectrum(1, static_cast<float>(direction.z)),
          Spectrum(1, static_cast<float>(1.0 + direction.x))};
}

glm::dvec3 Direction(double azimuth_rad, double elevation_rad) {
  return {std::cos(elevation_rad) * std::cos(azimuth_rad),
          std::cos(elevation_rad) * std::sin(azimuth_rad), std::sin(elevation_rad)};
}

// The formula is for distances that are short relative to the radius: at 10 km they are up to a
// twentieth of it.
TEST(MirroredClouds, RaysLeaveTheMirrorAsTheyCameFromTheEye) {
  for (const double height_m : {2.0, 300.0, 10000.0}) {
    const glm::dvec3 centre(0.0, 0.0, -kMirrorRadius_m), eye(0.0, 0.0, height_m);
    int traced = 0;
    const MirroredClouds mirror(
        {glm::dvec3(0.0), {0.0, 0.0, 1.0}, height_m, kMirrorRadius_m},
        [&](const glm::dvec3& point, const glm::dvec3& direction) {
          const glm::dvec3 up = glm::normalize(point - centre);
          const glm::dvec3 incident = glm::normalize(point - eye);
          const glm::dvec3 reflected = incident - 2.0 * glm::dot(incident, up) * up;
          EXPECT_NEAR(glm::length(point - centre), kMirrorRadius_m, 1e-3);
          EXPECT_LT(glm::length(direction - reflected), height_m < 1000.0 ? 1e-3 : 4e-3);
          ++traced;
          return ByDirection(point, direction);
        });
    for (const double elevation_rad : {0.02, 0.1, 0.5, 1.0, 1.5})
      (void)mirror.Towards(Direction(0.7, elevation_rad), {0.0, 0.0, 1.0});
    EXPECT_GE(traced, 20) << "four entries around each direction";
    const int before = traced;
    (void)mirror.Towards(Direction(0.7, 0.5), {0.0, 0.0, 1.0});
    EXPECT_EQ(traced, before) << "entries are kept";
  }
}

TEST(MirroredClouds, LightIsLinearBetweenEntries) {
  const MirroredClouds mirror({glm::dvec3(0.0), {0.0, 0.0, 1.0}, 10.0, kMirrorRadius_m},
                              ByDirection);
  for (int i = 0; i < 200; ++i) {
    const glm::dvec3 direction = Direction(-3.1 + 0.031 * i, 0.02 + 0.0075 * i);
    const CloudChange change = mirror.Towards(direction, {0.0, 0.0, 1.0});
    // Entries are up to 2.8 degrees apart: a sine is within 0.049^2 / 8 of its chord.
    EXPECT_NEAR(static_cast<double>(change.left[0]), direction.z, 5e-4) << i;
    EXPECT_NEAR(static_cast<double>(change.added[0]), 1.0 + direction.x, 5e-4) << i;
  }
}

}  // namespace
}  // namespace alpenglow::renderer
