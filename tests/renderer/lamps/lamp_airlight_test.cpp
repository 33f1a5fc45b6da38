// SPDX-License-Identifier: MIT
#include "renderer/lamps/lamp_tree.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "tests/fixtures/airlight_on_surface.h"

namespace alpenglow::renderer {
namespace {

/// Fog over level ground at altitude 0, with the molecules of clear air.
LampAir FogUnderClearAir(double extinction_per_m, double scale_height_m) {
  LampAir air = HomogeneousAir(extinction_per_m, extinction_per_m,
                               {.kind = PhaseKind::kHenyeyGreenstein, .g = 0.8});
  air.layers[0].scale_height_m = scale_height_m;
  air.layers.push_back(air.layers[0]);
  air.layers[1].scale_height_m = 8000.0;
  air.layers[1].scattering_per_m[0] = air.layers[1].extinction_per_m[0] = 1.2e-5;
  air.layers[1].phase = {.kind = PhaseKind::kRayleigh};
  return air;
}

/// By quadrature around the direction to the lamp, finest at it; rays end at the ground.
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

/// Of lamps at three heights, on surfaces at five distances.
template <typename ErrorOf>
GlowError ErrorOver(const ErrorOf& error_of) {
  GlowError result;
  int count = 0;
  for (const double scale_height : {25.0, 100.0}) {
    const LampAir air = FogUnderClearAir(4.3e-3, scale_height);
    for (const double height : {0.35, 6.0, 24.0}) {
      const LampAirlightIrradiance glow(air.layers, height, 0.0);
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

TEST(LampAirlightIrradiance, LevelGroundGetsWhatTheHemisphereSends) {
  const GlowError error =
      ErrorOver([](const LampAir& air, const LampAirlightIrradiance& glow, const Lamp& lamp) {
        return glow.On(lamp.position_m - kPoint, kUpwards, kUpwards)[0] /
                   OverTheHemisphere(air, lamp, kPoint, kUpwards) -
               1.0;
      });
  EXPECT_LT(error.rms, 0.06) << "16 distances and 9 elevations";
  EXPECT_LT(error.most, 0.18);
}

TEST(LampAirlightIrradiance, WallsGetWhatTheirHemisphereSends) {
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

TEST(LampAirlightIrradiance, IsWhatHomogeneousAirGivesWhereTheGroundIsFar) {
  const LampAir air = HomogeneousAir(4e-3, 4e-3, {.kind = PhaseKind::kHenyeyGreenstein, .g = 0.5});
  const LampAirlightIrradiance glow(air.layers, 5000.0, 0.0);
  for (const double cosine : {1.0, 0.5, 0.0}) {
    const glm::dvec3 normal(cosine, std::sqrt(1.0 - cosine * cosine), 0.0);
    const double found = glow.On({30.0, 0.0, 0.0}, normal, kUpwards)[0];
    EXPECT_NEAR(found / AirlightOnSurface(air, 30.0, cosine)[0], 1.0, 0.05) << cosine;
  }
}

TEST(LampAirlightIrradiance, IsFiniteEverywhere) {
  const LampAir air = FogUnderClearAir(0.05, 5.0);
  const LampAirlightIrradiance glow(air.layers, 3.0, 3.0);
  for (const double distance : {0.0, 1e-3, 0.2, 7.0, 3e3, 1e5}) {
    for (const glm::dvec3& towards : {kUpwards, -kUpwards, glm::dvec3(1.0, 0.0, 0.0)}) {
      const double found = glow.On(distance * towards, kUpwards, kUpwards)[0];
      EXPECT_TRUE(std::isfinite(found) && found >= 0.0) << distance;
    }
  }
}

}  // namespace
}  // namespace alpenglow::renderer
