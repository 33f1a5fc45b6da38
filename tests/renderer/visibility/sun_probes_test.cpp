// SPDX-License-Identifier: MIT
#include "renderer/visibility/sunlit_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <random>

#include "atmosphere/math/constants.h"
#include "renderer/visibility/shadow_heights.h"

namespace alpenglow::renderer {
namespace {

constexpr double kSunRadius = 0.265 * kRadiansPerDegree;

glm::dvec3 EasternSun(double elevation_deg) {
  const double elevation = elevation_deg * kRadiansPerDegree;
  return {std::cos(elevation), 0.0, std::sin(elevation)};
}

// A level slab from x = -50 to 50 and y = -500 to 500, 200 m up, facing up: a bridge over a plain.
TriangleMesh Bridge(bool with_plain) {
  TriangleMesh mesh;
  const auto add = [&](float x, float y, float z) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const float sx : {-1.0F, 1.0F}) {
      for (const float sy : {-1.0F, 1.0F}) mesh.positions.push_back({sx * x, sy * y, z});
    }
    mesh.triangles.push_back({first, first + 2, first + 1});
    mesh.triangles.push_back({first + 1, first + 2, first + 3});
  };
  add(50.0F, 500.0F, 200.0F);
  if (with_plain) add(5000.0F, 5000.0F, 0.0F);
  mesh.normals.assign(mesh.positions.size(), {0.0F, 0.0F, 1.0F});
  return mesh;
}

TEST(SunProbes, LightPassesUnderABridge) {
  const Terrain terrain(Bridge(true));
  const SunProbes probes(terrain, EasternSun(45.0), kSunRadius, 64);
  // 100 m over the plain the slab's shadow lies 100 m to the west.
  const SunlitPath path = probes.Along({-1000.0, 0.0, 100.0}, {1.0, 0.0, 0.0}, 2000.0);
  ASSERT_FALSE(path.empty());
  EXPECT_NEAR(SunlightAt(path, 1000.0 - 160.0), 1.0, 1e-9);
  EXPECT_NEAR(SunlightAt(path, 1000.0 - 100.0), 0.0, 1e-9);
  EXPECT_NEAR(SunlightAt(path, 1000.0 - 40.0), 1.0, 1e-9) << "under the bridge";
  EXPECT_NEAR(SunlightAt(path, 1000.0 - 150.0), 0.5, 0.2) << "its edge, halved to half a metre";
}

TEST(SunProbes, HalfShadeIsAsWideAsTheDisk) {
  const Terrain terrain(Bridge(true));
  const SunProbes probes(terrain, EasternSun(45.0), kSunRadius, 256);
  const SunlitPath path = probes.Along({-1000.0, 0.0, 100.0}, {1.0, 0.0, 0.0}, 1000.0);
  ASSERT_GE(path.size(), 2U);
  // The slab's western edge, 141 m away along the beam; a ray across it.
  const double half_m = 100.0 * 2.0 * std::tan(kSunRadius);
  EXPECT_NEAR(path[0].end_m, 850.0 - half_m, 0.3);
  EXPECT_NEAR(path[1].end_m, 850.0 + half_m, 0.3);
}

TEST(SunProbes, AirThatNoBeamOverTerrainReachesIsNotProbed) {
  const Terrain terrain(Bridge(false));
  const SunProbes probes(terrain, EasternSun(10.0), kSunRadius);
  EXPECT_EQ(probes.Along({0.0, 0.0, 300.0}, {0.0, 0.0, 1.0}, 1e5), (SunlitPath{{0.0, 1e5}}));
  EXPECT_EQ(probes.Along({100.0, 0.0, 10.0}, {1.0, 0.0, 0.0}, 1e5), (SunlitPath{{0.0, 1e5}}));
  EXPECT_TRUE(probes.Along({0.0, 0.0, 300.0}, {0.0, 0.0, 1.0}, 0.0).empty());
}

TEST(SunProbes, AnOverhangIsNoOneSurface) {
  EXPECT_TRUE(IsOneSurface(Terrain(Bridge(false))));
  EXPECT_FALSE(IsOneSurface(Terrain(Bridge(true)))) << "the plain cannot be seen from above";
  TriangleMesh wall = Bridge(false);
  wall.positions.push_back({0.0F, 0.0F, 0.0F});
  wall.positions.push_back({0.0F, 10.0F, 0.0F});
  wall.positions.push_back({0.0F, 0.0F, 10.0F});
  wall.normals.assign(wall.positions.size(), {0.0F, 0.0F, 1.0F});
  wall.triangles.push_back({4, 5, 6});
  EXPECT_FALSE(IsOneSurface(Terrain(wall)));
}

TEST(SunProbes, OverOneSurfaceTheyAgreeWithShadowHeights) {
  TriangleMesh mesh = Bridge(false);
  mesh.positions = {{-3000.0F, -9000.0F, 0.0F}, {-3000.0F, 9000.0F, 0.0F},
                    {0.0F, -9000.0F, 1000.0F},  {0.0F, 9000.0F, 1000.0F},
                    {3000.0F, -9000.0F, 0.0F},  {3000.0F, 9000.0F, 0.0F}};
  mesh.normals.assign(6, {0.0F, 0.0F, 1.0F});
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {2, 4, 3}, {3, 4, 5}};
  const Terrain terrain(mesh);
  const glm::dvec3 to_sun = EasternSun(8.0);
  const SunProbes probes(terrain, to_sun, kSunRadius, 64);
  const ShadowHeights heights(terrain.mesh(), to_sun, kSunRadius, {.cell_m = 50.0});
  const glm::dvec3 eye(-9000.0, 100.0, 400.0);
  const SunlitPath a = probes.Along(eye, {1.0, 0.0, 0.0}, 7000.0);
  const SunlitPath b = heights.Along(eye, {1.0, 0.0, 0.0}, 7000.0);
  for (double t = 50.0; t < 7000.0; t += 100.0) {
    EXPECT_NEAR(SunlightAt(a, t), SunlightAt(b, t), 0.05)
        << "at " << t << " m; the edge is halved to a 64th of the distance of probes";
  }
}

// Hard case 41.
TEST(SunProbes, ARidgeOfNoThicknessLetsNoLightThrough) {
  // A sheet 1000 m high on x = 0, two triangles, from north to south; its two windings.
  for (const bool facing_sun : {false, true}) {
    TriangleMesh wall;
    for (const float y : {-20000.0F, 20000.0F}) {
      for (const float z : {0.0F, 1000.0F}) wall.positions.push_back({0.0F, y, z});
    }
    wall.normals.assign(4, {facing_sun ? 1.0F : -1.0F, 0.0F, 0.0F});
    wall.triangles = facing_sun ? std::vector<std::array<std::uint32_t, 3>>{{0, 2, 1}, {2, 3, 1}}
                                : std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {2, 1, 3}};
    const Terrain terrain(wall);
    const glm::dvec3 to_sun = EasternSun(8.0);
    const SunProbes probes(terrain, to_sun, kSunRadius);
    const ShadowHeights heights(wall, to_sun, kSunRadius);
    // Rays that stay where the whole disk is hidden, up to the sheet itself, and along it.
    const double slope = std::tan(8.0 * kRadiansPerDegree + 2.0 * kSunRadius);
    std::mt19937 random(41);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    const auto in_shade = [&](double x) {
      return glm::dvec3(x, 16000.0 * (uniform(random) - 0.5),
                        (1000.0 + slope * x) * uniform(random));
    };
    for (int i = 0; i < 2000; ++i) {
      const glm::dvec3 from = in_shade(-6000.0 * uniform(random));
      const glm::dvec3 to = in_shade(i % 3 == 0 ? -1e-3 : -6000.0 * uniform(random));
      const double length_m = glm::length(to - from);
      const glm::dvec3 unit = (to - from) / length_m;
      EXPECT_TRUE(probes.Along(from, unit, length_m).empty()) << "ray " << i;
      EXPECT_TRUE(
          terrain.Occluded(from, {0.0, 0.0, 1.0}, to_sun, std::numeric_limits<double>::infinity()));
      if (std::max(to.x, from.x) > -heights.cell_m()) continue;
      EXPECT_TRUE(heights.Along(from, unit, length_m).empty()) << "ray " << i;
    }
  }
}

}  // namespace
}  // namespace alpenglow::renderer
