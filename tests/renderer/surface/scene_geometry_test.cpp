// SPDX-License-Identifier: MIT
// Points where rays meet the ground of a scene: horizons, tabulated refracted rays, the skyline.
#include "renderer/surface/scene_geometry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>

#include "atmosphere/math/constants.h"
#include "atmosphere/reference/reference_solution.h"
#include "atmosphere/refraction/refracted_view.h"
#include "renderer/elevation/mesh.h"
#include "renderer/layer.h"
#include "renderer/picture/render.h"
#include "renderer/picture/skyline.h"

namespace alpenglow::renderer {
namespace {

// The angle between neighbouring pixels of a picture with default options.
const double kPixel_rad = Camera{}.fov_rad / RenderSettings{}.width;

// Returns sea level from an eye's foot to beyond its horizon, with a hundred steps each way. Facets
// sink below the ellipsoid by at most the 200,000th part of their distance, a hundredth of a pixel.
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

// Returns the highest elevation [rad] at which ground is seen, by bisection.
double HorizonOf(const std::function<bool(double elevation_rad)>& is_ground) {
  double low = -1.0, high = 0.1;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (is_ground(middle) ? low : high) = middle;
  }
  return low;
}

// Hard case 20.
TEST(SceneGeometry, HorizonsOfEllipsoidAndSphericalSkyAgreeToAPixel) {
  for (const double latitude_deg : {0.0, 45.0, 90.0}) {
    for (const double height_m : {2.0, 10e3, 400e3}) {
      const LocalFrame frame(kWgs84, {latitude_deg, 0.0, 0.0});
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
          return EnuFromAngles(elevation_rad, azimuth_deg * kRadiansPerDegree).xyz;
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
        // The picture has neither a gap nor a second horizon.
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

TEST(SceneGeometry, ThePlanetHidesLandUnlessLandCoversTheWholeWay) {
  const LocalFrame frame(kWgs84, {0.0, 0.0, 0.0});
  const Medium medium = OnOsculatingSphere(MediumPreset("earth"), 0.0);
  // Land from some latitude to 1 degree, below the sphere, with a wall at 100 km. The ray to the
  // wall is inside the sphere from 8 to 85 km.
  const auto kind_from = [&](double south_deg) {
    constexpr double kStep_deg = 0.01;
    ElevationGrid grid;
    grid.rows = static_cast<int>(std::lround((1.0 - south_deg) / kStep_deg)) + 1;
    grid.columns = 11;
    grid.north_rad = kRadiansPerDegree;
    grid.west_rad = -0.05 * kRadiansPerDegree;
    grid.step_lat_rad = grid.step_lon_rad = kStep_deg * kRadiansPerDegree;
    for (int i = 0; i < grid.rows * grid.columns; ++i)
      grid.height_m.push_back(i < 10 * grid.columns ? 3000.0F : -400.0F);
    const SceneGround ground{frame, Terrain(MeshFromElevation(grid, frame)), 2.0, "", true};
    const SceneGeometry geometry(ground, medium, false);
    const glm::dvec3 eye(0.0, 0.0, 2.0);
    const glm::dvec3 wall(0.0, 100e3, 100.0 - 1e10 / (2.0 * geometry.radius_m()));
    return geometry.Trace(eye, glm::normalize(wall - eye), kPixel_rad).kind;
  };
  EXPECT_EQ(kind_from(-0.05), HitKind::kTerrain) << "a basin all the way";
  EXPECT_EQ(kind_from(0.3), HitKind::kPlanet) << "the sea from 5 to 33 km, and land under the ray";
}

TEST(SceneGeometry, HitsLieOnTheRayAndAreLitOnTheSmoothSurface) {
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
  const LocalFrame frame(kWgs84, {45.0, 0.0, 0.0});
  const SceneGround ground{frame, Terrain(MeshFromElevation(grid, frame)), 0.0, "", true};
  const Medium medium = OnOsculatingSphere(MediumPreset("earth"), 45.0 * kRadiansPerDegree);
  const SceneGeometry geometry(ground, medium, true);
  const glm::dvec3 eye(0.0, 0.0, 500.0);
  double farthest_m = 0.0;
  for (int azimuth_deg = 0; azimuth_deg < 360; azimuth_deg += 15) {
    const glm::dvec3 down = EnuFromAngles(-0.6, azimuth_deg * kRadiansPerDegree).xyz;
    const Hit hit = geometry.Trace(eye, down, kPixel_rad);
    ASSERT_EQ(hit.kind, HitKind::kTerrain);
    EXPECT_LT(glm::length(hit.point - (eye + hit.distance_m * down)), 1e-9);
    farthest_m = std::max(farthest_m, glm::length(hit.smooth_point - hit.point));
  }
  EXPECT_GT(farthest_m, 1.0) << "bent slopes lie metres off their triangles; a pattern of the "
                                "ground looked up there slides over the triangles";
}

// Long chords are below their rays, so that they meet more of the ground. Short chords are the
// truth.
TEST(SceneGeometry, LongChordsOfRaysMeetWhatShortOnesMeet) {
  const LocalFrame frame(kWgs84, PlaceFromRadians(0.8, 0.1, 0.0));
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
      const FanRay ray(fan, eye, EnuFromAngles(elevation, azimuth).xyz);
      const Hit truth = pieces.TerrainAlong(ray, kOff_rad, kPixel_rad, 0.0);
      const Hit blind = solid.TerrainAlong(ray, kOff_rad, kPixel_rad, 0.0);
      const Hit guided = solid.TerrainAlong(ray, kOff_rad, kPixel_rad, expected_m);
      if (truth.kind == HitKind::kTerrain) expected_m = truth.distance_m;
      ++met;
      for (const Hit& hit : {blind, guided}) {
        // Seen from the eye, both are within the angle; on ground that a ray almost grazes their
        // distances differ much.
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

constexpr double kMinute = kRadiansPerDegree / 60.0;
const glm::dvec3 kVertical(0.0, 0.0, 1.0);

BendingAir EarthAir() { return BendingAirOf(MediumPreset("earth"), kHorizonWavelength_nm); }

TEST(RefractedFan, PlacesOnRaysAreThoseOfTheRayEquation) {
  const Medium medium = MediumPreset("earth");
  const double radius_m = medium.planet_radius_m;
  const reference::RayEquation equation(medium, reference::PeckAndReeder(kHorizonWavelength_nm));
  const BendingAir air = BendingAirOf(medium, kHorizonWavelength_nm);
  for (const double height_m : {2.0, 1000.0, 3000.0, 12e3, 110e3, 400e3}) {
    const glm::dvec3 eye(0.0, 0.0, height_m);
    const double horizon_m = std::sqrt(height_m * (2.0 * radius_m + height_m));
    const double reach_m = horizon_m + 400e3;
    const RefractedFan fan(air, eye, kVertical, reach_m);
    const double horizon_rad = RefractedView(medium, height_m).horizon_rad();
    for (const double over_minutes : {0.1, 5.0, 30.0, 300.0}) {
      const double elevation = horizon_rad + over_minutes * kMinute;
      const glm::dvec3 towards(0.0, std::cos(elevation), std::sin(elevation));
      const FanRay ray(fan, eye, towards);
      double farthest_off = 0.0;
      for (int i = 1; i <= 40; ++i) {
        const double length_m = std::max(height_m < 100e3 ? 0.0 : horizon_m - 400e3, 0.0) +
                                (height_m < 100e3 ? reach_m : 700e3) * i / 41.0;
        const auto truth = equation.Follow(elevation, height_m, length_m).state;
        const glm::dvec3 place(0.0, truth.x, truth.y - radius_m);
        const double along_m = glm::dot(place - eye, towards);
        farthest_off = std::max(farthest_off, glm::length(ray.At(along_m) - place) / along_m);
      }
      EXPECT_LT(farthest_off / kMinute, 0.1)
          << "a tenth of an arcminute seen from the eye at " << height_m << " m, " << over_minutes
          << "' over the horizon";
    }
  }
}

TEST(RefractedFan, RaysWithoutAirAreStraight) {
  BendingAir air = EarthAir();
  air.refractivity = 0.0;
  const glm::dvec3 eye(0.0, 0.0, 1000.0);
  const RefractedFan fan(air, eye, kVertical, 100e3);
  const glm::dvec3 towards = glm::normalize(glm::dvec3(0.3, 0.9, -0.02));
  EXPECT_LT(glm::length(FanRay(fan, eye, towards).At(90e3) - eye - 90e3 * towards), 1e-6)
      << "the rounding of places of 90 km";
}

TEST(RefractedFan, ChordsAreBelowTheirRayByNoMoreThanTheLimit) {
  const BendingAir air = EarthAir();
  const glm::dvec3 eye(0.0, 0.0, 500.0);
  const RefractedFan fan(air, eye, kVertical, 200e3);
  constexpr double kOff_rad = 0.1 * kMinute;
  for (const double elevation : {-0.01, -0.005, 0.0, 0.01, 0.1}) {
    const FanRay ray(fan, eye, {0.0, std::cos(elevation), std::sin(elevation)});
    const auto over_chord = [&](double from_m, double to_m, double share) {
      const glm::dvec3 chord = (1.0 - share) * ray.At(from_m) + share * ray.At(to_m);
      return (ray.At(from_m + share * (to_m - from_m)) - chord).z;
    };
    for (const double from_m : {0.0, 10e3, 50e3}) {
      const double to_m = from_m + fan.ChordFrom(from_m, kOff_rad);
      for (const double share : {0.1, 0.5, 0.9}) {
        const double over_m = over_chord(from_m, to_m, share);
        EXPECT_GT(over_m, -1e-3) << "tables are linear between their nodes";
        EXPECT_LT(over_m, kOff_rad * (from_m + share * (to_m - from_m)) + kOff_rad * 1e3)
            << "from " << from_m << " m, elevation " << elevation;
      }
      const double before_end_m = 150e3 - fan.EndOfChord(kOff_rad);
      EXPECT_LT(over_chord(0.0, 150e3, before_end_m / 150e3), kOff_rad * before_end_m)
          << "the end of a long one";
    }
  }
}

TEST(RefractedFan, DistancesToHeightsAreThoseOfTheRays) {
  const BendingAir air = EarthAir();
  const glm::dvec3 eye(0.0, 0.0, 1400.0);
  const RefractedFan fan(air, eye, kVertical, 200e3);
  const auto height_at = [&](const FanRay& ray, double along_m) {
    return glm::length(ray.At(along_m) + glm::dvec3(0.0, 0.0, air.planet_radius_m)) -
           air.planet_radius_m;
  };
  for (const double elevation : {-1.5, -0.3, -0.05, -0.02}) {
    const FanRay ray(fan, eye, {std::cos(elevation), 0.0, std::sin(elevation)});
    EXPECT_LT(height_at(ray, fan.SinksBelow(ray, 200.0)), 200.0) << elevation;
  }
  const FanRay over_ground(fan, eye, {std::cos(-0.001), 0.0, std::sin(-0.001)});
  EXPECT_TRUE(std::isinf(fan.SinksBelow(over_ground, 200.0))) << "it passes over the horizon";
  for (const double elevation : {0.01, 0.1, 1.0}) {
    const FanRay ray(fan, eye, {std::cos(elevation), 0.0, std::sin(elevation)});
    const double along_m = fan.RisesAbove(ray, 1600.0);
    EXPECT_GE(height_at(ray, along_m), 1600.0) << elevation;
    EXPECT_GT(height_at(ray, 1.5 * along_m), height_at(ray, along_m)) << elevation;
  }
}

const glm::dvec3 kLeaningUp = glm::normalize(glm::dvec3(0.02, -0.01, 1.0));
constexpr double kStep_rad = 0.002;

/// Returns the elevation of ridges around an eye; the azimuth is from the frame's x over y.
double RidgeAt(double azimuth_rad) {
  return 0.1 + 0.08 * std::sin(3.0 * azimuth_rad) + 0.02 * std::sin(40.0 * azimuth_rad);
}

double ElevationOver(const glm::dvec3& direction) {
  return std::asin(std::clamp(glm::dot(direction, kLeaningUp), -1.0, 1.0));
}

bool SeesSky(const glm::dvec3& direction) {
  return ElevationOver(direction) > RidgeAt(Skyline::AzimuthOf(direction, kLeaningUp));
}

/// Visits some thousand directions over the sphere.
template <typename Visit>
void VisitDirections(const Visit& visit) {
  for (double azimuth = -3.1; azimuth < 3.1; azimuth += 0.037) {
    for (double elevation = -0.3; elevation < 1.5; elevation += 0.0173) {
      visit(glm::dvec3(std::cos(elevation) * std::cos(azimuth),
                       std::cos(elevation) * std::sin(azimuth), std::sin(elevation)));
    }
  }
}

TEST(Skyline, DirectionsAboveItSeeSkyAllAround) {
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

TEST(Skyline, SkyFarAboveItIsRecognised) {
  const Skyline skyline(kLeaningUp, {0.0, 2.0 * kPi}, kStep_rad, SeesSky);
  VisitDirections([&](const glm::dvec3& direction) {
    if (ElevationOver(direction) < 0.25) return;
    EXPECT_TRUE(skyline.IsBelow(direction, 0.02)) << "0.03 over the highest ridge";
  });
}

TEST(Skyline, DirectionsOutsideItsArcAreUnknown) {
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
