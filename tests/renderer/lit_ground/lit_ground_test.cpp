// SPDX-License-Identifier: MIT
// Light on the land as vertices have it and triangles interpolate it, against rays and against the
// light of every place of its own.
#include "renderer/lit_ground/lit_ground.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "atmosphere/astronomy/sun.h"
#include "atmosphere/math/numerics.h"
#include "renderer/illumination/sky_irradiance_gradient.h"
#include "tests/renderer/lit_ground/rough_site.h"

namespace alpenglow::renderer {
namespace {

const std::shared_ptr<const GroundSite>& TheSite() {
  static const std::shared_ptr<const GroundSite> site = tests::RoughSite();
  return site;
}

/// A place within a triangle, and what its vertices' light makes of it.
struct Interpolated {
  glm::dvec3 normal{0.0};
  double x = 0.0, y = 0.0;  // of the place [m]
  double sun_x = 0.0;
  double sky = 0.0;  // in the second band
};

Interpolated PlaceOfCase(const LitGround& lit, int number) {
  const TriangleMesh& mesh = lit.site().ground().terrain->mesh();
  const auto triangles = static_cast<double>(mesh.triangles.size());
  const auto& triangle = mesh.triangles[static_cast<std::size_t>(Halton(number, 2) * triangles)];
  double a = Halton(number, 3), b = Halton(number, 5);
  if (a + b > 1.0) {
    a = 1.0 - a;
    b = 1.0 - b;
  }
  const std::array<double, 3> weight{1.0 - a - b, a, b};
  Interpolated place;
  for (std::size_t k = 0; k < 3; ++k) {
    const GroundVertex vertex =
        TheSite()->Vertex(mesh.positions[triangle[k]], mesh.normals[triangle[k]]);
    const LitVertex light = lit.At(vertex);
    for (const glm::length_t axis : {0, 1, 2}) {
      place.normal[axis] +=
          weight[k] * static_cast<double>(vertex.normal[static_cast<std::size_t>(axis)]);
    }
    place.x += weight[k] * static_cast<double>(vertex.position_m[0]);
    place.y += weight[k] * static_cast<double>(vertex.position_m[1]);
    place.sun_x += weight[k] * static_cast<double>(light.sun_x);
    place.sky += weight[k] * static_cast<double>(light.sky[1]);
  }
  place.normal = glm::normalize(place.normal);
  return place;
}

TerrainHit GroundAt(double x, double y) {
  return *TheSite()->ground().terrain->Intersect({x, y, 9000.0}, {0.0, 0.0, -1.0});
}

/// The share of the disk's light that reaches a place, by rays.
double SunlightByRays(const LitGround& lit, const TerrainHit& at) {
  constexpr int kRays = 24;
  const glm::dvec3& sun = lit.lighting().source.direction.seen;
  const glm::dvec3 side = glm::normalize(glm::cross(sun, glm::dvec3(0.3, -0.5, 0.8)));
  const glm::dvec3 other = glm::cross(sun, side);
  double light = 0.0, all = 0.0;
  for (int i = 0; i < kRays; ++i) {
    const double rho = std::sqrt((i + 0.5) / kRays), angle = 2.0 * kPi * Halton(i + 1, 2);
    const glm::dvec3 d =
        glm::normalize(sun + rho * lit.lighting().source.radius_rad *
                                 (std::cos(angle) * side + std::sin(angle) * other));
    all += LimbDarkening(rho);
    if (!TheSite()->ground().terrain->Occluded(at.smooth_point, at.geometric_normal, d,
                                               std::numeric_limits<double>::infinity()))
      light += LimbDarkening(rho);
  }
  return light / all;
}

TEST(LitGround, ShadowEdgesLieWhereRaysFindThem) {
  for (const double elevation_deg : {30.0, 10.0, 4.0}) {
    const LitGround lit(TheSite(), tests::RoughSun(*TheSite(), elevation_deg));
    int places = 0, wrong = 0, shaded = 0;
    double sum2 = 0.0;
    for (int i = 1; i <= 4000; ++i) {
      const Interpolated place = PlaceOfCase(lit, i);
      const double incidence = glm::dot(place.normal, lit.lighting().source.direction.seen);
      if (incidence <= 0.0) continue;
      const double by_rays = SunlightByRays(lit, GroundAt(place.x, place.y));
      const double error = SunlightOverEdge(place.sun_x) - by_rays;
      ++places;
      if (by_rays < 0.5) ++shaded;
      if (std::abs(error) > 0.5) ++wrong;
      sum2 += incidence * error * incidence * error;
    }
    EXPECT_GT(shaded, places / 200) << "what is asked";
    EXPECT_LT(wrong, places / 100) << "share of places lit or shaded wrongly, " << elevation_deg;
    EXPECT_LT(std::sqrt(sum2 / places), 0.02) << "of sunlight across its beams";
  }
}

TEST(LitGround, HeightsOfTheMeshAreThoseThatRaysHit) {
  const MeshHeights heights(TheSite()->ground().terrain->mesh());
  for (int i = 1; i <= 500; ++i) {
    const double x = 7600.0 * (Halton(i, 2) - 0.5), y = 7600.0 * (Halton(i, 3) - 0.5);
    const auto hit = TheSite()->ground().terrain->Intersect({x, y, 9000.0}, {0.0, 0.0, -1.0});
    const auto z_m = heights.At(x, y);
    ASSERT_TRUE(z_m.has_value()) << x << " " << y;
    EXPECT_NEAR(*z_m, 9000.0 - hit->distance_m, 1e-3);
  }
  EXPECT_FALSE(heights.At(4000.0, 0.0).has_value()) << "beside the mesh";
  EXPECT_FALSE(heights.At(0.0, -1e6).has_value());
}

TEST(LitGround, MeshesOfOtherDetailHaveTheShadowOfTheSite) {
  const LitGround lit(TheSite(), tests::RoughSun(*TheSite(), 10.0));
  for (const double spacing_m : {20.0, 240.0}) {
    const Terrain other(LandMesh(RoughLand, 1 + static_cast<int>(6000.0 / spacing_m), spacing_m));
    int places = 0, wrong = 0, shaded = 0;
    for (int i = 1; i <= 2000; ++i) {
      const auto vertex = static_cast<std::size_t>(
          Halton(i, 2) * static_cast<double>(other.mesh().positions.size()));
      const GroundVertex at =
          TheSite()->Vertex(other.mesh().positions[vertex], other.mesh().normals[vertex]);
      const TerrainHit hit =
          GroundAt(static_cast<double>(at.position_m[0]), static_cast<double>(at.position_m[1]));
      if (glm::dot(hit.normal, lit.lighting().source.direction.seen) <= 0.0) continue;
      const double by_rays = SunlightByRays(lit, hit);
      ++places;
      if (by_rays < 0.5) ++shaded;
      if (std::abs(SunlightOverEdge(static_cast<double>(lit.At(at).sun_x)) - by_rays) > 0.5)
        ++wrong;
    }
    EXPECT_GT(shaded, places / 50) << "what is asked";
    EXPECT_LT(wrong, places / 100) << spacing_m;
  }
}

TEST(LitGround, VerticesInAFrameFarAwayAreTheSameVertices) {
  const LitGround lit(TheSite(), tests::RoughSun(*TheSite(), 10.0));
  Place away = tests::kRoughPlace;
  away.latitude_deg += 0.23;  // 25 km
  away.longitude_deg -= 0.11;
  const LocalFrame& here = TheSite()->ground().frame;
  const LocalFrame there(kWgs84, away);
  struct Framed {
    glm::vec3 position_m, normal;
  };
  const TriangleMesh& mesh = TheSite()->ground().terrain->mesh();
  std::vector<Framed> framed;
  std::vector<LitVertex> reference;
  for (std::size_t i = 0; i < mesh.positions.size(); i += 101) {
    reference.push_back(lit.At(TheSite()->Vertex(mesh.positions[i], mesh.normals[i])));
    const Point<Ecef> point = here.EcefFromEnu(Point<Enu>{ToDouble(mesh.positions[i])});
    const Vector<Ecef> normal = here.EcefFromEnu(Vector<Enu>{ToDouble(mesh.normals[i])});
    framed.push_back({there.EnuFromEcef(point).xyz, there.EnuFromEcef(normal).xyz});
  }
  const std::vector<LitVertex> light = lit.LightIn<Framed>(there, framed);
  for (std::size_t i = 0; i < reference.size(); ++i) {
    EXPECT_NEAR(light[i].sky[1] / reference[i].sky[1], 1.0F, 2e-3F) << "4 mm, in steps of altitude";
    if (std::abs(reference[i].sun_x) > 4.0F) continue;
    EXPECT_NEAR(light[i].sun_x, reference[i].sun_x, 0.3F);
  }
}

TEST(LitGround, LightIsInterpolatedBetweenTwoSuns) {
  // Half a second with time running sixty times: an eighth of a degree.
  const LitGround before(TheSite(), tests::RoughSun(*TheSite(), 9.875));
  const LitGround between(TheSite(), tests::RoughSun(*TheSite(), 9.9375));
  const LitGround after(TheSite(), tests::RoughSun(*TheSite(), 10.0));
  const TriangleMesh& mesh = TheSite()->ground().terrain->mesh();
  int cut = 0, uneven = 0;
  for (std::size_t i = 0; i < mesh.positions.size(); i += 7) {
    const GroundVertex vertex = TheSite()->Vertex(mesh.positions[i], mesh.normals[i]);
    const LitVertex a = before.At(vertex), b = between.At(vertex), c = after.At(vertex);
    EXPECT_NEAR(0.5 * static_cast<double>(a.sky[1] + c.sky[1]), static_cast<double>(b.sky[1]),
                2e-3 * static_cast<double>(b.sky[1]));
    if (std::abs(b.sun_x) > 1.0F) continue;
    ++cut;
    const double mean = SunlightOverEdge(0.5 * static_cast<double>(a.sun_x + c.sun_x));
    if (std::abs(mean - SunlightOverEdge(static_cast<double>(b.sun_x))) > 0.05) ++uneven;
  }
  EXPECT_GT(cut, 20) << "what is asked";
  EXPECT_LE(uneven, cut / 10) << "where another crest takes over";
}

TEST(LitGround, SkylightBetweenVerticesEqualsThatOfThePlace) {
  const LitGround lit(TheSite(), tests::RoughSun(*TheSite(), 20.0));
  double sum2 = 0.0;
  constexpr int kPlaces = 500;
  for (int i = 1; i <= kPlaces; ++i) {
    const Interpolated place = PlaceOfCase(lit, i);
    const TerrainHit hit = GroundAt(place.x, place.y);
    const GroundVertex own = tests::VertexAt(*TheSite(), hit.smooth_point, place.normal);
    const double error = place.sky / static_cast<double>(lit.At(own).sky[1]) - 1.0;
    sum2 += error * error / kPlaces;
  }
  EXPECT_LT(std::sqrt(sum2), 0.03);
}

TEST(LitGround, ReliefChangesSkylightAsUnderTheOpenSky) {
  for (const double elevation_deg : {40.0, 5.0, -3.0}) {
    const LitGround lit(TheSite(), tests::RoughSun(*TheSite(), elevation_deg));
    const glm::dvec3& to_sun = lit.lighting().source.direction.seen;
    const glm::dvec3 sunward = glm::normalize(glm::dvec3(to_sun.x, to_sun.y, 0.0));
    const OccludedSkyIrradiance::Extent& extent = TheSite()->horizons()->extent();
    const SkyIrradianceGradient tilt(TheSite()->air().single_scattering(),
                                     TheSite()->air().multiple_scattering(),
                                     0.5 * (extent.lowest_m + extent.highest_m), to_sun.z);
    const auto open = [&](const glm::dvec3& n) {
      return static_cast<double>(tilt.On(n.z, glm::dot(n, sunward))[1]);
    };
    double sum2 = 0.0, without2 = 0.0;
    constexpr int kPlaces = 1000;
    for (int i = 1; i <= kPlaces; ++i) {
      const Interpolated place = PlaceOfCase(lit, i);
      const TerrainHit hit = GroundAt(place.x, place.y);
      const glm::dvec3 relief = TheSite()->geometry().DetailedNormal(
          TheSite()->geometry().GroundAt(hit.smooth_point, 1.0), place.normal);
      const auto sky = [&](const glm::dvec3& n) {
        return static_cast<double>(lit.At(tests::VertexAt(*TheSite(), hit.smooth_point, n)).sky[1]);
      };
      const double smooth = sky(place.normal), rough = sky(relief);
      const double error = smooth * open(relief) / open(place.normal) / rough - 1.0;
      sum2 += error * error / kPlaces;
      without2 += (smooth / rough - 1.0) * (smooth / rough - 1.0) / kPlaces;
    }
    EXPECT_LT(std::sqrt(sum2), 0.021) << elevation_deg;
    EXPECT_LT(std::sqrt(sum2), 0.75 * std::sqrt(without2)) << "what the correction is for";
  }
}

}  // namespace
}  // namespace alpenglow::renderer
