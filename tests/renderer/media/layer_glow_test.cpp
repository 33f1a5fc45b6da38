// SPDX-License-Identifier: MIT
// Light along rays through a plane layer, attenuated by its whole optical depth, is that of doubling
// and of many streams.
#include "renderer/media/layer_glow.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "atmosphere/math/constants.h"
#include "atmosphere/medium/phase.h"
#include "lut/multiple_scattering/spherical_harmonics.h"
#include "renderer/layer.h"
#include "tests/fixtures/media.h"
#include "tests/fixtures/sanitized.h"
#include "tests/renderer/layers/doubling_reference.h"

namespace alpenglow::renderer {
namespace {

struct Slab {
  double depth, albedo, ground, mu0;
  PhaseFunction phase;
};

/// Returns the stack of 8 streams of a slab.
LayerStack StackOf(const Slab& slab) {
  std::vector<double> chi = LegendreCoefficients(slab.phase, 8);
  chi[0] = 1.0;
  return LayerStack({{slab.depth, slab.albedo, chi}}, slab.ground, 8);
}

/// Returns the radiance that leaves a slab as LayerLight has it, from sources along the ray. The
/// light of the ground behind the slab is not included.
double FastRadiance(const Slab& slab, const LightWay& way) {
  const LayerStack stack = StackOf(slab);
  const LayerGlow glow(stack, LayerField::UnderSun(stack, slab.mu0), slab.mu0);
  const std::vector<double> higher = glow.Towards(GlowDirection(stack, way), 0.0);
  const double cosine =
      std::sqrt((1.0 - way.mu * way.mu) * (1.0 - slab.mu0 * slab.mu0)) * std::cos(way.azimuth) -
      way.mu * slab.mu0;
  const double phase = Phase(slab.phase, cosine);
  constexpr int kSteps = 2000;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double share = (i + 0.5) / kSteps, z = slab.depth * share;
    const double at = std::pow(share, 0.25) * (kGlowNodes - 1);
    const auto node = std::min(static_cast<std::size_t>(at), kGlowNodes - 2);
    const double sun = std::exp(-stack.scaled(0).scale * z / slab.mu0);
    const double source =
        phase * sun + std::lerp(higher[node], higher[node + 1], at - static_cast<double>(node));
    const double to_eye = (way.mu > 0.0 ? z : slab.depth - z) / std::abs(way.mu);
    sum += slab.albedo * source * std::exp(-to_eye) * slab.depth / kSteps / std::abs(way.mu);
  }
  return sum;
}

/// Statistics of ratios of fast and exact radiances.
struct Ratios {
  double squares = 0.0, least = 10.0, most = 0.0;
  int count = 0;

  void Add(double ratio) {
    squares += (ratio - 1.0) * (ratio - 1.0);
    least = std::min(least, ratio);
    most = std::max(most, ratio);
    ++count;
  }
  [[nodiscard]] double rms() const { return std::sqrt(squares / count); }
};

TEST(LayerGlow, RadiancesOfLobesAreThoseOfDoubling) {
  const PhaseFunction lobe = tests::LobeOf(0.75);
  const std::vector<double> cosines{0.15, 0.6, 0.3, 0.9};  // the suns come first
  Ratios ratios;
  for (const double depth : {0.5, 2.0, 8.0}) {
    if (tests::kSanitized && depth > 0.5) break;
    const doubling::Stack truth({{depth, 1.0, [&](double nu) { return Phase(lobe, nu); }}}, 0.2,
                                {16, tests::ScaledDown(32, 20), cosines});
    for (const std::size_t sun : {0U, 1U}) {
      const Slab slab{depth, 1.0, 0.2, cosines[sun], lobe};
      const double of_ground =
          0.2 / kPi * (truth.Flux(1, false, sun) + slab.mu0 * std::exp(-depth / slab.mu0));
      for (std::size_t view = 0; view < cosines.size(); ++view) {
        for (const double azimuth : {0.5, 1.6, 3.0}) {
          const double mu = cosines[view];
          ratios.Add(FastRadiance(slab, {-mu, azimuth}) /
                     truth.Radiance(1, false, view, sun, azimuth));
          const double up = truth.Radiance(0, true, view, sun, azimuth);
          ratios.Add(FastRadiance(slab, {mu, azimuth}) / (up - of_ground * std::exp(-depth / mu)));
        }
      }
    }
  }
  EXPECT_LT(ratios.rms(), 0.03);
  EXPECT_GT(ratios.least, 0.9);
  EXPECT_LT(ratios.most, 1.1);
}

/// Returns droplets in many streams. Photons would need millions of paths, because half of the light
/// in a direction was scattered by the forward peak. 40 streams agree with doubling
/// (layer_accuracy_test.cpp).
LayerStack ManyStreamsOf(const Slab& slab) {
  std::vector<double> chi = LegendreCoefficients(slab.phase, 2000);
  chi[0] = 1.0;
  return LayerStack({{slab.depth, slab.albedo, chi}}, slab.ground, tests::ScaledDown(40, 24));
}

TEST(LayerGlow, RadiancesInDropletsAreThoseOfManyStreams) {
  Ratios ratios;
  for (const double depth : {0.5, 2.0, 8.0}) {
    const Slab slab{depth, 1.0, 0.2, 0.6, DropletPhase(14.0)};
    const LayerStack many = ManyStreamsOf(slab);
    const LayerField truth = LayerField::UnderSun(many, slab.mu0);
    const LayerFluxes on_ground = truth.Fluxes(depth);
    for (const double mu : {-0.9, -0.3, 0.3, 0.9}) {
      for (const double azimuth : {0.6, 1.6, 3.0}) {
        double expected = truth.Radiance(mu > 0.0 ? 0.0 : depth, {mu, azimuth});
        if (mu > 0.0) {
          expected -=
              slab.ground / kPi * (on_ground.down + on_ground.direct) * std::exp(-depth / mu);
        }
        ratios.Add(FastRadiance(slab, {mu, azimuth}) / expected);
      }
    }
  }
  EXPECT_LT(ratios.rms(), 0.05);
  EXPECT_GT(ratios.least, 0.85);
  EXPECT_LT(ratios.most, 1.15);
}

TEST(LayerGlow, TheAureoleInDropletsLacksAtMostAThird) {
  for (const double depth : {0.5, 2.0, 8.0}) {
    const Slab slab{depth, 1.0, 0.2, 0.6, DropletPhase(14.0)};
    const LayerStack many = ManyStreamsOf(slab);
    const LayerField truth = LayerField::UnderSun(many, slab.mu0);
    for (const double angle_deg : {2.0, 4.0, 8.0, 15.0, 30.0}) {
      const LightWay way{-std::cos(std::acos(slab.mu0) - angle_deg * kPi / 180.0), 0.0};
      const double ratio = FastRadiance(slab, way) / truth.Radiance(depth, way);
      EXPECT_GT(ratio, angle_deg < 10.0 ? 0.65 : 0.95) << depth << " " << angle_deg;
      EXPECT_LT(ratio, 1.05) << depth << " " << angle_deg;
    }
  }
}

TEST(LayerGlow, AUniformSkyOverWhiteGroundIsScatteredUniformly) {
  const LayerStack stack = StackOf({3.0, 1.0, 1.0, 0.5, tests::LobeOf(0.8)});
  const LayerGlow glow(stack, LayerField::UnderUniformSky(stack), 0.0);
  for (const double mu : {-1.0, -0.2, 0.0, 0.4}) {
    for (const double light : glow.Towards(GlowDirection(stack, {mu, 1.0}), 1.0)) {
      EXPECT_NEAR(light, 1.0, 1e-6) << mu;
    }
  }
}

TEST(LayerGlow, BlackDropletsScatterNothing) {
  const LayerStack stack = StackOf({3.0, 0.0, 0.5, 0.5, tests::LobeOf(0.8)});
  const LayerGlow glow(stack, LayerField::UnderSun(stack, 0.5), 0.5);
  for (const double light : glow.Towards(GlowDirection(stack, {0.5, 1.0}), 0.0)) {
    EXPECT_EQ(light, 0.0);
  }
}

}  // namespace
}  // namespace alpenglow::renderer
