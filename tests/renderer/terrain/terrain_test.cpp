// SPDX-License-Identifier: MIT
// Terrain as a mesh of triangles: how it is made of an elevation model, and rays that meet it.
#include "renderer/terrain/terrain.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "renderer/elevation/mesh.h"

namespace alpenglow::renderer {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

std::array<float, 3> ToFloat(const glm::dvec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

LocalFrame FrameAt(double latitude, double longitude) {
  return LocalFrame(kWgs84, PlaceFromDegrees(latitude, longitude, 0.0));
}

ElevationGrid Grid(double north_deg, double west_deg, std::array<double, 2> step_deg, int rows,
                   int columns, const std::function<double(int, int)>& height) {
  ElevationGrid grid;
  grid.north_rad = north_deg * kRadiansPerDegree;
  grid.west_rad = west_deg * kRadiansPerDegree;
  grid.step_lat_rad = step_deg[0] * kRadiansPerDegree;
  grid.step_lon_rad = step_deg[1] * kRadiansPerDegree;
  grid.rows = rows;
  grid.columns = columns;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column)
      grid.height_m.push_back(static_cast<float>(height(row, column)));
  }
  return grid;
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
  const ElevationGrid grid =
      Grid(46.75, 7.6, {0.5 / 200.0, 0.8 / 200.0}, 201, 201, [](int row, int column) {
        return 1500.0 + 700.0 * std::sin(0.31 * row) * std::cos(0.23 * column);
      });
  return MeshFromElevation(grid, FrameAt(46.5, 8.0));
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
    const LocalFrame frame = FrameAt(45.0, 8.0);
    const Terrain terrain(
        MeshFromElevation(Grid(45.0 + far_deg, 8.0 - 0.004, {far_deg / 1000.0, 0.002}, 1001, 5,
                               [&](int row, int) { return row == 0 ? peak_m : 0.0; }),
                          frame));
    const glm::dvec3 eye(0.0, 0.0, 2.0);
    const glm::dvec3 summit =
        frame.EnuFromGeodetic(PlaceFromDegrees(45.0 + far_deg, 8.0, peak_m - 1.0)).xyz;
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
  const GeodeticPosition here{46.5 * kRadiansPerDegree, 8.0 * kRadiansPerDegree, 0.0};
  const LocalFrame frame(kWgs84, here);
  ElevationGrid grid;
  grid.rows = grid.columns = 41;
  grid.step_lat_rad = 4.7e-5;
  grid.step_lon_rad = 6.8e-5;
  grid.north_rad = here.latitude_rad + 0.0112;  // 71 km north and, below, as much east
  grid.west_rad = here.longitude_rad + 0.0162;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column)
      grid.height_m.push_back(static_cast<float>(500.0 + 6.5 * (column - row)));
  }
  const Terrain terrain(MeshFromElevation(grid, frame));
  double largest_m = 0.0;
  for (int row = 1; row + 1 < grid.rows; ++row) {
    for (int column = 1; column + 1 < grid.columns; ++column) {
      const GeodeticPosition sample{grid.LatitudeOfRow(row), grid.LongitudeOfColumn(column),
                                    static_cast<double>(grid.height_m[grid.index(row, column)])};
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

// Returns the number of edges of a single triangle.
std::size_t BorderEdges(const TriangleMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(triangle[k], triangle[(k + 1) % 3]);
      ++uses[{low, high}];
    }
  }
  std::size_t border = 0;
  for (const auto& [edge, count] : uses) {
    EXPECT_LE(count, 2);
    if (count == 1) ++border;
  }
  return border;
}

double LongestEdge(const TriangleMesh& mesh) {
  double longest = 0.0;
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      longest = std::max(longest, glm::length(ToDouble(mesh.positions[triangle[k]]) -
                                              ToDouble(mesh.positions[triangle[(k + 1) % 3]])));
    }
  }
  return longest;
}

// Hard case 16.
TEST(MeshFromElevation, VerticesLieAtTheirHeightOverTheEllipsoid) {
  const ElevationGrid grid = Grid(47.0, 7.5, {0.01, 0.01}, 101, 101,
                                  [](int row, int column) { return 10.0 * row + column; });
  const LocalFrame frame = FrameAt(46.5, 8.0);
  const TriangleMesh mesh = MeshFromElevation(grid, frame);
  ASSERT_EQ(mesh.positions.size(), 101U * 101U);
  ASSERT_EQ(mesh.triangles.size(), 2U * 100U * 100U);
  for (int row = 0; row < 101; row += 10) {
    for (int column = 0; column < 101; column += 10) {
      const GeodeticPosition place =
          frame.GeodeticFromEnu({ToDouble(mesh.positions[grid.index(row, column)])});
      EXPECT_NEAR(place.height_m, 10.0 * row + column, 4e-3) << "float rounds 67 km by 4 mm";
      EXPECT_NEAR(place.latitude_rad, grid.LatitudeOfRow(row), 1e-9);
      EXPECT_NEAR(place.longitude_rad, grid.LongitudeOfColumn(column), 1e-9);
    }
  }
}

TEST(MeshFromElevation, ADistantPeakSinksWithTheEllipsoid) {
  // The peak is due north, in the meridian's plane: an independent formula in long double.
  const long double a = 6378137.0L;
  const long double f = 1.0L / 298.257223563L;
  const long double e2 = f * (2.0L - f);
  const double latitude = 45.0;
  const double peak_latitude = 46.35;
  const double peak_m = 3000.0;
  const auto axis_and_equator = [&](long double latitude_rad, long double height) {
    const long double n =
        a / std::sqrt(1.0L - e2 * std::sin(latitude_rad) * std::sin(latitude_rad));
    return std::pair((n + height) * std::cos(latitude_rad),
                     (n * (1.0L - e2) + height) * std::sin(latitude_rad));
  };
  const long double phi0 = static_cast<long double>(latitude * kRadiansPerDegree);
  const long double phi1 = static_cast<long double>(peak_latitude * kRadiansPerDegree);
  const auto [x0, z0] = axis_and_equator(phi0, 0.0L);
  const auto [x1, z1] = axis_and_equator(phi1, static_cast<long double>(peak_m));
  const long double up = (x1 - x0) * std::cos(phi0) + (z1 - z0) * std::sin(phi0);
  const ElevationGrid grid = Grid(peak_latitude, 8.0, {0.01, 0.01}, 3, 3, [&](int row, int column) {
    return row == 0 && column == 0 ? peak_m : 0.0;
  });
  const TriangleMesh mesh = MeshFromElevation(grid, FrameAt(latitude, 8.0));
  EXPECT_NEAR(static_cast<double>(mesh.positions[0][2]), static_cast<double>(up), 1e-3)
      << "float at 1.2 km";
  EXPECT_NEAR(static_cast<double>(up), peak_m - 150.0e3 * 150.0e3 / (2.0 * 6.367e6), 3.0)
      << "and a sphere says about the same: 150 km away the ground is 1767 m down";
}

// Hard case 17.
TEST(MeshFromElevation, ARingAroundAPoleIsClosedThereAndAtItsSeam) {
  for (const bool north : {true, false}) {
    const ElevationGrid grid = Grid(north ? 89.995 : -89.995 + 0.07, -180.0, {0.01, 10.0}, 8, 36,
                                    [](int row, int) { return 5.0 * row; });
    const LocalFrame frame = FrameAt(north ? 90.0 : -90.0, 0.0);
    const TriangleMesh mesh = MeshFromElevation(grid, frame);
    EXPECT_EQ(mesh.positions.size(), 8U * 36U + 1U);
    EXPECT_EQ(mesh.triangles.size(), 2U * 7U * 36U + 36U);
    EXPECT_EQ(BorderEdges(mesh), 36U) << "only the outer ring is a border";
    EXPECT_LT(LongestEdge(mesh), 2500.0) << "no triangle reaches across";
    for (const auto& normal : mesh.normals) EXPECT_GT(normal[2], 0.99F);
  }
}

TEST(MeshFromElevation, TrianglesAtAVoidAreLeftOut) {
  const ElevationGrid grid = Grid(46.0, 8.0, {0.001, 0.001}, 5, 5, [](int row, int column) {
    return row == 2 && column == 2 ? std::numeric_limits<double>::quiet_NaN() : 100.0;
  });
  const TriangleMesh mesh = MeshFromElevation(grid, FrameAt(46.0, 8.0));
  EXPECT_EQ(mesh.positions.size(), 24U);
  EXPECT_EQ(mesh.triangles.size(), 12U * 2U + 4U) << "four cells lose the half at the void";
  for (const auto& position : mesh.positions) {
    for (const float coordinate : position) EXPECT_TRUE(std::isfinite(coordinate));
  }
}

TEST(MeshFromElevation, NormalsOfASlopeAreRight) {
  // The slope is 30 m a step north. A step in metres is the meridian's radius times the angle.
  const double step_m = 6.3671e6 * 0.001 * kRadiansPerDegree;
  const ElevationGrid grid = Grid(45.0 + 0.01, 8.0 - 0.01, {0.001, 0.001}, 21, 21,
                                  [](int row, int) { return 1000.0 - 30.0 * row; });
  const TriangleMesh mesh = MeshFromElevation(grid, FrameAt(45.0, 8.0));
  const auto& normal = mesh.normals[grid.index(10, 10)];
  EXPECT_NEAR(normal[0], 0.0, 1e-4);
  EXPECT_NEAR(normal[1] / normal[2], -30.0 / step_m, 1e-4);
}

// Hard case 18.
TEST(MeshFromElevation, ACrestAlongADiagonalStaysWhole) {
  const ElevationGrid grid = Grid(46.0, 8.0, {0.001, 0.001}, 9, 9, [](int row, int column) {
    return row + column == 8 ? 100.0 : 0.0;
  });
  const TriangleMesh mesh = MeshFromElevation(grid, FrameAt(46.0, 8.0));
  int crest_edges = 0;
  for (const auto& triangle : mesh.triangles) {
    int high = 0;
    for (const std::uint32_t vertex : triangle) high += mesh.positions[vertex][2] > 50.0F ? 1 : 0;
    crest_edges += high == 2 ? 1 : 0;
  }
  EXPECT_EQ(crest_edges, 16) << "each of 8 pieces of the crest is an edge of two triangles";
}

// Hard case 17.
TEST(MeshFromElevation, GroundOver180DegreesAndGreenwichIsOnePiece) {
  const auto mesh_at = [](double latitude, double west, double eye) {
    return MeshFromElevation(
        Grid(latitude + 0.1, west, {0.01, 0.01}, 21, 21,
             [](int row, int column) { return 20.0 * ((row * 7 + column * 3) % 11); }),
        FrameAt(latitude, eye));
  };
  struct Case {
    double latitude, west, eye;
  };
  // Rasters count longitudes from -180 or from 0 degrees.
  for (const Case& over : {Case{-17.1, 179.9, 180.0},
                           {51.5, -0.1, 0.0},
                           {51.5, -0.1, 360.0},
                           {51.5, 359.9, 0.0},
                           {51.5, 359.9, 360.0}}) {
    const TriangleMesh mesh = mesh_at(over.latitude, over.west, over.eye);
    const TriangleMesh same = mesh_at(over.latitude, 19.9, 20.0);
    ASSERT_EQ(mesh.triangles, same.triangles) << over.west;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      EXPECT_LT(glm::length(ToDouble(mesh.positions[i]) - ToDouble(same.positions[i])), 2e-3)
          << "the earth is the same at every meridian; float rounds 16 km by 1 mm";
    }
    EXPECT_EQ(BorderEdges(mesh), 4U * 20U);
  }
}

}  // namespace
}  // namespace alpenglow::renderer
