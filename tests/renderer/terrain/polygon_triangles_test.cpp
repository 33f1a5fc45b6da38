// SPDX-License-Identifier: MIT
#include "renderer/terrain/polygon_triangles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <string>

#include "atmosphere/math/constants.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {
namespace {

using Corners = std::vector<glm::dvec3>;

/// Half the length of the sum of cross products: of a polygon in any plane (shoelace formula).
double ShoelaceArea(const Corners& corners) {
  glm::dvec3 sum(0.0);
  for (std::size_t i = 0; i < corners.size(); ++i)
    sum += glm::cross(corners[i] - corners[0], corners[(i + 1) % corners.size()] - corners[0]);
  return 0.5 * glm::length(sum);
}

double AreaOfTriangles(const Corners& corners, const PolygonTriangles& cut) {
  double sum = 0.0;
  for (const auto& [a, b, c] : cut.triangles)
    sum += 0.5 * glm::length(glm::cross(corners[b] - corners[a], corners[c] - corners[a]));
  return sum;
}

/// The area of triangles wound against the polygon is negative.
double SignedArea(const Corners& corners, const PolygonTriangles& cut, const glm::dvec3& normal) {
  double sum = 0.0;
  for (const auto& [a, b, c] : cut.triangles)
    sum += 0.5 * glm::dot(glm::cross(corners[b] - corners[a], corners[c] - corners[a]), normal);
  return sum;
}

glm::dvec3 InSinglePrecision(const glm::dvec3& v) {
  return {static_cast<double>(static_cast<float>(v.x)),
          static_cast<double>(static_cast<float>(v.y)),
          static_cast<double>(static_cast<float>(v.z))};
}

void ExpectItsArea(const Corners& corners, const std::string& what) {
  const PolygonTriangles cut = TrianglesOfPolygon(corners);
  const double area = ShoelaceArea(corners);
  EXPECT_FALSE(cut.crosses_itself) << what;
  EXPECT_NEAR(AreaOfTriangles(corners, cut), area, 1e-6 * area) << what;
}

/// A star around a point: every corner is seen from there, so that no edges cross.
/// @param across, up  unit, span its plane.
Corners Star(std::mt19937& random, int rays, const glm::dvec3& across, const glm::dvec3& up) {
  std::uniform_real_distribution<double> radius(0.05, 10.0);
  Corners corners;
  for (int ray = 0; ray < rays; ++ray) {
    const double angle = 2.0 * kPi * ray / rays;
    const glm::dvec3 way = std::cos(angle) * across + std::sin(angle) * up;
    corners.push_back(InSinglePrecision(glm::dvec3(40.0, -70.0, 20.0) + radius(random) * way));
  }
  return corners;
}

TEST(PolygonTriangles, AConcaveQuadHasItsShoelaceArea) {
  const Corners dart{{-3, -8, 20}, {0, -2, 20}, {3, -8, 20}, {0, 10, 20}};
  EXPECT_DOUBLE_EQ(AreaOfTriangles(dart, TrianglesOfPolygon(dart)), 36.0);
  for (std::size_t turn = 0; turn < 4; ++turn) {
    Corners turned = dart;
    std::rotate(turned.begin(), turned.begin() + static_cast<std::ptrdiff_t>(turn), turned.end());
    ExpectItsArea(turned, "begun at corner " + std::to_string(turn));
    std::reverse(turned.begin(), turned.end());
    ExpectItsArea(turned, "wound the other way");
  }
}

TEST(PolygonTriangles, ConcaveStarsHaveTheirAreaInAnyPlane) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> along(-1.0, 1.0);
  for (int trial = 0; trial < 200; ++trial) {
    const glm::dvec3 normal =
        glm::normalize(glm::dvec3(along(random), along(random), along(random)));
    const glm::dvec3 across = glm::normalize(glm::cross(normal, glm::dvec3(0.3, 0.5, 0.7)));
    const Corners star = Star(random, 4 + trial % 40, across, glm::cross(normal, across));
    ExpectItsArea(star, "trial " + std::to_string(trial));
    const double area = ShoelaceArea(star);
    EXPECT_NEAR(SignedArea(star, TrianglesOfPolygon(star), normal), area, 1e-6 * area)
        << "triangles are wound as the polygon is";
  }
}

TEST(PolygonTriangles, CollinearAndRepeatedCornersChangeNothing) {
  std::mt19937 random(2);
  for (int trial = 0; trial < 100; ++trial) {
    const Corners star = Star(random, 5 + trial % 20, {1, 0, 0}, {0, 1, 0});
    Corners more;
    for (std::size_t i = 0; i < star.size(); ++i) {
      more.push_back(star[i]);
      if (i % 3 == 0) more.push_back(star[i]);
      if (i % 2 == 0)
        more.push_back(InSinglePrecision(0.5 * (star[i] + star[(i + 1) % star.size()])));
    }
    more.push_back(star.front());
    ExpectItsArea(more, "trial " + std::to_string(trial));
  }
  ExpectItsArea({{0, 0, 5}, {1, 0, 5}, {2, 0, 5}, {2, 2, 5}, {1, 2, 5}, {0, 2, 5}, {0, 1, 5}},
                "corners amid the edges of a square");
}

TEST(PolygonTriangles, APolygonMayTouchItselfAtASlitAndAtACorner) {
  // A square of 10 m with a hole of 4 m, which is joined to the rim by a slit.
  const Corners frame{{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}, {0, 0, 0},
                      {3, 3, 0}, {3, 7, 0},  {7, 7, 0},   {7, 3, 0},  {3, 3, 0}};
  EXPECT_NEAR(AreaOfTriangles(frame, TrianglesOfPolygon(frame)), 84.0, 1e-9);
  const Corners touching{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 0, 0}, {0, 4, 0}};
  ExpectItsArea(touching, "a corner on an edge");
}

TEST(PolygonTriangles, ARefractedPolygonIsCoveredOnce) {
  const Corners bent{{0, 0, 0}, {10, 0, 3}, {6, 4, -1}, {10, 10, 0}, {4, 6, 2}, {0, 10, 1}};
  const PolygonTriangles cut = TrianglesOfPolygon(bent);
  EXPECT_EQ(cut.triangles.size(), 4U);
  double seen_from_above = 0.0;
  for (const auto& [a, b, c] : cut.triangles) {
    const double twice = glm::cross(bent[b] - bent[a], bent[c] - bent[a]).z;
    EXPECT_GT(twice, 0.0);
    seen_from_above += 0.5 * twice;
  }
  Corners level = bent;
  for (glm::dvec3& corner : level) corner.z = 0.0;
  EXPECT_NEAR(seen_from_above, ShoelaceArea(level), 1e-9);
}

TEST(PolygonTriangles, APolygonWhoseEdgesCrossIsSaidToCross) {
  EXPECT_TRUE(TrianglesOfPolygon({{0, 0, 0}, {4, 4, 0}, {4, 0, 0}, {0, 4, 0}}).crosses_itself);
  EXPECT_TRUE(
      TrianglesOfPolygon({{0, 0, 0}, {10, 0, 0}, {2, 6, 0}, {5, -4, 0}, {8, 6, 0}}).crosses_itself);
}

TEST(PolygonTriangles, APolygonWithoutAreaHasNoTriangles) {
  EXPECT_TRUE(TrianglesOfPolygon({{0, 0, 0}, {0, 0, 0}, {1, 0, 0}}).triangles.empty());
  EXPECT_TRUE(TrianglesOfPolygon({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}}).triangles.empty());
  EXPECT_TRUE(TrianglesOfPolygon({{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}}).triangles.empty());
  const PolygonTriangles spike = TrianglesOfPolygon({{0, 0, 0}, {5, 0, 0}, {0, 0, 0}, {2, 0, 0}});
  EXPECT_TRUE(spike.triangles.empty());
  EXPECT_FALSE(spike.crosses_itself);
}

TEST(PolygonTriangles, AWindingPassageOfManyCornersHasItsArea) {
  constexpr int kHalf = 600;
  Corners spiral;
  for (int i = 0; i < 2 * kHalf; ++i) {
    const bool is_way_back = i >= kHalf;
    const double along = is_way_back ? 2 * kHalf - 1 - i : i;
    const double angle = along / kHalf * 20.0 * kPi;
    const double radius = 10.0 + 0.2 * along + (is_way_back ? 3.0 : 0.0);
    spiral.push_back(InSinglePrecision({radius * std::cos(angle), radius * std::sin(angle), 0.0}));
  }
  ExpectItsArea(spiral, "a spiral");
}

}  // namespace
}  // namespace alpenglow::renderer
