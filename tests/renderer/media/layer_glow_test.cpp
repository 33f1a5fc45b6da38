// SPDX-License-Identifier: MIT
// Light along rays through a plane layer, attenuated by its whole optical depth, is that of doubling
// and of many streams: of the first order (LayerBeam) and all others (LayerGlow).
#include "renderer/media/layer_glow.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "atmosphere/math/constants.h"
#include "atmosphere/medium/phase.h"
#include "lut/multiple_scattering/spherical_harmonics.h"
#include "renderer/layer.h"
#include "renderer/layers/layer_beam.h"
#include "tests/fixtures/media.h"
#include "tests/fixtures/quantile.h"
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
  return LayerStack({GreyLayer(slab.phase, slab.depth, slab.albedo)}, slab.ground, kLayerStreams);
}

/// Returns the radiance of diffuse light that leaves a slab as LayerLight has it, from sources along the
/// ray. The light of the ground behind the slab is not included.
double FastRadiance(const Slab& slab, const LayerBeam& beam, const LightWay& way) {
  const LayerStack stack = StackOf(slab);
  const LayerGlow glow(stack, LayerField::UnderSun(stack, slab.mu0), slab.mu0);
  const std::vector<double> higher = glow.Towards(GlowDirection(stack, way), 0.0);
  const LayerBeam::Angle angle = beam.AtAngle(
      std::sqrt((1.0 - way.mu * way.mu) * (1.0 - slab.mu0 * slab.mu0)) * std::cos(way.azimuth) -
      way.mu * slab.mu0);
  const GlowNodes nodes(slab.depth);
  constexpr int kSteps = 2000;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double share = (i + 0.5) / kSteps, z = slab.depth * share;
    const double at = nodes.NodeAt(z);
    const auto node = std::min(static_cast<std::size_t>(at), kGlowNodes - 2);
    const double to_eye = (way.mu > 0.0 ? z : slab.depth - z) / std::abs(way.mu);
    const double source = beam.Source(angle, {z / slab.mu0, to_eye}) +
                          std::lerp(higher[node], higher[node + 1], at - static_cast<double>(node));
    sum += slab.albedo * source * std::exp(-to_eye) * slab.depth / kSteps / std::abs(way.mu);
  }
  return sum;
}

/// Relative errors of radiances.
struct GlowErrors {
  std::vector<double> of_each;

  void Add(double found, double expected) { of_each.push_back(std::abs(found / expected - 1.0)); }
  [[nodiscard]] double rms() const {
    double squares = 0.0;
    for (const double error : of_each) squares += error * error;
    return std::sqrt(squares / static_cast<double>(of_each.size()));
  }
  [[nodiscard]] double p99() {
    std::sort(of_each.begin(), of_each.end());
    return tests::Quantile(of_each, 0.99);
  }
};

TEST(LayerGlow, RadiancesAndFluxesOfLobesAreThoseOfDoubling) {
  const std::vector<double> cosines{0.15, 0.6, 0.3, 0.9};  // the suns come first
  GlowErrors errors;
  for (const double g : tests::ScaledDown<std::vector<double>>({0.75, 0.85}, {0.75})) {
    const PhaseFunction lobe = tests::LobeOf(g);
    const LayerBeam beam(lobe, 1.0);
    for (const double depth : tests::ScaledDown<std::vector<double>>({0.5, 2.0, 8.0}, {0.5})) {
      const doubling::Stack truth({{depth, 1.0, [&](double nu) { return Phase(lobe, nu); }}}, 0.2,
                                  {24, 40, cosines});
      for (const std::size_t sun : {0U, 1U}) {
        const Slab slab{depth, 1.0, 0.2, cosines[sun], lobe};
        const LayerStack stack = StackOf(slab);
        const LayerGlow glow(stack, LayerField::UnderSun(stack, slab.mu0), slab.mu0);
        const double direct = slab.mu0 * std::exp(-depth / slab.mu0);
        const LayerFluxes &top = glow.fluxes().front(), &bottom = glow.fluxes().back();
        EXPECT_NEAR(top.up, truth.Flux(0, true, sun), 0.001 * slab.mu0) << g << " " << depth;
        EXPECT_NEAR(bottom.down + bottom.direct, truth.Flux(1, false, sun) + direct,
                    0.001 * slab.mu0)
            << g << " " << depth;
        const double of_ground = 0.2 / kPi * (truth.Flux(1, false, sun) + direct);
        for (std::size_t view = 0; view < cosines.size(); ++view) {
          for (const double azimuth : {0.2, 1.0, 2.0, 3.0}) {
            const double mu = cosines[view];
            errors.Add(FastRadiance(slab, beam, {-mu, azimuth}),
                       truth.Radiance(1, false, view, sun, azimuth));
            const double up = truth.Radiance(0, true, view, sun, azimuth);
            errors.Add(FastRadiance(slab, beam, {mu, azimuth}),
                       up - of_ground * std::exp(-depth / mu));
          }
        }
      }
    }
  }
  EXPECT_LT(errors.rms(), 0.01);
  EXPECT_LT(errors.p99(), 0.04);
}

/// Returns droplets in many streams. 40 streams agree with doubling (layer_accuracy_test.cpp), which
/// would need hundreds of nodes for the peak of droplets.
LayerStack ManyStreamsOf(const Slab& slab) {
  std::vector<double> chi = LegendreCoefficients(slab.phase, 2000);
  chi[0] = 1.0;
  return LayerStack({{slab.depth, slab.albedo, chi}}, slab.ground, tests::ScaledDown(48, 24));
}

TEST(LayerGlow, RadiancesInDropletsAreThoseOfManyStreams) {
  GlowErrors errors;
  for (const double diameter_um : {6.0, 14.0}) {
    const PhaseFunction droplets = DropletPhase(diameter_um);
    const LayerBeam beam(droplets, 1.0);
    for (const double depth : {0.5, 2.0, 8.0}) {
      for (const double mu0 : {0.15, 0.6}) {
        const Slab slab{depth, 1.0, 0.2, mu0, droplets};
        const LayerStack many = ManyStreamsOf(slab);
        const LayerField truth = LayerField::UnderSun(many, slab.mu0);
        const LayerFluxes on_ground = truth.Fluxes(depth);
        const double of_ground = slab.ground / kPi * (on_ground.down + on_ground.direct);
        for (const double mu : {-0.9, -0.3, -0.15, 0.15, 0.3, 0.9}) {
          for (const double azimuth : {0.2, 0.6, 1.6, 3.0}) {
            const double behind = mu > 0.0 ? of_ground * std::exp(-depth / mu) : 0.0;
            errors.Add(FastRadiance(slab, beam, {mu, azimuth}),
                       truth.Radiance(mu > 0.0 ? 0.0 : depth, {mu, azimuth}) - behind);
          }
        }
      }
    }
  }
  EXPECT_LT(errors.rms(), 0.01);
  EXPECT_LT(errors.p99(), 0.04);
}

TEST(LayerGlow, TheAureoleInDropletsIsThatOfManyStreams) {
  for (const double diameter_um : {6.0, 14.0}) {
    const PhaseFunction droplets = DropletPhase(diameter_um);
    for (const double albedo : {1.0, 0.9}) {
      const LayerBeam beam(droplets, albedo);
      for (const double depth : {0.5, 2.0, 8.0}) {
        const Slab slab{depth, albedo, 0.2, 0.6, droplets};
        const LayerStack many = ManyStreamsOf(slab);
        const LayerField truth = LayerField::UnderSun(many, slab.mu0);
        for (const double angle_deg : {0.1, 0.3, 0.5, 1.0, 2.0, 3.0, 4.0, 8.0, 15.0}) {
          const LightWay way{-std::cos(std::acos(slab.mu0) - angle_deg * kPi / 180.0), 0.0};
          const double ratio = FastRadiance(slab, beam, way) / truth.Radiance(depth, way);
          EXPECT_NEAR(ratio, 1.0, 0.035) << diameter_um << " " << albedo << " " << depth << " "
                                         << angle_deg << ": 0.03 at worst, at the smallest angle";
        }
      }
    }
  }
}

TEST(LayerGlow, NodesOfADepthAreFoundAgain) {
  for (const double depth : {1e-3, 0.5, 99.0, 101.0, 1e8}) {
    const GlowNodes nodes(depth);
    EXPECT_EQ(nodes.Depth(0), 0.0);
    EXPECT_EQ(nodes.Depth(kGlowNodes - 1), depth);
    for (std::size_t i = 0; i + 1 < kGlowNodes; ++i) {
      EXPECT_LT(nodes.Depth(i), nodes.Depth(i + 1)) << depth;
      // A node at the ground changes its depth little, and the root of a rounding is 1e-8.
      EXPECT_NEAR(nodes.NodeAt(nodes.Depth(i)), static_cast<double>(i), 1e-6) << depth;
    }
  }
  EXPECT_EQ(GlowNodes(0.0).NodeAt(0.0), 0.0);
}

TEST(LayerBeam, WithoutAPeakLightIsScatteredOnce) {
  for (const double g : {0.0, -0.8}) {
    const LayerBeam beam(tests::LobeOf(g), 0.9);
    EXPECT_EQ(beam.peak_scale(), 1.0);
    EXPECT_DOUBLE_EQ(beam.Source(beam.AtAngle(0.3), {2.0, 5.0}),
                     Phase(tests::LobeOf(g), 0.3) * std::exp(-2.0));
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
