// SPDX-License-Identifier: MIT
// Groups of lamps that count as one: their errors against all lamps, and the glow of the air around
// lamps on surfaces.
#include "renderer/lamps/lamp_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "atmosphere/math/constants.h"
#include "atmosphere/math/error_statistics.h"
#include "atmosphere/math/numerics.h"
#include "renderer/lamps/lamp_light.h"
#include "renderer/lamps/placed_lamp.h"
#include "tests/fixtures/airlight_on_surface.h"
#include "tests/fixtures/fog_under_clear_air.h"
#include "tests/fixtures/lamp_night.h"
#include "tests/fixtures/media.h"
#include "tests/fixtures/sanitized.h"
#include "tests/fixtures/wall_folder.h"

namespace alpenglow::renderer {
namespace {

using tests::FogOver;
using tests::kLampEye_m;
using tests::LampSite;
using tests::LightAt;
using tests::NightScene;
using tests::RunwayScene;
using tests::SpotOf;

class LampPlans : public tests::WallFolder {
 protected:
  /// Returns a scene with the wall in air that scatters so little that shade is dark.
  [[nodiscard]] Scene InThinAir() const {
    Scene scene = WallScene(-0.3);
    for (auto* of_band : {&scene.medium.rayleigh_scattering_per_m,
                          &scene.medium.mie_scattering_per_m, &scene.medium.mie_extinction_per_m}) {
      for (double& value : *of_band) value *= 1e-3;
    }
    return scene;
  }
  /// Adds a row of lamps next to the eye, which light the plain ahead.
  static void AddDimLamps(Scene& scene, double candela) {
    for (int i = -10; i <= 10; ++i) scene.lights.push_back(LightAt(-10.0, 6.0 * i, 8.0, candela));
  }
};

constexpr double kEndless = std::numeric_limits<double>::infinity();

/// The light of a plan's lamps and of all lamps in some pixels of a picture.
struct PlannedLight {
  std::vector<std::array<double, 2>> found_and_all;

  /// Returns the largest error relative to all lamps, or to a share of the brightest pixel.
  [[nodiscard]] double Worst(double share_of_brightest = 0.0) const {
    double brightest = 0.0, worst = 0.0;
    for (const auto& [found, all] : found_and_all) brightest = std::max(brightest, all);
    for (const auto& [found, all] : found_and_all)
      worst =
          std::max(worst, std::abs(found - all) / std::max(all, share_of_brightest * brightest));
    return worst;
  }
  [[nodiscard]] double Rms() const {
    std::vector<double> errors;
    for (const auto& [found, all] : found_and_all) errors.push_back(found / all - 1.0);
    return RmsOf(errors);
  }
};

/// A picture, and every how many of its columns and rows a pixel is compared.
struct PlannedPicture {
  int width = 160, height = 96, columns = 7, rows = 5;
};

/// Compares light on terrain.
PlannedLight OnSurfaces(const Scene& scene, const PlannedPicture& picture = {}) {
  const LampSite site(scene);
  const CameraRays camera(scene.camera, picture.width, picture.height, FromSceneEye(site.ground));
  const auto hit = [&](const CameraRay& ray) {
    return site.ground.terrain->Intersect(ray.origin, ray.direction);
  };
  const LampPlan plan =
      site.light.PlanFor(camera, picture.width, picture.height, {}, [&](const CameraRay& ray) {
        const auto end = hit(ray);
        return end ? end->distance_m : kEndless;
      });
  PlannedLight light;
  for (int y = 1; y < picture.height; y += picture.rows) {
    for (int x = 2; x < picture.width; x += picture.columns) {
      const CameraRay ray = camera.MiddleRay(x + 0.5, y + 0.5);
      const auto end = hit(ray);
      if (!end) continue;
      const LitPoint at{ray.origin + end->distance_m * ray.direction, end->smooth_point,
                        end->normal, end->geometric_normal};
      light.found_and_all.push_back(
          {site.Luminance(site.light.OnSurface(plan.At(x, y).surface, at)),
           site.Luminance(site.light.OnSurface(site.light.All(), at))});
    }
  }
  return light;
}

/// Compares light in the air along rays that end where `trace` says, or at the terrain.
PlannedLight InTheAir(const Scene& scene, const PlannedPicture& picture = {},
                      RayTrace trace = nullptr) {
  const LampSite site(scene);
  const CameraRays camera(scene.camera, picture.width, picture.height, FromSceneEye(site.ground));
  if (!trace) {
    trace = [&](const CameraRay& ray) {
      const auto end = site.ground.terrain->Intersect(ray.origin, ray.direction);
      return end ? end->distance_m : kEndless;
    };
  }
  const LampPlan plan = site.light.PlanFor(camera, picture.width, picture.height, {}, trace);
  PlannedLight light;
  for (int y = 1; y < picture.height; y += picture.rows) {
    for (int x = 2; x < picture.width; x += picture.columns) {
      const CameraRay ray = camera.MiddleRay(x + 0.5, y + 0.5);
      const LampRayEnd end{ray.direction, trace(ray)};
      light.found_and_all.push_back(
          {site.Luminance(site.light.InAir(plan, x, y, end, camera.PixelAngle(), 12)),
           site.InAir(end.direction, end.length_m, 12, camera.PixelAngle())});
    }
  }
  return light;
}

TEST_F(LampPlans, ABrightLampBehindTheWallTakesNothingFromDimOnes) {
  Scene scene = InThinAir();
  scene.lights = {LightAt(110.0, 0.0, 10.0, 1e4)};
  AddDimLamps(scene, 0.03);
  EXPECT_LT(OnSurfaces(scene).Worst(), 0.03)
      << "the error is 0.5 % of the light where lamps shine, and of the glow elsewhere";
}

TEST_F(LampPlans, ARowOfLampsAcrossTheEndOfTheWallIsNotOneLamp) {
  Scene scene = InThinAir();
  for (int i = -20; i < 40; ++i) scene.lights.push_back(LightAt(130.0, i, 10.0, 100.0));
  EXPECT_LT(OnSurfaces(scene).Worst(), 0.03) << "also where two of sixty lamps shine";
  scene = WallScene(-0.3);
  scene.layers = {FogOver(0.0, 0.002, kEndless)};
  for (int i = 0; i < 8; ++i) scene.lights.push_back(LightAt(130.0, 24.0 + 2.0 * i, 10.0, 100.0));
  EXPECT_LT(InTheAir(scene).Worst(0.01), 0.05)
      << "edges of shade are found to 1/768 of a ray's angle; dim light counts from a hundredth of "
         "the brightest";
}

TEST_F(LampPlans, ABrightLampThatGrazesTheGroundTakesNothingFromDimOnes) {
  Scene scene = InThinAir();
  scene.lights = {LightAt(-500.0, 0.0, 0.1, 1e5)};  // its rays meet the ground at 0.15 mrad
  AddDimLamps(scene, 0.01);
  EXPECT_LT(OnSurfaces(scene).Worst(), 0.03)
      << "the error is a share of the light on the ground, not on a surface that faces the lamp";
}

TEST_F(LampPlans, ABeamThatShinesElsewhereTakesNothingFromDimLamps) {
  Scene scene = InThinAir();
  scene.lights = {SpotOf(LightAt(-60.0, 0.0, 30.0, 1e5), 0.2, 0.4)};
  scene.lights[0].pitch_rad = 0.5 * kPi;
  AddDimLamps(scene, 0.005);
  EXPECT_LT(OnSurfaces(scene).Worst(), 0.03) << "all of the beam's light goes up";
}

/// Rays end at a plane below the eye.
RayTrace ToPlane(double below_m) {
  return [below_m](const CameraRay& ray) {
    const double z = ray.direction.z;
    return z < 0.0 ? below_m / -z : kEndless;
  };
}

void ExpectAsGoodAsAll(const PlannedLight& light) {
  EXPECT_LT(light.Rms(), 0.01) << "an error of 0.5 % of the light, and lattices";
  EXPECT_LT(light.Worst(), 0.05);
}

TEST_F(LampPlans, NodesAreAsGoodAsAllTheirLamps) {
  ExpectAsGoodAsAll(InTheAir(RunwayScene(), {160, 90, 13, 9}, ToPlane(kLampEye_m)));
}

TEST_F(LampPlans, ALampNearARayIsNotLostAmongFarLamps) {
  // The eye is six metres over the grass, 75 m beside a runway that runs east: lamps of one group
  // lie on both sides of rays that pass near some of them.
  constexpr double kGround_m = kLampEye_m - 6.0;
  Scene scene = NightScene();
  scene.layers = {FogOver(kGround_m, 0.0043, 25.0)};
  const auto add = [&](double along_m, double left_m, double candela) {
    scene.lights.push_back(LightAt(left_m + 75.0, along_m - 620.0, kGround_m + 0.35, candela));
  };
  for (int i = 0; i <= 30; ++i) {
    for (const double side : {-23.0, 23.0}) add(60.0 * i, side, 800.0);
  }
  for (int i = 0; i < 60; ++i) add(30.0 * i, 0.0, 500.0);
  for (int i = -7; i <= 7; ++i) {
    add(0.0, 3.0 * i, 700.0);
    add(1800.0, 3.0 * i, 250.0);
  }
  for (int i = 1; i <= 10; ++i) {
    for (int j = -2; j <= 2; ++j) add(-30.0 * i, 1.2 * j, 900.0);
  }
  scene.camera.heading_rad = 5.04;
  // The lamps are 0 to 4.4 degrees below the horizon, in the rows of this strip.
  scene.camera.pitch_rad = -0.02;
  scene.camera.fov_rad = 0.91;
  const PlannedPicture whole{960, 120, 26, 9}, coarse{480, 60, 26, 9};
  ExpectAsGoodAsAll(InTheAir(scene, tests::ScaledDown(whole, coarse), ToPlane(6.0)));
}

TEST_F(LampPlans, TenTimesTheLampsCostThreeTimesAsMuch) {
  std::vector<double> nodes;
  for (const int rows : {50, tests::ScaledDown(500, 100)}) {
    const LampSite site(RunwayScene(rows));
    const CameraRays camera(site.scene.camera, 320, 180);
    // The left half of the picture.
    const LampPlan plan = site.light.PlanFor(camera, 160, 180, {}, ToPlane(kLampEye_m));
    nodes.push_back(0.0);
    for (const LampTile& tile : plan.tiles)
      nodes.back() += static_cast<double>(tile.near_air.size() + tile.far_air.size());
  }
  EXPECT_LT(nodes[1], 3.0 * nodes[0]) << "nodes that tiles see, of 100 and of 1000 lamps";
}

TEST_F(LampPlans, LampsThatDaylightOutshinesCostNothing) {
  const LampSite site(RunwayScene());
  const LampSettings day{.nodes = 12, .share_of_error = 5e-3, .floor_cd_per_m2 = 1e4};
  const LampPlan plan = site.light.PlanFor(CameraRays(site.scene.camera, 64, 36), 64, 36, day,
                                           [](const CameraRay&) { return kEndless; });
  for (const LampTile& tile : plan.tiles)
    EXPECT_TRUE(tile.near_air.empty() && tile.far_air.empty());
}

/// Returns the irradiance by quadrature around the direction to the lamp, with the smallest steps
/// there. Rays end at the ground.
double OverTheHemisphere(const LampAir& air, const Lamp& lamp, const glm::dvec3& point,
                         const glm::dvec3& normal) {
  const glm::dvec3 towards = glm::normalize(lamp.position_m - point);
  const glm::dvec3 side = glm::normalize(glm::cross(towards, glm::dvec3(0.1, 1.0, 0.0)));
  const glm::dvec3 other = glm::cross(towards, side);
  constexpr std::array<double, 7> kCuts{0.0, 0.02, 0.1, 0.3, 0.8, 1.6, kPi};
  constexpr int kTurns = 32;
  const GaussRule& rule = GaussLegendre(8);
  double sum = 0.0;
  for (std::size_t piece = 0; piece + 1 < kCuts.size(); ++piece) {
    const double width = kCuts[piece + 1] - kCuts[piece];
    for (std::size_t i = 0; i < rule.node.size(); ++i) {
      const double alpha = kCuts[piece] + width * rule.node[i];
      for (int turn = 0; turn < kTurns; ++turn) {
        const double phi = 2.0 * kPi * (turn + 0.5) / kTurns;
        LampSegment ray;
        ray.origin_m = point;
        ray.direction = std::cos(alpha) * towards +
                        std::sin(alpha) * (std::cos(phi) * side + std::sin(phi) * other);
        const double facing = glm::dot(ray.direction, normal);
        if (facing <= 0.0) continue;
        ray.end_m = 3e4;
        if (ray.direction.z < 0.0) ray.end_m = std::min(ray.end_m, point.z / -ray.direction.z);
        sum += rule.weight[i] * width * std::sin(alpha) * 2.0 * kPi / kTurns * facing *
               Airlight(air, lamp, ray, 24)[0];
      }
    }
  }
  return sum;
}

struct GlowError {
  double rms = 0.0, most = 0.0;
};

/// Returns errors of lamps at three heights, on surfaces at five distances.
template <typename ErrorOf>
GlowError ErrorOver(const ErrorOf& error_of) {
  GlowError result;
  int count = 0;
  for (const double scale_height : {25.0, 100.0}) {
    const LampAir air = tests::FogUnderClearAir(4.3e-3, scale_height, tests::LobeOf(0.8));
    for (const double height : {0.35, 6.0, 24.0}) {
      const LampAirlightIrradiance glow(air.layers, tests::kLampPlanet_m, height, 0.0);
      for (const double distance : {5.0, 20.0, 60.0, 200.0, 600.0}) {
        Lamp lamp;
        lamp.position_m = {distance, 0.0, height};
        const double error = error_of(air, glow, lamp);
        result.rms += error * error;
        result.most = std::max(result.most, std::abs(error));
        ++count;
      }
    }
  }
  result.rms = std::sqrt(result.rms / count);
  return result;
}

constexpr glm::dvec3 kUpwards(0.0, 0.0, 1.0);
constexpr glm::dvec3 kPoint(0.0, 0.0, 1e-3);

TEST(LampAirlightIrradiance, OnLevelGroundIsTheLightOfTheHemisphere) {
  const GlowError error =
      ErrorOver([](const LampAir& air, const LampAirlightIrradiance& glow, const Lamp& lamp) {
        return glow.On(lamp.position_m - kPoint, kUpwards, kUpwards)[0] /
                   OverTheHemisphere(air, lamp, kPoint, kUpwards) -
               1.0;
      });
  EXPECT_LT(error.rms, 0.06) << "16 distances and 9 elevations";
  EXPECT_LT(error.most, 0.18);
}

TEST(LampAirlightIrradiance, OnWallsIsTheLightOfTheirHemisphere) {
  const GlowError error =
      ErrorOver([](const LampAir& air, const LampAirlightIrradiance& glow, const Lamp& lamp) {
        double worst = 0.0, brightest = 0.0;
        for (const glm::dvec3& normal :
             {glm::dvec3(1.0, 0.0, 0.2), glm::dvec3(0.3, 1.0, 0.2), glm::dvec3(-1.0, 0.0, 0.5)}) {
          const glm::dvec3 unit = glm::normalize(normal);
          const double truth = OverTheHemisphere(air, lamp, kPoint, unit);
          const double found = glow.On(lamp.position_m - kPoint, unit, kUpwards)[0];
          brightest = std::max(brightest, truth);
          worst = std::abs(found - truth) > std::abs(worst) ? found - truth : worst;
        }
        return worst / brightest;
      });
  EXPECT_LT(error.rms, 0.12) << "the worst of three walls; moments to degree 6 of light that the "
                                "horizon cuts";
  EXPECT_LT(error.most, 0.18);
}

TEST(LampAirlightIrradiance, FarFromTheGroundIsThatOfHomogeneousAir) {
  const LampAir air = HomogeneousAir(4e-3, 4e-3, tests::LobeOf(0.5));
  const LampAirlightIrradiance glow(air.layers, tests::kLampPlanet_m, 5000.0, 0.0);
  for (const double cosine : {1.0, 0.5, 0.0}) {
    const glm::dvec3 normal(cosine, std::sqrt(1.0 - cosine * cosine), 0.0);
    const double found = glow.On({30.0, 0.0, 0.0}, normal, kUpwards)[0];
    EXPECT_NEAR(found / AirlightOnSurface(air, 30.0, cosine)[0], 1.0, 0.05) << cosine;
  }
}

TEST(LampAirlightIrradiance, IsFiniteEverywhere) {
  const LampAir air = tests::FogUnderClearAir(0.05, 5.0, tests::LobeOf(0.8));
  const LampAirlightIrradiance glow(air.layers, tests::kLampPlanet_m, 3.0, 3.0);
  for (const double distance : {0.0, 1e-3, 0.2, 7.0, 3e3, 1e5}) {
    for (const glm::dvec3& towards : {kUpwards, -kUpwards, glm::dvec3(1.0, 0.0, 0.0)}) {
      const double found = glow.On(distance * towards, kUpwards, kUpwards)[0];
      EXPECT_TRUE(std::isfinite(found) && found >= 0.0) << distance;
    }
  }
}

}  // namespace
}  // namespace alpenglow::renderer
