// SPDX-License-Identifier: MIT
// Irradiance of slopes by the map of a lamp's airlight, against LampAirlightIrradiance.
#include "renderer/lamps/sampled_glow.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/vec3.hpp>

#include "atmosphere/lamp/lamp.h"
#include "atmosphere/math/constants.h"
#include "tests/fixtures/lamp_site.h"
#include "tests/fixtures/media.h"

namespace alpenglow::renderer {
namespace {

constexpr glm::dvec3 kGlowUp(0.0, 0.0, 1.0);

LampLayer LayerOf(double per_m, double scale_height_m, const PhaseFunction& phase) {
  LampLayer layer;
  layer.scale_height_m = scale_height_m;
  layer.scattering_per_m = layer.extinction_per_m = SpectrumOf<double>(1);
  layer.scattering_per_m[0] = layer.extinction_per_m[0] = per_m;
  layer.phase = phase;
  return layer;
}

std::vector<LampLayer> ClearAir() {
  return {LayerOf(1.2e-5, 8000.0, {.kind = PhaseKind::kRayleigh}),
          LayerOf(4.0e-5, 1200.0, tests::LobeOf(0.7))};
}

std::vector<LampLayer> LightFog() {
  std::vector<LampLayer> layers = ClearAir();
  layers.push_back(LayerOf(4e-3, 25.0, tests::LobeOf(0.8)));
  return layers;
}

/// A lamp's glow and its map, at one texel.
struct Texel {
  const LampAirlightIrradiance& glow;
  const std::vector<glm::vec4>& map;
  int distance, rise;

  [[nodiscard]] double Term(int term) const {
    return static_cast<double>(
        map[static_cast<std::size_t>((term * kGlowRises + rise) * kGlowDistances + distance)][0]);
  }
  [[nodiscard]] double Far() const {
    constexpr double kNearest_m = LampAirlightIrradiance::kNearest_m;
    return kNearest_m * std::pow(LampAirlightIrradiance::kFarthest_m / kNearest_m,
                                 distance / (kGlowDistances - 1.0));
  }
  [[nodiscard]] double ByMap(const glm::dvec3& normal) const {
    return std::exp(Term(0)) / Far() *
           shared::LampAirlightOnSlope(normal.x, normal.z, Term(1), Term(2), Term(3), Term(4),
                                       Term(5));
  }
  [[nodiscard]] double ByGlow(const glm::dvec3& normal) const {
    return glow.On(glow.ToLamp(Far(), shared::LampRiseFromUnit(rise / (kGlowRises - 1.0))), normal,
                   kGlowUp)[0];
  }
};

struct SlopeDeviation {
  double rms = 0.0, most = 0.0;
};

/// Over slopes between two tilts, the lamp 20 m to 2 km away; relative to what the slope gets, but
/// at least a tenth of what the slope of them does that gets most.
SlopeDeviation OverSlopes(const LampAirlightIrradiance& glow, const std::vector<glm::vec4>& map,
                          std::array<double, 2> tilts_deg, std::array<int, 2> rises) {
  constexpr int kTilts = 4, kTurns = 12;
  SlopeDeviation deviation;
  int count = 0;
  for (int distance = 24; distance <= 48; ++distance) {
    for (int rise = rises[0]; rise <= rises[1]; ++rise) {
      const Texel texel{glow, map, distance, rise};
      std::vector<std::array<double, 2>> both;
      double most = 0.0;
      for (int i = 0; i < kTilts; ++i) {
        const double tilt =
            kRadiansPerDegree * (tilts_deg[0] + (tilts_deg[1] - tilts_deg[0]) * i / (kTilts - 1.0));
        for (int k = 0; k < kTurns; ++k) {
          const double turn = 2.0 * kPi * k / kTurns;
          const glm::dvec3 normal(std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn),
                                  std::cos(tilt));
          both.push_back({texel.ByMap(normal), texel.ByGlow(normal)});
          most = std::max(most, both.back()[1]);
        }
      }
      for (const auto& [found, truth] : both) {
        const double relative = std::abs(found - truth) / std::max(truth, 0.1 * most);
        deviation.rms += relative * relative;
        deviation.most = std::max(deviation.most, relative);
        ++count;
      }
    }
  }
  deviation.rms = std::sqrt(deviation.rms / count);
  return deviation;
}

constexpr std::array<int, 2> kAllRises{4, 28};  // sines of -0.6 to 0.6

TEST(LampAirlightMap, LevelGroundHasTheLightOfLampAirlight) {
  const LampAirlightIrradiance glow(ClearAir(), tests::kLampPlanet_m, 1500.0, 1494.0);
  const std::vector<glm::vec4> map = SampledGlow(glow);
  for (int distance = 0; distance <= 48; distance += 6) {
    for (int rise = 16; rise < kGlowRises; rise += 3) {
      const Texel texel{glow, map, distance, rise};
      EXPECT_NEAR(texel.ByMap(kGlowUp) / texel.ByGlow(kGlowUp), 1.0, 1e-5)
          << "logarithms are floats";
    }
  }
}

TEST(LampAirlightMap, SlopesInClearAirHaveTheLightOfLampAirlight) {
  const LampAirlightIrradiance glow(ClearAir(), tests::kLampPlanet_m, 1500.0, 1494.0);
  const std::vector<glm::vec4> map = SampledGlow(glow);
  const SlopeDeviation gentle = OverSlopes(glow, map, {0.0, 30.0}, kAllRises);
  const SlopeDeviation steep = OverSlopes(glow, map, {30.0, 60.0}, kAllRises);
  EXPECT_LT(gentle.rms, 0.02) << "six terms of a light that has more";
  EXPECT_LT(gentle.most, 0.12);
  EXPECT_LT(steep.rms, 0.07);
  EXPECT_LT(steep.most, 0.6) << "at 60 degrees, turned from the lamp";
}

TEST(LampAirlightMap, SlopesInLightFogHaveTheLightOfLampAirlight) {
  const LampAirlightIrradiance glow(LightFog(), tests::kLampPlanet_m, 6.0, 0.0);
  const std::vector<glm::vec4> map = SampledGlow(glow);
  const std::array<int, 2> level{15, 17};  // the lamp stands about as high as the slope
  const SlopeDeviation gentle = OverSlopes(glow, map, {0.0, 30.0}, level);
  const SlopeDeviation steep = OverSlopes(glow, map, {30.0, 60.0}, level);
  EXPECT_LT(gentle.rms, 0.12) << "light in fog comes from near the lamp, and has an edge";
  EXPECT_LT(steep.rms, 0.16);
}

}  // namespace
}  // namespace alpenglow::renderer
