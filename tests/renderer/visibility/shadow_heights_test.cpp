// SPDX-License-Identifier: MIT
// Shadows of terrain in the air and its horizons: tabulated shadow heights, probes of the sun,
// horizon maps.
#include "renderer/visibility/shadow_heights.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "atmosphere/astronomy/sun.h"
#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "renderer/visibility/horizon_map.h"
#include "renderer/visibility/sunlit_path.h"
#include "tests/fixtures/bare_scene.h"
#include "tests/fixtures/occlusion_march.h"
#include "tests/fixtures/rough_land.h"
#include "tests/fixtures/sanitized.h"
#include "tests/fixtures/temporary_folder.h"
#include "tests/fixtures/thread_counts.h"
#include "tests/renderer/elevation/coarse_fuji.h"

namespace alpenglow::renderer {
namespace {

constexpr double kDegree = kRadiansPerDegree;

// Returns two planes that meet in a level crest 1000 m up at x = 0, from north to south.
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

constexpr double kSunRadius = 0.265 * kDegree;

glm::dvec3 EasternSun(double elevation_deg) {
  return {std::cos(elevation_deg * kDegree), 0.0, std::sin(elevation_deg * kDegree)};
}

/// Expects a path that is lit over its whole length.
void ExpectLit(const SunlitPath& path, double length_m) {
  EXPECT_EQ(path, (SunlitPath{{0.0, length_m}}));
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

/// Returns the light of a band over an edge, strip by strip across the disk.
double LightOver(double x, double wavelength_nm) {
  constexpr int kSteps = 200;
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

// Penumbrae have one edge for all bands. The test measures the error relative to full sunlight.
TEST(SunlitPath, TheGreyPenumbraIsThatOfEveryBandToAHundredth) {
  double worst = 0.0;
  for (const double wavelength_nm : {440.0, 510.0, 580.0, 680.0}) {
    for (double x = -0.95; x < 1.0; x += 0.1) {
      worst = std::max(worst, std::abs(LightOver(x, wavelength_nm) - SunlightOverEdge(x)));
    }
  }
  EXPECT_LT(worst, 0.01);
  EXPECT_GT(worst, 1e-4) << "else the grey law would need no excuse";
}

TEST(SunlitPath, JoinedPiecesKeepTheirLightWithinTheTolerance) {
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

TEST(ShadowHeights, AShadowEndsWhereTheSunPassesTheCrest) {
  const double elevation = 8.0 * kDegree;
  const ShadowHeights heights(Ridge(), EasternSun(elevation / kDegree), 0.0, {.cell_m = 50.0});
  // At 400 m above the plain the crest hides the sun up to 600 m / tan 8 degrees behind it.
  const double edge_m = 600.0 / std::tan(elevation);
  const SunlitPath path = heights.Along({-9000.0, 100.0, 400.0}, {1.0, 0.0, 0.0}, 6000.0);
  ASSERT_EQ(path.size(), 1U);
  EXPECT_NEAR(path[0].end_m, 9000.0 - edge_m, 1e-2) << "the crest is kept where it is";
  const SunlitPath above = heights.Along({-9000.0, 100.0, 1001.0}, {1.0, 0.0, 0.0}, 20000.0);
  ExpectLit(above, 20000.0);
}

TEST(ShadowHeights, ShadowsContinueBeyondTheMesh) {
  const double elevation = 2.0 * kDegree;
  const ShadowHeights heights(Ridge(), EasternSun(elevation / kDegree), 0.0, {.cell_m = 50.0});
  const SunlitPath path = heights.Along({-40000.0, 0.0, 10.0}, {1.0, 0.0, 0.0}, 30000.0);
  ASSERT_EQ(path.size(), 1U);
  EXPECT_NEAR(path[0].end_m, 40000.0 - 990.0 / std::tan(elevation), 0.1);
  EXPECT_EQ(heights.Along({10000.0, 0.0, 10.0}, {1.0, 0.0, 0.0}, 30000.0).size(), 1U)
      << "air on the sunny side is lit";
}

TEST(ShadowHeights, HalfShadeIsAsWideAsTheDisk) {
  const double elevation = 8.0 * kDegree;
  const double radius = 0.265 * kDegree;
  const ShadowHeights heights(Ridge(), EasternSun(elevation / kDegree), radius, {.cell_m = 50.0});
  const SunlitPath path = heights.Along({-9000.0, 100.0, 400.0}, {1.0, 0.0, 0.0}, 6000.0);
  const double full_m = 9000.0 - 600.0 / std::tan(elevation - radius);
  const double dark_m = 9000.0 - 600.0 / std::tan(elevation + radius);
  EXPECT_NEAR(path.front().end_m, full_m, 0.1);
  EXPECT_NEAR(path.back().end_m, dark_m, 0.1);
  EXPECT_NEAR(SunlightAt(path, 9000.0 - 600.0 / std::tan(elevation)), 0.5, 0.01);
}

TEST(ShadowHeights, LookUpsAtPlacesNeedNoDataForRays) {
  const glm::dvec3 sun = EasternSun(10.0);
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
    const ShadowHeights heights(Ridge(), EasternSun(elevation), kSunRadius, {.cell_m = 50.0});
    const SunlitPath path = heights.Along({-9000.0, 100.0, 1100.0}, {1.0, 0.0, 0.0}, 18000.0);
    ExpectLit(path, 18000.0);
  }
}

TEST(ShadowHeights, EmptyTerrainAndEmptyRaysAreAllowed) {
  const ShadowHeights nothing(TriangleMesh{}, EasternSun(5.73), 0.005);
  ExpectLit(nothing.Along({0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 5.0), 5.0);
  EXPECT_TRUE(nothing.Along({0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 0.0).empty());
  const ShadowHeights heights(Ridge(), EasternSun(5.73), 0.005);
  ExpectLit(heights.Along({0.0, 0.0, 5000.0}, {0.0, 0.0, 1.0}, 1e5), 1e5);
}

TEST(ShadowHeights, ThePathsAreTheSameForAnyNumberOfThreads) {
  const TriangleMesh mesh = LandMesh(RoughLand, 129, 60.0);
  const ShaftView view = ViewWithSun(2600.0, 200.0, 3.0, 8, 5);
  static_cast<void>(tests::EqualForAnyNumberOfThreads([&] {
    const ShadowHeights heights(mesh, view.to_sun, view.sun_radius_rad);
    std::vector<SunlitPath> found;
    for (const glm::dvec3& direction : view.directions)
      found.push_back(heights.Along(view.eye, direction, 200e3));
    return found;
  }));
}

// The truth is the mean of eight marches of 512 occlusion rays; a single march has an error of up
// to 0.6 %.
void ExpectShaftsOfOcclusionRays(const SceneGround& ground,
                                 const std::vector<double>& elevations_deg) {
  for (const double elevation : elevations_deg) {
    const ShaftView view = ViewWithSun(ground.eye_height_m, 200.0, elevation, 14, 7);
    const ShaftError error = ErrorOf(MeasureShafts(ground, view), &ShaftPixel::found);
    EXPECT_LT(error.rms, 5e-3) << "sun at " << elevation << " degrees";
    EXPECT_LT(error.at_99_percent, 2e-2) << "sun at " << elevation << " degrees";
  }
}

TEST(ShadowHeights, ShaftsOverTheRangeAreThoseOfOcclusionRays) {
  Scene scene = BareScene(0.0, 0.0, 0.0, 60.0);
  scene.camera.height = {300.0, true};
  scene.terrain = {};
  scene.terrain.is_default = true;
  const SceneGround ground = LoadGround(scene);
  EXPECT_NE(ground.message.find("made up"), std::string::npos) << "nobody named a terrain";
  const std::vector<double> high_to_low{15.0, 3.0, 1.0};
  ExpectShaftsOfOcclusionRays(ground, tests::ScaledDown(high_to_low, {3.0}));
}

class ShadowHeightsOfFiles : public TemporaryFolder {};

TEST_F(ShadowHeightsOfFiles, ShaftsAroundFujiAreThoseOfOcclusionRays) {
  if (!std::filesystem::exists(tests::FujiModel()))
    GTEST_SKIP() << tests::FujiModel() << " is not there";
  Scene scene = BareScene(0.0, 0.0, 0.0, 60.0);
  scene.place = {35.5, 138.75, 0.0};
  scene.camera.height = {300.0, true};
  scene.terrain.kind = TerrainSource::Kind::kElevationModel;
  scene.terrain.file = tests::CoarseFuji(folder_);
  ExpectShaftsOfOcclusionRays(LoadGround(scene), {2.0});
}

// Returns a bridge over a plain: a level slab from x = -50 to 50 and y = -500 to 500, 200 m up.
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
  // At 100 m above the plain the slab's shadow is 100 m to the west.
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
  // The ray crosses the shadow of the slab's western edge, which is 141 m away along the beam.
  const double half_m = 100.0 * 2.0 * std::tan(kSunRadius);
  EXPECT_NEAR(path[0].end_m, 850.0 - half_m, 0.3);
  EXPECT_NEAR(path[1].end_m, 850.0 + half_m, 0.3);
}

TEST(SunProbes, AirOutOfReachOfShadowsIsNotProbed) {
  const Terrain terrain(Bridge(false));
  const SunProbes probes(terrain, EasternSun(10.0), kSunRadius);
  ExpectLit(probes.Along({0.0, 0.0, 300.0}, {0.0, 0.0, 1.0}, 1e5), 1e5);
  ExpectLit(probes.Along({100.0, 0.0, 10.0}, {1.0, 0.0, 0.0}, 1e5), 1e5);
  EXPECT_TRUE(probes.Along({0.0, 0.0, 300.0}, {0.0, 0.0, 1.0}, 0.0).empty());
}

// The crest is 1000 m up at x = 0. A point sees it at an elevation that follows from its place.
TEST(SunProbes, PointsOfTheAirHaveTheLightOverACrestInFront) {
  constexpr double kElevation = 8.0 * kDegree;
  const Terrain terrain(Ridge());
  const ShadowHeights heights(Ridge(), EasternSun(8.0), kSunRadius);
  const SunProbes probes(terrain, EasternSun(8.0), kSunRadius);
  for (const double away_m : {400.0, 2500.0, 5000.0}) {  // the last one is before the terrain
    for (const double radii : {-3.0, -0.9, -0.5, 0.1, 0.3, 0.8, 3.0}) {
      const double crest = kElevation - radii * kSunRadius;
      const glm::dvec3 point(-away_m, 300.0, 1000.0 - away_m * std::tan(crest));
      const double light = SunlightOverEdge(radii);
      EXPECT_NEAR(heights.SunlightAt(point), light, 0.02) << away_m << ", " << radii;
      EXPECT_NEAR(probes.SunlightAt(point), light, 0.25) << away_m << ", " << radii;
      EXPECT_NEAR(
          SunlightAt(heights.Along(point - glm::dvec3(0.0, 50.0, 0.0), {0.0, 1.0, 0.0}, 100.0),
                     50.0),
          heights.SunlightAt(point), 0.02);
    }
  }
  EXPECT_EQ(heights.SunlightAt({2000.0, 0.0, 500.0}), 1.0) << "on the sunward side";
  EXPECT_EQ(heights.SunlightAt({-2000.0, 30000.0, 10.0}), 1.0) << "beside the terrain";
}

TEST(SunProbes, OverhangsAreNotASingleSurface) {
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

TEST(SunProbes, AgreeWithShadowHeightsOverOneSurface) {
  const Terrain terrain(Ridge());
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
  // The sheet is 1000 m high at x = 0, from north to south; its triangles have either winding.
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
    // Rays stay where the whole disk is hidden, up to the sheet itself, and along it.
    const double slope = std::tan(8.0 * kRadiansPerDegree + 2.0 * kSunRadius);
    std::mt19937 random(41);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    const auto in_shade = [&](double x) {
      return glm::dvec3(x, 16000.0 * (uniform(random) - 0.5),
                        (1000.0 + slope * x) * uniform(random));
    };
    for (int i = 0; i < 1000; ++i) {
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

constexpr double kFlatPlanet_m = 1e15;

TEST(HeightRaster, HasTheHeightsOfTheMesh) {
  const auto plane = [](double x, double y) { return 100.0 + 0.2 * x - 0.1 * y; };
  const HeightRaster raster = RasterOf(LandMesh(plane, 31, 100.0), 1 << 12);
  EXPECT_LE(raster.z_m.size(), std::size_t{1} << 12);
  for (int row = 0; row < raster.rows; ++row) {
    for (int column = 0; column < raster.columns; ++column) {
      const auto [x, y] = raster.Place(column, row);
      EXPECT_NEAR(static_cast<double>(raster.at(column, row)), plane(x, y), 1e-3);
    }
  }
}

TEST(HeightRaster, HasNoDataOutsideTheMesh) {
  TriangleMesh mesh = LandMesh([](double, double) { return 5.0; }, 11, 10.0);
  mesh.triangles.resize(mesh.triangles.size() / 2);  // the southern half
  const HeightRaster raster = RasterOf(mesh, 1 << 10);
  EXPECT_FLOAT_EQ(raster.at(raster.columns / 2, 1), 5.0F);
  EXPECT_EQ(raster.at(raster.columns / 2, raster.rows - 2), HeightRaster::kNothing);
}

TEST(HorizonMap, AWallHasTheElevationOfItsHeight) {
  // The wall is 300 m high, 1 km to the east of the middle, and as long as the land.
  const auto wall = [](double x, double) { return x > 990.0 && x < 1110.0 ? 300.0 : 0.0; };
  const HorizonMap map(RasterOf(LandMesh(wall, 101, 50.0), 1 << 14), kFlatPlanet_m);
  const Horizons horizons = map.At({0.0, 0.0, 0.0});
  for (std::size_t i = 0; i < kHorizonAzimuths; ++i) {
    const double east = std::cos(HorizonAzimuth(i));
    const double expected = east > 0.3 ? 300.0 / std::hypot(300.0, 1000.0 / east) : 0.0;
    EXPECT_NEAR(static_cast<double>(horizons[i]), expected, 0.01)
        << "azimuth " << i << "; the wall stands between 950 and 1000 m";
  }
}

TEST(HorizonMap, ATiltedPlainIsItsOwnHorizon) {
  const auto tilted = [](double x, double y) { return 0.06 * x - 0.05 * y; };
  const HorizonMap map(RasterOf(LandMesh(tilted, 101, 50.0), 1 << 14), kFlatPlanet_m);
  const Horizons horizons = map.At({300.0, -400.0, 0.0});
  for (std::size_t i = 0; i < kHorizonAzimuths; ++i) {
    const double slope = 0.06 * std::cos(HorizonAzimuth(i)) - 0.05 * std::sin(HorizonAzimuth(i));
    EXPECT_NEAR(static_cast<double>(horizons[i]), slope / std::hypot(1.0, slope), 1e-4)
        << "azimuth " << i << "; heights are kept in float";
  }
}

TEST(HorizonMap, HorizonsFollowTheVerticalOfASmallPlanet) {
  // On a planet of 100 km the vertical leans by 0.02 at 2 km from the frame's origin. The plain
  // around is level there: its nearest visible ground lies half a cell's curvature down.
  constexpr double kRadius_m = 1e5;
  const auto sphere = [](double x, double y) { return -(x * x + y * y) / (2.0 * kRadius_m); };
  const HorizonMap map(RasterOf(LandMesh(sphere, 101, 50.0), 1 << 14), kRadius_m);
  for (const float sine : map.At({2000.0, 0.0, 0.0}))
    EXPECT_NEAR(static_cast<double>(sine), -50.0 / (2.0 * kRadius_m), 3e-4);
}

TEST(HorizonMap, IsTheHighestElevationInADirection) {
  const HeightRaster raster = RasterOf(LandMesh(RoughLand, 129, 60.0), 1 << 14);
  const HorizonMap map(raster, kFlatPlanet_m);
  double sum2 = 0.0;
  int count = 0;
  for (int row = 20; row < raster.rows - 20; row += 9) {
    for (int column = 20; column < raster.columns - 20; column += 9) {
      const auto [x, y] = raster.Place(column, row);
      const Horizons horizons = map.At({x, y, 0.0});
      for (std::size_t i = 0; i < kHorizonAzimuths; i += 3) {
        const double east = std::cos(HorizonAzimuth(i)), north = std::sin(HorizonAzimuth(i));
        double highest = -1.0;
        for (double t = raster.cell_m;; t += 0.25 * raster.cell_m) {
          const double at_x = x + t * east, at_y = y + t * north;
          if (std::max(std::abs(at_x), std::abs(at_y)) > 64 * 60.0) break;
          const double rise = RoughLand(at_x, at_y) - RoughLand(x, y);
          highest = std::max(highest, rise / std::hypot(rise, t));
        }
        const double error = static_cast<double>(horizons[i]) -
                             std::max(highest, static_cast<double>(HorizonMap::kLowest));
        sum2 += error * error;
        ++count;
      }
    }
  }
  EXPECT_LT(std::sqrt(sum2 / count), 0.015) << "heights are linear over 60 m of rough land";
}

TEST(HorizonMap, EachNodeHasItsHorizonTowardsAnAzimuth) {
  const HorizonMap map(RasterOf(LandMesh(RoughLand, 33, 120.0), 1 << 12), kFlatPlanet_m);
  constexpr double kAzimuth_rad = 1.0;
  const HeightRaster sines = map.Towards(kAzimuth_rad);
  for (int row = 0; row < sines.rows; row += 5) {
    for (int column = 0; column < sines.columns; column += 3) {
      const auto [x, y] = sines.Place(column, row);
      EXPECT_NEAR(static_cast<double>(sines.at(column, row)),
                  BetweenAzimuths(kAzimuth_rad).Mean(map.At({x, y, 0.0})), 1e-5)
          << "both in float";
    }
  }
}

TEST(HorizonMap, IsTheSameForAnyNumberOfThreads) {
  const TriangleMesh mesh = LandMesh(RoughLand, 65, 120.0);
  static_cast<void>(tests::EqualForAnyNumberOfThreads([&] {
    return HorizonMap(RasterOf(mesh, 1 << 12), kFlatPlanet_m).At({321.0, -123.0, 0.0});
  }));
}

}  // namespace
}  // namespace alpenglow::renderer
