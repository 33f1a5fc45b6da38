// SPDX-License-Identifier: MIT
#include "renderer/visibility/shadow_heights.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <filesystem>

#include "atmosphere/astronomy/sun.h"
#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "tests/fixtures/occlusion_march.h"
#include "tests/fixtures/places.h"

namespace alpenglow::renderer {
namespace {

constexpr double kDegree = kRadiansPerDegree;

// Two planes that meet in a level crest 1000 m up at x = 0, from north to south.
TriangleMesh Ridge() {
  TriangleMesh mesh;
  for (const float x : {-3000.0F, 0.0F, 3000.0F}) {
    for (const float y : {-20000.0F, 20000.0F})
      mesh.positions.push_back({x, y, x == 0.0F ? 1000.0F : 0.0F});
  }
  mesh.normals.assign(mesh.positions.size(), {0.0F, 0.0F, 1.0F});
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {2, 4, 3}, {3, 4, 5}};
  return mesh;
}

glm::dvec3 SunInTheEast(double elevation_rad) {
  return {std::cos(elevation_rad), 0.0, std::sin(elevation_rad)};
}

TEST(SunlitPath, SunlightOverAnEdgeIsTheIntegralOfLimbDarkening) {
  for (const double x : {-0.9, -0.3, 0.0, 0.4, 0.95}) {
    double over = 0.0;
    double all = 0.0;
    constexpr int kSteps = 1000;
    for (int i = 0; i < kSteps; ++i) {
      for (int j = 0; j < kSteps; ++j) {
        const double a = -1.0 + 2.0 * (i + 0.5) / kSteps;
        const double b = -1.0 + 2.0 * (j + 0.5) / kSteps;
        if (a * a + b * b >= 1.0) continue;
        const double light = LimbDarkening(std::hypot(a, b));
        all += light;
        if (a > -x) over += light;
      }
    }
    EXPECT_NEAR(SunlightOverEdge(x), over / all, 1e-3) << "a thousand cells across the disk";
  }
  EXPECT_EQ(SunlightOverEdge(1.0), 1.0);
  EXPECT_EQ(SunlightOverEdge(-1.0), 0.0);
}

/// Light of a band over an edge, strip by strip across the disk.
double LightOver(double x, double wavelength_nm) {
  constexpr int kSteps = 300;
  double over = 0.0, all = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double up = -1.0 + 2.0 * (i + 0.5) / kSteps;
    const double half = std::sqrt((1.0 - up) * (1.0 + up));
    for (int j = 0; j < kSteps; ++j) {
      const double light =
          half * LimbDarkening(std::hypot(up, half * (j + 0.5) / kSteps), wavelength_nm);
      all += light;
      if (up > -x) over += light;
    }
  }
  return over / all;
}

// Penumbrae have one edge for all bands; how much that leaves out, of full sunlight.
TEST(SunlitPath, TheGreyPenumbraIsWithinAHundredthOfThatOfEveryBand) {
  double worst = 0.0;
  for (const double wavelength_nm : {440.0, 510.0, 580.0, 680.0}) {
    for (double x = -0.95; x < 1.0; x += 0.1) {
      worst = std::max(worst, std::abs(LightOver(x, wavelength_nm) - SunlightOverEdge(x)));
    }
  }
  EXPECT_LT(worst, 0.01);
  EXPECT_GT(worst, 1e-4) << "else the grey law would need no excuse";
}

TEST(SunlitPath, JoiningPiecesMovesNoJointByMoreThanTheTolerance) {
  const auto height = [](double t) { return std::sin(6.0 * t); };
  SunlitPathBuilder builder;
  constexpr int kPieces = 1000;
  for (int i = 0; i < kPieces; ++i) {
    const double a = static_cast<double>(i) / kPieces;
    const double b = static_cast<double>(i + 1) / kPieces;
    builder.Add({a, b, height(a), height(b)});
  }
  const SunlitPath path = builder.Take();
  EXPECT_LT(path.size(), 40U);
  for (int i = 1; i < kPieces; ++i) {
    const double t = static_cast<double>(i) / kPieces + 1e-9;
    EXPECT_NEAR(SunlightAt(path, t), SunlightOverEdge(height(t)), 0.02)
        << "0.02 radii of the disk, at most 0.8 of its light a radius";
  }
}

TEST(ShadowHeights, ShadowOfARidgeEndsWhereTheSunPassesItsCrest) {
  const double elevation = 8.0 * kDegree;
  const ShadowHeights heights(Ridge(), SunInTheEast(elevation), 0.0, {.cell_m = 50.0});
  // At 400 m over the plain the crest hides the sun up to 600 m / tan 8 degrees behind it.
  const double edge_m = 600.0 / std::tan(elevation);
  const SunlitPath path = heights.Along({-9000.0, 100.0, 400.0}, {1.0, 0.0, 0.0}, 6000.0);
  ASSERT_EQ(path.size(), 1U);
  EXPECT_NEAR(path[0].end_m, 9000.0 - edge_m, 1e-2) << "the crest is kept where it is";
  const SunlitPath above = heights.Along({-9000.0, 100.0, 1001.0}, {1.0, 0.0, 0.0}, 20000.0);
  EXPECT_EQ(above, (SunlitPath{{0.0, 20000.0}}));
}

TEST(ShadowHeights, ShadowsGoOnBeyondTheMesh) {
  const double elevation = 2.0 * kDegree;
  const ShadowHeights heights(Ridge(), SunInTheEast(elevation), 0.0, {.cell_m = 50.0});
  const SunlitPath path = heights.Along({-40000.0, 0.0, 10.0}, {1.0, 0.0, 0.0}, 30000.0);
  ASSERT_EQ(path.size(), 1U);
  EXPECT_NEAR(path[0].end_m, 40000.0 - 990.0 / std::tan(elevation), 0.1);
  EXPECT_EQ(heights.Along({10000.0, 0.0, 10.0}, {1.0, 0.0, 0.0}, 30000.0).size(), 1U)
      << "air on the sunny side is lit";
}

TEST(ShadowHeights, HalfShadeIsAsWideAsTheDisk) {
  const double elevation = 8.0 * kDegree;
  const double radius = 0.265 * kDegree;
  const ShadowHeights heights(Ridge(), SunInTheEast(elevation), radius, {.cell_m = 50.0});
  const SunlitPath path = heights.Along({-9000.0, 100.0, 400.0}, {1.0, 0.0, 0.0}, 6000.0);
  const double full_m = 9000.0 - 600.0 / std::tan(elevation - radius);
  const double dark_m = 9000.0 - 600.0 / std::tan(elevation + radius);
  EXPECT_NEAR(path.front().end_m, full_m, 0.1);
  EXPECT_NEAR(path.back().end_m, dark_m, 0.1);
  EXPECT_NEAR(SunlightAt(path, 9000.0 - 600.0 / std::tan(elevation)), 0.5, 0.01);
}

TEST(ShadowHeights, PlacesAreAnsweredWithoutWhatOnlyRaysNeed) {
  const glm::dvec3 sun = SunInTheEast(10.0 * kDegree);
  const ShadowHeights rays(Ridge(), sun, 0.0047);
  const ShadowHeights places(Ridge(), sun, 0.0047, {.for_rays = false});
  for (double x = -9000.0; x < 0.0; x += 300.0) {
    EXPECT_EQ(places.Over({x, 50.0, 0.0}).clearance_m, rays.Over({x, 50.0, 0.0}).clearance_m) << x;
    EXPECT_EQ(places.Over({x, 50.0, 0.0}).radius_m, rays.Over({x, 50.0, 0.0}).radius_m) << x;
  }
  EXPECT_LT(static_cast<double>(places.bytes()), 0.85 * static_cast<double>(rays.bytes()))
      << "8 bytes of every four nodes, and a third of that, beside 12 of each";
  EXPECT_THROW(static_cast<void>(places.Along({-1e3, 0.0, 0.0}, {1.0, 0.0, 0.0}, 1e3)),
               InternalError);
}

TEST(ShadowHeights, ASunOverheadCastsNoShadowOnOpenAir) {
  for (const double elevation : {90.0, 89.9, 60.0}) {
    const ShadowHeights heights(Ridge(), SunInTheEast(elevation * kDegree), 0.265 * kDegree,
                                {.cell_m = 50.0});
    const SunlitPath path = heights.Along({-9000.0, 100.0, 1100.0}, {1.0, 0.0, 0.0}, 18000.0);
    EXPECT_EQ(path, (SunlitPath{{0.0, 18000.0}})) << elevation;
  }
}

TEST(ShadowHeights, NoTerrainAndNoLengthAreNoTrouble) {
  const ShadowHeights nothing(TriangleMesh{}, SunInTheEast(0.1), 0.005);
  EXPECT_EQ(nothing.Along({0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 5.0), (SunlitPath{{0.0, 5.0}}));
  EXPECT_TRUE(nothing.Along({0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 0.0).empty());
  const ShadowHeights heights(Ridge(), SunInTheEast(0.1), 0.005);
  EXPECT_EQ(heights.Along({0.0, 0.0, 5000.0}, {0.0, 0.0, 1.0}, 1e5), (SunlitPath{{0.0, 1e5}}));
}

const SceneGround& RangeGround() {
  static const SceneGround kGround = [] {
    Scene scene;
    scene.place = {47.0 * kDegree, 11.0 * kDegree, 0.0};
    scene.medium = MediumPreset("earth");
    scene.camera.height = {300.0, true};
    return LoadGround(scene);
  }();
  return kGround;
}

TEST(ShadowHeights, TheSamePathsForAnyNumberOfThreads) {
  const SceneGround& ground = RangeGround();
  const ShaftView view = ViewWithSun(ground.eye_height_m, 200.0, 3.0, 8, 5);
  const auto paths = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const ShadowHeights heights(ground.terrain->mesh(), view.to_sun, view.sun_radius_rad);
    std::vector<SunlitPath> found;
    for (const glm::dvec3& direction : view.directions)
      found.push_back(heights.Along(view.eye, direction, 200e3));
    return found;
  };
  const auto one = paths(1);
  EXPECT_EQ(one, paths(2));
  EXPECT_EQ(one, paths(8));
}

// Against the mean of eight marches of 512 occlusion rays: one alone is wrong by up to 0.6 %.
void ExpectShaftsAsOcclusionRaysFindThem(const SceneGround& ground) {
  for (const double elevation : {15.0, 8.0, 3.0, 1.0}) {
    const ShaftView view = ViewWithSun(ground.eye_height_m, 200.0, elevation, 20, 11);
    const ShaftError error = ErrorOf(MeasureShafts(ground, view), &ShaftPixel::found);
    EXPECT_LT(error.rms, 5e-3) << "sun at " << elevation << " degrees";
    EXPECT_LT(error.at_99_percent, 2e-2) << "sun at " << elevation << " degrees";
  }
}

TEST(ShadowHeights, ShaftsOverTheRangeAreThoseOfThousandsOfOcclusionRays) {
  ExpectShaftsAsOcclusionRaysFindThem(RangeGround());
}

TEST(ShadowHeights, ShaftsAroundFujiAreThoseOfThousandsOfOcclusionRays) {
  Scene scene;
  scene.place = {35.5 * kDegree, 138.75 * kDegree, 0.0};
  scene.medium = MediumPreset("earth");
  scene.camera.height = {300.0, true};
  scene.terrain.kind = TerrainSource::Kind::kElevationModel;
  scene.terrain.file = std::filesystem::path(tests::kSharedFolder) / "dem" / "N35E138.hgt";
  if (!std::filesystem::exists(scene.terrain.file))
    GTEST_SKIP() << scene.terrain.file << " is not there";
  ExpectShaftsAsOcclusionRaysFindThem(LoadGround(scene));
}

}  // namespace
}  // namespace alpenglow::renderer
