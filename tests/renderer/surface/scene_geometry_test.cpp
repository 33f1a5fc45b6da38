// SPDX-License-Identifier: MIT
#include "renderer/surface/scene_geometry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "atmosphere/math/constants.h"
#include "atmosphere/refraction/refracted_view.h"
#include "renderer/picture/render.h"
#include "renderer/terrain/mesh.h"

namespace alpenglow::renderer {
namespace {

// Between neighbouring pixels of a picture that nobody has asked for a size or a view.
const double kPixel_rad = Camera{}.fov_rad / RenderSettings{}.width;

// Sea level from an eye's foot to beyond its horizon, a hundred steps each way. Facets sink below
// the ellipsoid by at most the 200,000th part of their distance, a hundredth of a pixel.
ElevationGrid SeaLevelAround(double latitude_deg, double height_m) {
  constexpr double kRadius_m = 6.37e6;
  const double reach_deg = 1.15 * std::acos(kRadius_m / (kRadius_m + height_m)) / kRadiansPerDegree;
  constexpr int kSteps = 100;
  const double lat_step_deg = reach_deg / kSteps;
  ElevationGrid grid;
  grid.step_lat_rad = lat_step_deg * kRadiansPerDegree;
  if (latitude_deg == 90.0) {
    grid.rows = kSteps;
    grid.columns = 360;
    grid.north_rad = (90.0 - 0.5 * lat_step_deg) * kRadiansPerDegree;
    grid.west_rad = -kPi;
    grid.step_lon_rad = kRadiansPerDegree;
  } else {
    const double poleward_deg = std::abs(latitude_deg) + reach_deg;
    grid.rows = grid.columns = 2 * kSteps + 1;
    grid.step_lon_rad = grid.step_lat_rad / std::cos(poleward_deg * kRadiansPerDegree);
    grid.north_rad = latitude_deg * kRadiansPerDegree + kSteps * grid.step_lat_rad;
    grid.west_rad = -kSteps * grid.step_lon_rad;
  }
  grid.height_m.assign(static_cast<std::size_t>(grid.rows) * static_cast<std::size_t>(grid.columns),
                       0.0F);
  return grid;
}

// The highest elevation [rad] that is still seen to be ground, by halving.
double HorizonOf(const std::function<bool(double elevation_rad)>& is_ground) {
  double low = -1.0, high = 0.1;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (is_ground(middle) ? low : high) = middle;
  }
  return low;
}

// Hard case 20.
TEST(SceneGeometry, TheHorizonOfTheEllipsoidsGroundIsThatOfTheSphericalSkyWithinAPixel) {
  for (const double latitude_deg : {0.0, 45.0, 90.0}) {
    for (const double height_m : {2.0, 10e3, 400e3}) {
      const LocalFrame frame(kWgs84, {latitude_deg * kRadiansPerDegree, 0.0, 0.0});
      const SceneGround ground{
          frame, Terrain(MeshFromElevation(SeaLevelAround(latitude_deg, height_m), frame)),
          height_m, "", true};
      const SceneGround bare{frame, std::nullopt, height_m, "", true};
      const Medium medium =
          OnOsculatingSphere(MediumPreset("earth"), latitude_deg * kRadiansPerDegree);
      const SceneGeometry with_ground(ground, medium, false), sky(bare, medium, false);
      const glm::dvec3 eye(0.0, 0.0, height_m);
      for (int azimuth_deg = 0; azimuth_deg < 360; azimuth_deg += 45) {
        SCOPED_TRACE(::testing::Message() << "latitude " << latitude_deg << ", " << height_m
                                          << " m, azimuth " << azimuth_deg);
        const auto towards = [&](double elevation_rad) {
          return DirectionFromAngles(elevation_rad, azimuth_deg * kRadiansPerDegree).xyz;
        };
        const double of_ground = HorizonOf([&](double elevation_rad) {
          return ground.terrain->Intersect(eye, towards(elevation_rad)).has_value();
        });
        const double of_sky = HorizonOf([&](double elevation_rad) {
          return sky.Trace(eye, towards(elevation_rad), kPixel_rad).kind == HitKind::kPlanet;
        });
        EXPECT_NEAR(of_ground, of_sky, kPixel_rad)
            << "seen from space the ellipsoid's horizon lies up to 0.032 degrees beside that of "
               "the sphere that osculates it";
        // And in the picture there is neither a gap nor a second horizon.
        int changes = 0;
        bool was_sky = false;
        for (double step = -5.0; step <= 5.0; step += 0.125) {
          const HitKind kind =
              with_ground.Trace(eye, towards(of_sky + step * kPixel_rad), kPixel_rad).kind;
          changes += (kind == HitKind::kSky) != was_sky ? 1 : 0;
          was_sky = kind == HitKind::kSky;
          if (std::abs(step) < 1.0) continue;
          EXPECT_EQ(was_sky, step > 0.0) << step << " pixels up";
        }
        EXPECT_EQ(changes, 1);
      }
    }
  }
}

TEST(SceneGeometry, WhatTheGroundIsMadeOfIsLookedUpWhereTheRayMeetsItAndLitOnTheSmoothSurface) {
  constexpr double kCell_m = 50.0, kWave_m = 30.0;
  ElevationGrid grid = SeaLevelAround(45.0, 0.01);
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column)
      grid.height_m[static_cast<std::size_t>(row * grid.columns + column)] =
          static_cast<float>(kWave_m * std::sin(0.7 * row) * std::sin(0.5 * column));
  }
  grid.step_lat_rad = grid.step_lon_rad = kCell_m / 6.37e6;
  grid.north_rad = 45.0 * kRadiansPerDegree + 100 * grid.step_lat_rad;
  grid.west_rad = -100 * grid.step_lon_rad;
  const LocalFrame frame(kWgs84, {45.0 * kRadiansPerDegree, 0.0, 0.0});
  const SceneGround ground{frame, Terrain(MeshFromElevation(grid, frame)), 0.0, "", true};
  const Medium medium = OnOsculatingSphere(MediumPreset("earth"), 45.0 * kRadiansPerDegree);
  const SceneGeometry geometry(ground, medium, true);
  const glm::dvec3 eye(0.0, 0.0, 500.0);
  double farthest_m = 0.0;
  for (int azimuth_deg = 0; azimuth_deg < 360; azimuth_deg += 15) {
    const glm::dvec3 down = DirectionFromAngles(-0.6, azimuth_deg * kRadiansPerDegree).xyz;
    const Hit hit = geometry.Trace(eye, down, kPixel_rad);
    ASSERT_EQ(hit.kind, HitKind::kTerrain);
    EXPECT_LT(glm::length(hit.point - (eye + hit.distance_m * down)), 1e-9);
    farthest_m = std::max(farthest_m, glm::length(hit.smooth_point - hit.point));
  }
  EXPECT_GT(farthest_m, 1.0) << "bent slopes lie metres off their triangles; a pattern of the "
                                "ground looked up there slides over the triangles";
}

// Long chords are below their rays, so that they meet more of the ground; short ones show what is
// there.
TEST(SceneGeometry, LongChordsOfRefractedRaysMeetWhatShortOnesMeet) {
  const LocalFrame frame(kWgs84, {0.8, 0.1, 0.0});
  ElevationGrid grid;
  grid.rows = grid.columns = 121;
  grid.step_lat_rad = grid.step_lon_rad = 1.5e-4;  // 1 km
  grid.north_rad = 0.8 + 60 * grid.step_lat_rad;
  grid.west_rad = 0.1 - 60 * grid.step_lon_rad;
  for (int i = 0; i < grid.rows * grid.columns; ++i) {
    const double x = i % grid.columns, y = i / grid.columns;
    grid.height_m.push_back(static_cast<float>(900.0 +
                                               500.0 * std::sin(0.31 * x) * std::cos(0.23 * y) +
                                               300.0 * std::sin(1.1 * x + 0.7 * y)));
  }
  constexpr double kEye_m = 1800.0, kOff_rad = 0.05 * kRadiansPerDegree / 60.0;
  const auto made = [&](bool is_solid) {
    return SceneGround{frame, Terrain(MeshFromElevation(grid, frame)), kEye_m, "", true, is_solid};
  };
  const SceneGround solid_ground = made(true), ground = made(false);
  const Medium medium = OnOsculatingSphere(MediumPreset("earth"), 0.8);
  const SceneGeometry solid(solid_ground, medium, false), pieces(ground, medium, false);
  const glm::dvec3 eye(0.0, 0.0, kEye_m);
  const RefractedFan fan(BendingAirOf(medium, kHorizonWavelength_nm), eye, {0.0, 0.0, 1.0},
                         pieces.FarthestFrom(eye));
  int met = 0, other = 0;
  double expected_m = 0.0;
  for (double azimuth = 0.0; azimuth < 6.28; azimuth += 0.13) {
    for (double elevation = -0.2; elevation < 0.01; elevation += 0.0007) {
      const FanRay ray(fan, eye, DirectionFromAngles(elevation, azimuth).xyz);
      const Hit truth = pieces.TerrainAlong(ray, kOff_rad, kPixel_rad, 0.0);
      const Hit blind = solid.TerrainAlong(ray, kOff_rad, kPixel_rad, 0.0);
      const Hit guided = solid.TerrainAlong(ray, kOff_rad, kPixel_rad, expected_m);
      if (truth.kind == HitKind::kTerrain) expected_m = truth.distance_m;
      ++met;
      for (const Hit& hit : {blind, guided}) {
        // Seen from the eye, both are within the angle of where the ray is; over ground that a ray
        // all but grazes that is far apart.
        const bool is_same =
            hit.kind == truth.kind &&
            (hit.kind == HitKind::kSky ||
             std::abs(hit.distance_m - truth.distance_m) < 0.01 * truth.distance_m);
        if (!is_same) ++other;
      }
    }
  }
  EXPECT_GT(met, 10000);
  EXPECT_LT(other, met / 200) << "rays that graze a ridge";
}

}  // namespace
}  // namespace alpenglow::renderer
