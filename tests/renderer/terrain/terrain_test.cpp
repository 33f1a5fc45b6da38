// SPDX-License-Identifier: MIT
// Tests of terrain as a mesh of triangles, and of rays that meet it.
#include "renderer/terrain/terrain.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <limits>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "renderer/elevation/mesh.h"
#include "tests/renderer/elevation/grid_in_degrees.h"

namespace alpenglow::renderer {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

std::array<float, 3> ToFloat(const glm::dvec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

// Returns a square of 20 km at height 0, made of two triangles.
TriangleMesh Plane() {
  TriangleMesh mesh;
  mesh.positions = {
      {-10e3F, -10e3F, 0.0F}, {10e3F, -10e3F, 0.0F}, {10e3F, 10e3F, 0.0F}, {-10e3F, 10e3F, 0.0F}};
  mesh.normals.assign(4, {0.0F, 0.0F, 1.0F});
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

// Returns a ball of longitudes and latitudes with its exact normals.
TriangleMesh Ball(const glm::dvec3& centre, double radius_m, int meridians) {
  TriangleMesh mesh;
  const int parallels = meridians / 2;
  for (int i = 0; i <= parallels; ++i) {
    for (int j = 0; j < meridians; ++j) {
      const double theta = kPi * i / parallels;
      const double phi = 2.0 * kPi * j / meridians;
      const glm::dvec3 out(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                           std::cos(theta));
      mesh.positions.push_back(ToFloat(centre + radius_m * out));
      mesh.normals.push_back(ToFloat(out));
    }
  }
  const auto vertex = [&](int i, int j) {
    return static_cast<std::uint32_t>(i * meridians + j % meridians);
  };
  for (int i = 0; i < parallels; ++i) {
    for (int j = 0; j < meridians; ++j) {
      if (i > 0) mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j), vertex(i, j + 1)});
      if (i + 1 < parallels) {
        mesh.triangles.push_back({vertex(i, j + 1), vertex(i + 1, j), vertex(i + 1, j + 1)});
      }
    }
  }
  return mesh;
}

glm::dvec3 RandomDirection(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
}

// Hard case 16.
TEST(Terrain, DistanceToAPlaneIsTheClosedForm) {
  const Terrain terrain(Plane());
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-5e3, 5e3);
  for (int i = 0; i < 10000; ++i) {
    const glm::dvec3 origin(place(random), place(random), 10.0 + std::abs(place(random)));
    const glm::dvec3 target(place(random), place(random), 0.0);
    const std::optional<TerrainHit> hit = terrain.Intersect(origin, target - origin);
    ASSERT_TRUE(hit.has_value());
    EXPECT_NEAR(hit->distance_m, glm::length(target - origin), 1e-6)
        << "the hit is computed anew in double";
    EXPECT_NEAR(hit->normal.z, 1.0, 1e-12);
  }
  EXPECT_FALSE(terrain.Intersect({0.0, 0.0, 10.0}, {0.0, 0.0, 1.0}).has_value());
  EXPECT_FALSE(terrain.Intersect({0.0, 0.0, 10.0}, {1.0, 0.0, 0.0}).has_value());
}

TEST(Terrain, TheLengthOfADirectionDoesNotMatter) {
  const Terrain terrain(Plane());
  for (const double scale : {1e-300, 1e-3, 1.0, 1e30, 1e300}) {
    const auto hit = terrain.Intersect({0.0, 0.0, 100.0}, glm::dvec3(0.0, 3.0, -4.0) * scale);
    ASSERT_TRUE(hit.has_value()) << scale;
    EXPECT_NEAR(hit->distance_m, 125.0, 1e-9);
  }
}

TEST(Terrain, AnEyeInSpaceSeesTheGroundAsPrecisely) {
  const Terrain terrain(Plane());
  for (const double height_m : {1e3, 4e5, 3.6e7, 1e9}) {
    const glm::dvec3 origin(0.3 * height_m, 0.2 * height_m, height_m);
    const glm::dvec3 target(1234.0, -987.0, 0.0);
    const auto hit = terrain.Intersect(origin, target - origin);
    ASSERT_TRUE(hit.has_value()) << height_m;
    const double distance = glm::length(target - origin);
    EXPECT_NEAR(hit->distance_m, distance, 1e-14 * distance + 1e-6);
  }
}

TEST(Terrain, DistanceToABallLiesBetweenItsTwoSpheres) {
  const double radius = 1000.0;
  const int meridians = 256;
  const Terrain terrain(Ball({0.0, 0.0, 0.0}, radius, meridians));
  const double inner = radius * std::pow(std::cos(kPi / meridians), 2.0);
  std::mt19937 random(2);
  for (int i = 0; i < 10000; ++i) {
    const glm::dvec3 origin = 5000.0 * RandomDirection(random);
    const glm::dvec3 unit = glm::normalize(700.0 * RandomDirection(random) - origin);
    const double along = glm::dot(-origin, unit);
    const double across2 = glm::dot(origin, origin) - along * along;
    const auto hit = terrain.Intersect(origin, unit);
    ASSERT_TRUE(hit.has_value());
    EXPECT_GE(hit->distance_m, along - std::sqrt(radius * radius - across2) - 1e-3);
    EXPECT_LE(hit->distance_m, along - std::sqrt(inner * inner - across2) + 1e-3);
    EXPECT_GT(glm::dot(hit->normal, glm::normalize(origin + hit->distance_m * unit)), 0.9999)
        << "interpolated normals are the ball's within a facet's square";
  }
}

// Hard case 19.
TEST(Terrain, ConvexBodiesDoNotShadeThemselves) {
  // The ball is far from the origin of the frame, where a float is 4 mm, and has facets of 100 m.
  const glm::dvec3 centre(50e3, -40e3, 2e3);
  const Terrain terrain(Ball(centre, 4000.0, 256));
  std::mt19937 random(3);
  std::uniform_real_distribution<double> exponent(-3.5, 0.0);
  int shaded = 0;
  for (int i = 0; i < 200000; ++i) {
    const glm::dvec3 eye = centre + 9000.0 * RandomDirection(random);
    const glm::dvec3 look = centre + 3900.0 * RandomDirection(random) - eye;
    const auto hit = terrain.Intersect(eye, look);
    if (!hit) continue;
    const glm::dvec3 point = eye + hit->distance_m * glm::normalize(look);
    const glm::dvec3 tangent =
        glm::normalize(glm::cross(hit->geometric_normal, RandomDirection(random)));
    const double sine = std::pow(10.0, exponent(random));
    const glm::dvec3 sun = glm::normalize(tangent + sine * hit->geometric_normal);
    shaded += terrain.Occluded(point, hit->geometric_normal, sun, kInfinity) ? 1 : 0;
  }
  EXPECT_EQ(shaded, 0)
      << "the sun stands 0.02 to 45 degrees above the facet; rounding to 4 mm dents "
         "facets of 50 m by less";
}

// Hard case 19.
TEST(Terrain, SmoothPointsHideFacetsAtTheTerminator) {
  const Terrain terrain(Ball({0.0, 0.0, 0.0}, 2000.0, 128));
  std::mt19937 random(4);
  int shaded = 0;
  int shaded_without = 0;
  for (int i = 0; i < 50000; ++i) {
    const glm::dvec3 eye = 6000.0 * RandomDirection(random);
    const glm::dvec3 unit = glm::normalize(1500.0 * RandomDirection(random) - eye);
    const auto hit = terrain.Intersect(eye, unit);
    ASSERT_TRUE(hit.has_value());
    const glm::dvec3 tangent = glm::normalize(glm::cross(hit->normal, RandomDirection(random)));
    const glm::dvec3 sun = glm::normalize(tangent + 0.004 * hit->normal);
    shaded += terrain.Occluded(hit->smooth_point, hit->normal, sun, kInfinity) ? 1 : 0;
    shaded_without +=
        terrain.Occluded(eye + hit->distance_m * unit, hit->normal, sun, kInfinity) ? 1 : 0;
  }
  EXPECT_EQ(shaded, 0) << "the sun stands 0.23 degrees above the smooth ball's horizon; a facet "
                          "spans 2.8 degrees";
  EXPECT_GT(shaded_without, 5000) << "and without it the facets show";
}

TEST(Terrain, ShadowsEndWhereTheRayEnds) {
  const Terrain terrain(Plane());
  const glm::dvec3 origin(0.0, 0.0, 100.0);
  const glm::dvec3 up(0.0, 0.0, 1.0);
  EXPECT_TRUE(terrain.Occluded(origin, up, {0.0, 0.0, -1.0}, kInfinity));
  EXPECT_TRUE(terrain.Occluded(origin, up, {0.0, 0.0, -1.0}, 101.0));
  EXPECT_FALSE(terrain.Occluded(origin, up, {0.0, 0.0, -1.0}, 99.0));
  EXPECT_FALSE(terrain.Occluded(origin, up, {0.0, 0.0, -1.0}, 0.0));
  EXPECT_FALSE(terrain.Occluded(origin, up, up, kInfinity));
}

TEST(Terrain, InvalidRaysAreRefused) {
  const Terrain terrain(Plane());
  const glm::dvec3 fine(0.0, 0.0, 1.0);
  for (const double bad : {kNoNumber, kInfinity, -kInfinity}) {
    for (int axis = 0; axis < 3; ++axis) {
      glm::dvec3 wrong = fine;
      wrong[axis] = bad;
      EXPECT_THROW(static_cast<void>(terrain.Intersect(wrong, fine)), InternalError);
      EXPECT_THROW(static_cast<void>(terrain.Intersect(fine, wrong)), InternalError);
      EXPECT_THROW(static_cast<void>(terrain.Occluded(wrong, fine, fine, 1.0)), InternalError);
      EXPECT_THROW(static_cast<void>(terrain.Occluded(fine, wrong, fine, 1.0)), InternalError);
      EXPECT_THROW(static_cast<void>(terrain.Occluded(fine, fine, wrong, 1.0)), InternalError);
    }
  }
  EXPECT_THROW(static_cast<void>(terrain.Intersect(fine, glm::dvec3(0.0))), InternalError);
  EXPECT_THROW(static_cast<void>(terrain.Occluded(fine, fine, fine, -1.0)), InternalError);
  EXPECT_THROW(static_cast<void>(terrain.Occluded(fine, fine, fine, kNoNumber)), InternalError);
}

TEST(Terrain, HugeButFiniteRaysMiss) {
  const Terrain terrain(Plane());
  EXPECT_FALSE(terrain.Intersect({1e308, 1e308, 1e308}, {1.0, 0.0, 0.0}).has_value());
  EXPECT_FALSE(terrain.Intersect({0.0, 0.0, 1e200}, {1.0, 0.0, -1e-300}).has_value());
  EXPECT_FALSE(terrain.Occluded({-1e308, 0.0, 5.0}, {0.0, 0.0, 1.0}, {-1.0, 0.0, 0.0}, 1e308));
}

TEST(Terrain, InvalidMeshesAreRefusedAndAnEmptyOneIsEmpty) {
  TriangleMesh mesh = Plane();
  mesh.triangles.push_back({0, 1, 4});
  EXPECT_THROW(Terrain{mesh}, InternalError);
  mesh = Plane();
  mesh.positions[2][1] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(Terrain{mesh}, InternalError);
  mesh = Plane();
  mesh.normals.pop_back();
  EXPECT_THROW(Terrain{mesh}, InternalError);
  const Terrain nothing{TriangleMesh{}};
  EXPECT_FALSE(nothing.Intersect({0.0, 0.0, 1.0}, {0.0, 0.0, -1.0}).has_value());
}

// Returns hills over 60 km, whose vertices are rounded to float.
TriangleMesh Hills() {
  const ElevationGrid grid = tests::GridInDegrees(
      46.75, 7.6, {0.5 / 200.0, 0.8 / 200.0}, 201, 201, [](int row, int column) {
        return 1500.0 + 700.0 * std::sin(0.31 * row) * std::cos(0.23 * column);
      });
  return MeshFromElevation(grid, tests::FrameAt(46.5, 8.0));
}

// Hard case 18.
TEST(Terrain, NoRaySlipsBetweenTriangles) {
  const TriangleMesh mesh = Hills();
  const Terrain terrain(mesh);
  std::mt19937 random(5);
  for (int i = 0; i < 100000; ++i) {
    const auto& triangle = mesh.triangles[random() % mesh.triangles.size()];
    // Rays aim at corners and edges, where triangles meet.
    const glm::dvec3 a = ToDouble(mesh.positions[triangle[0]]);
    const glm::dvec3 b = ToDouble(mesh.positions[triangle[1]]);
    const glm::dvec3 target = a + static_cast<double>(i % 5) / 4.0 * (b - a);
    if (std::abs(target.x) > 29e3 || std::abs(target.y) > 26e3) continue;
    const glm::dvec3 origin = target + glm::dvec3(0.0, 0.0, 3000.0);
    const auto hit = terrain.Intersect(origin, target - origin);
    ASSERT_TRUE(hit.has_value()) << "through (" << target.x << ", " << target.y << ")";
    EXPECT_NEAR(hit->distance_m, 3000.0, 0.02) << "float aims 4 mm off on slopes up to 70 degrees";
  }
}

std::vector<double> ManyHits(const Terrain& terrain) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> place(-20e3, 20e3);
  std::vector<double> values;
  for (int i = 0; i < 20000; ++i) {
    const glm::dvec3 origin(place(random), place(random), 3000.0);
    const glm::dvec3 target(place(random), place(random), 1000.0);
    const auto hit = terrain.Intersect(origin, target - origin);
    if (!hit) continue;
    for (const double value :
         {hit->distance_m, hit->normal.x, hit->normal.y, hit->normal.z, hit->smooth_point.z}) {
      values.push_back(value);
    }
  }
  return values;
}

// Hard case 43.
TEST(Terrain, ManyThreadsSeeTheSameHitsToTheLastBit) {
  const Terrain terrain(Hills());
  const std::vector<double> alone = ManyHits(terrain);
  ASSERT_GT(alone.size(), 50000U);
  std::vector<std::vector<double>> seen(8);
  std::vector<std::thread> threads;
  for (auto& values : seen) threads.emplace_back([&] { values = ManyHits(terrain); });
  for (std::thread& thread : threads) thread.join();
  for (const auto& values : seen) EXPECT_EQ(values, alone);
}

TEST(Terrain, IsTheSameIfBuiltByOneThreadOrMany) {
  const std::vector<double> many = ManyHits(Terrain(Hills()));
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(ManyHits(Terrain(Hills())), many);
}

// Hard case 20.
TEST(Terrain, TheSeaHidesADistantMountainUpToTheRightHeight) {
  // The eye is 2 m above the sea at 45 degrees; the sight line touches the sea 5 km away and then
  // climbs to (150 km - 5 km)^2 / 2 R = 1649 m, R = 6367 km being the meridian's radius there.
  const double far_deg = 150e3 / (6.3676e6 * kRadiansPerDegree);
  const auto is_visible = [&](double peak_m) {
    const LocalFrame frame = tests::FrameAt(45.0, 8.0);
    const Terrain terrain(MeshFromElevation(
        tests::GridInDegrees(45.0 + far_deg, 8.0 - 0.004, {far_deg / 1000.0, 0.002}, 1001, 5,
                             [&](int row, int) { return row == 0 ? peak_m : 0.0; }),
        frame));
    const glm::dvec3 eye(0.0, 0.0, 2.0);
    const glm::dvec3 summit =
        frame.EnuFromGeodetic(CheckedPlace({45.0 + far_deg, 8.0, peak_m - 1.0})).xyz;
    const auto hit = terrain.Intersect(eye, summit - eye);
    return hit.has_value() && hit->distance_m > 140e3;
  };
  EXPECT_FALSE(is_visible(1640.0));
  EXPECT_TRUE(is_visible(1660.0));
}

// Hard case 16.
TEST(Terrain, GroundAHundredKilometresAwayIsRightToAMillimetre) {
  // The ground is a smooth slope of 3 in 100 towards the south-west, which the ellipsoid bends down
  // by 785 m, with samples 300 m apart. The truth is computed in doubles, through ECEF.
  const Place here{46.5, 8.0, 0.0};
  const LocalFrame frame(kWgs84, here);
  ElevationGrid grid;
  grid.rows = grid.columns = 41;
  grid.step_lat_rad = 4.7e-5;
  grid.step_lon_rad = 6.8e-5;
  grid.north_rad = here.latitude_rad() + 0.0112;  // 71 km north and, below, as much east
  grid.west_rad = here.longitude_rad() + 0.0162;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column)
      grid.height_m.push_back(static_cast<float>(500.0 + 6.5 * (column - row)));
  }
  const Terrain terrain(MeshFromElevation(grid, frame));
  double largest_m = 0.0;
  for (int row = 1; row + 1 < grid.rows; ++row) {
    for (int column = 1; column + 1 < grid.columns; ++column) {
      const Place sample =
          PlaceFromRadians(grid.LatitudeOfRow(row), grid.LongitudeOfColumn(column),
                           static_cast<double>(grid.height_m[grid.index(row, column)]));
      const glm::dvec3 truth = frame.EnuFromGeodetic(sample).xyz;
      for (const glm::dvec3& eye : {glm::dvec3(0.0, 0.0, 9000.0), truth + glm::dvec3(0, 0, 900.0),
                                    glm::dvec3(30e3, 90e3, 4e5)}) {
        const auto hit = terrain.Intersect(eye, truth - eye);
        ASSERT_TRUE(hit.has_value());
        // The error is measured off the ground: along a ray it is divided by the sine of the slope.
        const glm::dvec3 found = eye + hit->distance_m * glm::normalize(truth - eye) - truth;
        largest_m = std::max(largest_m, std::abs(glm::dot(found, hit->geometric_normal)));
      }
    }
  }
  EXPECT_LT(largest_m, 1e-3) << "float rounds a position there by up to 4 mm along the ground and "
                                "0.06 mm up; ECEF in float would be 250 mm";
  EXPECT_GT(largest_m, 1e-6) << "the ground is in floats";
}

}  // namespace
}  // namespace alpenglow::renderer
