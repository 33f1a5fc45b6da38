// SPDX-License-Identifier: MIT
// Light in plane-parallel layers: what is refused, conservation of energy, limits and symmetries.
#include "renderer/layers/layer_stack.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "atmosphere/math/constants.h"
#include "renderer/layers/layer_field.h"
#include "tests/fixtures/fault_of.h"
#include "tests/renderer/layers/layer_moments.h"

namespace alpenglow::renderer {
namespace {

using testing::HasSubstr;

std::string FaultOfLayer(const LayerOptics& layer) {
  return tests::FaultOf([&] { return LayerStack({{.optical_depth = 0.1}, layer}, 0.1); });
}

TEST(LayerStack, RefusesOpticsOutsideTheirRange) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  EXPECT_THAT(FaultOfLayer({.optical_depth = -1.0}),
              HasSubstr("layers[1].optical_depth is -1; it must lie in [0, "));
  EXPECT_THAT(FaultOfLayer({.optical_depth = infinite}),
              HasSubstr("layers[1].optical_depth is inf"));
  EXPECT_THAT(FaultOfLayer({.optical_depth = nan}), HasSubstr("layers[1].optical_depth is nan"));
  for (const double albedo : {-0.1, 1.01, nan}) {
    EXPECT_THAT(FaultOfLayer({.albedo = albedo}), HasSubstr("it must lie in [0, 1]"));
  }
  EXPECT_THAT(FaultOfLayer({.chi = {1.0, 0.5, -1.2}}),
              HasSubstr("layers[1].chi[2] is -1.2; it must lie in [-1, 1]"));
  EXPECT_THAT(FaultOfLayer({.chi = {1.0, nan}}), HasSubstr("layers[1].chi[1] is nan"));
  EXPECT_THAT(FaultOfLayer({.chi = {0.9}}), HasSubstr("layers[1].chi[0] is 0.9"));
  EXPECT_THAT(FaultOfLayer({.chi = {}}), HasSubstr("layers[1].chi is empty"));
}

TEST(LayerStack, RefusesGroundAndStreamsOutsideTheirRange) {
  const auto fault = [](double albedo, int streams) {
    return tests::FaultOf([&] { return LayerStack({{.optical_depth = 1.0}}, albedo, streams); });
  };
  EXPECT_THAT(fault(1.1, 8), HasSubstr("ground_albedo is 1.1; it must lie in [0, 1]"));
  EXPECT_THAT(fault(-0.1, 8), HasSubstr("ground_albedo is -0.1"));
  for (const int streams : {-2, 0, 1, 7, 66}) {
    EXPECT_THAT(fault(0.0, streams), HasSubstr("it must be even and lie in [2, 64]"));
  }
  EXPECT_THAT(tests::FaultOf([] { return LayerStack({}, 0.0); }), HasSubstr("there are 0 layers"));
}

TEST(LayerStack, RefusesSunsAndDepthsOutsideTheirRange) {
  const LayerStack stack({{.optical_depth = 1.0}}, 0.0);
  for (const double mu_s : {-0.5, 0.0, 1.5, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THAT(tests::FaultOf([&] { return LayerField::UnderSun(stack, mu_s); }),
                HasSubstr("it must lie in (0, 1]"));
  }
  const LayerField field = LayerField::UnderSun(stack, 0.5);
  EXPECT_THAT(tests::FaultOf([&] { return field.Fluxes(1.1); }), HasSubstr("depth is 1.1"));
  EXPECT_THAT(tests::FaultOf([&] {
                return field.Radiance(-0.1, {0.5, 0.0});
              }),
              HasSubstr("depth is -0.1"));
  EXPECT_THAT(tests::FaultOf([&] {
                return field.Radiance(0.5, {1.2, 0.0});
              }),
              HasSubstr("mu is 1.2"));
}

// Hard case 30.
TEST(LayerStack, ConservesLightWithoutAbsorption) {
  for (const int streams : {4, 8, 16}) {
    for (const double g : {0.0, 0.85, 0.99, -0.8, -0.99}) {
      for (const double depth : {0.0, 1e-12, 1e-6, 1.0, 100.0, 1e4}) {
        const LayerStack stack({{depth, 1.0, LobeMoments(g)}}, 0.0, streams);
        for (const double mu_s : {0.02, 0.3, 1.0}) {
          const LayerField field = LayerField::UnderSun(stack, mu_s);
          const LayerFluxes top = field.Fluxes(0.0), inside = field.Fluxes(0.3 * depth),
                            bottom = field.Fluxes(depth);
          const double out = bottom.down + bottom.direct;
          EXPECT_NEAR((top.up + out) / mu_s, 1.0, 1e-7) << g << " " << depth << " " << mu_s;
          EXPECT_NEAR((inside.down + inside.direct - inside.up - out) / mu_s, 0.0, 2e-6)
              << g << " " << depth << " " << mu_s << ": layers up to 1e-3 are linear";
        }
      }
    }
  }
}

TEST(LayerStack, AbsorbsNothingAboveWhiteGround) {
  const LayerStack stack({{0.2, 1.0, kMoleculeMoments}, {20.0, 1.0, LobeMoments(0.85)}}, 1.0);
  EXPECT_NEAR(LayerField::UnderSun(stack, 0.6).Fluxes(0.0).up, 0.6, 1e-9);
  EXPECT_NEAR(LayerField::UnderUniformSky(stack).Fluxes(0.0).up, kPi, 1e-9);
  EXPECT_NEAR(LayerField::OverUniformGround(stack).Fluxes(0.0).up, kPi, 1e-9);
}

TEST(LayerStack, AUniformSkyOverWhiteGroundIsUniformEverywhere) {
  const LayerStack stack({{0.2, 1.0, kMoleculeMoments}, {5.0, 1.0, LobeMoments(0.75)}}, 1.0);
  const LayerField field = LayerField::UnderUniformSky(stack);
  for (const double depth : {0.0, 0.1, 0.2, 3.0, 5.2}) {
    for (const double mu : {-1.0, -0.4, 0.05, 0.7}) {
      EXPECT_NEAR(field.Radiance(depth, {mu, 1.0}), 1.0, 1e-9) << depth << " " << mu;
    }
  }
}

TEST(LayerStack, ASkyOfOneRadianceIsAUniformSky) {
  const LayerStack stack({{0.2, 1.0, kMoleculeMoments}, {5.0, 0.9, LobeMoments(0.75)}}, 0.2);
  const LayerField uniform = LayerField::UnderUniformSky(stack);
  const LayerField any = LayerField::UnderSky(stack, [](const LightWay&) { return 1.0; });
  for (const double depth : {0.0, 0.2, 5.2}) {
    EXPECT_NEAR(any.Fluxes(depth).down, uniform.Fluxes(depth).down, 1e-9);
    EXPECT_NEAR(any.Fluxes(depth).up, uniform.Fluxes(depth).up, 1e-9);
    EXPECT_NEAR(any.Radiance(depth, {0.5, 1.0}), uniform.Radiance(depth, {0.5, 1.0}), 1e-9);
  }
}

TEST(LayerStack, ASkyOfASmallSourceIsABeam) {
  // A sky that is bright in the azimuth of the beam only has the modes of the beam.
  const LayerStack stack({{1.0, 1.0, LobeMoments(0.6)}}, 0.0);
  const double mu_s = stack.streams().mu(2), weight = stack.streams().weight(2);
  const LayerField sky = LayerField::UnderSky(stack, [&](const LightWay& way) {
    double modes = 0.5;
    for (int m = 1; m < 8; ++m) modes += std::cos(m * way.azimuth);
    return std::abs(way.mu + mu_s) < 1e-9 ? modes / (kPi * weight) : 0.0;
  });
  const LayerFluxes expected = LayerField::UnderSun(stack, mu_s).Fluxes(0.0);
  EXPECT_NEAR(sky.Fluxes(0.0).up, expected.up, 1e-6) << "k is moved by a millionth";
  EXPECT_NEAR(sky.Radiance(0.0, {0.4, 2.0}),
              LayerField::UnderSun(stack, mu_s).Radiance(0.0, {0.4, 2.0}), 0.02)
      << "the first order of the beam has no truncated phase function";
}

TEST(LayerStack, RadianceChangesByItsSource) {
  const LayerStack stack({{2.0, 0.9, LobeMoments(0.7)}}, 0.3);
  const LayerField field = LayerField::UnderUniformSky(stack);
  const double scale = stack.scaled(0).scale, step = 1e-3, mu = 0.6;
  const std::vector<double> by_degree = field.SourceOfHigherOrders(1.0);
  const std::vector<double> legendre = AssociatedLegendre(0, 7, mu);
  double source = 0.0;
  for (std::size_t l = 0; l < 8; ++l) source += by_degree[l] * legendre[l];
  const double slope =
      (field.Radiance(1.0 + step, {mu, 0.0}) - field.Radiance(1.0 - step, {mu, 0.0})) /
      (2.0 * step * scale);
  EXPECT_NEAR(field.Radiance(1.0, {mu, 0.0}) - mu * slope, source, 1e-6)
      << "the square of the step";
}

TEST(LayerStack, ThinLayersScatterOnce) {
  const double depth = 1e-6, mu = 0.4, mu_s = 0.7, azimuth = 2.0, g = 0.75;
  const LayerStack stack({{depth, 0.9, LobeMoments(g)}}, 0.0);
  const double nu = -mu * mu_s + std::sqrt((1 - mu * mu) * (1 - mu_s * mu_s)) * std::cos(azimuth);
  const double phase = (1 - g * g) / (4 * kPi) * std::pow(1 + g * g - 2 * g * nu, -1.5);
  const double once = 0.9 * depth / mu * phase;
  EXPECT_NEAR(LayerField::UnderSun(stack, mu_s).Radiance(0.0, {mu, azimuth}) / once, 1.0, 3e-5)
      << "the second order is of the order of the depth times its logarithm";
}

TEST(LayerStack, CutsOfALayerChangeNothing) {
  const LayerOptics whole{3.0, 0.95, LobeMoments(0.8)};
  LayerOptics part = whole;
  part.optical_depth = 1e-5;
  LayerOptics rest = whole;
  rest.optical_depth = 2.99999 - 1.2;
  LayerOptics other = whole;
  other.optical_depth = 1.2;
  const LayerStack one({whole}, 0.3), three({other, part, rest}, 0.3);
  const LayerField a = LayerField::UnderSun(one, 0.4), b = LayerField::UnderSun(three, 0.4);
  for (const double depth : {0.0, 0.5, 1.2, 1.200005, 2.0, 3.0}) {
    EXPECT_NEAR(a.Fluxes(depth).down, b.Fluxes(depth).down, 1e-9) << depth;
    EXPECT_NEAR(a.Fluxes(depth).up, b.Fluxes(depth).up, 1e-9) << depth;
    for (const double mu : {-0.9, -0.1, 0.2, 0.8}) {
      const double expected = a.Radiance(depth, {mu, 0.7});
      EXPECT_NEAR(b.Radiance(depth, {mu, 0.7}), expected, 2e-4 * expected + 1e-12)
          << depth << " " << mu << ": Gauss nodes of the first order differ";
    }
  }
}

TEST(LayerStack, HasNoPoleWhereTheBeamDecaysLikeDiffuseLight) {
  const LayerStack stack({{2.0, 0.9, LobeMoments(0.8)}}, 0.2);
  for (int m = 0; m < 2; ++m) {
    for (const double k : stack.mode(m, 0).decay()) {
      if (k <= 1.0) continue;
      const LayerField at = LayerField::UnderSun(stack, 1.0 / k);
      const LayerField near = LayerField::UnderSun(stack, (1.0 + 1e-4) / k);
      for (const double mu : {-0.5, 0.5}) {
        const double expected = near.Radiance(1.0, {mu, 0.5});
        EXPECT_NEAR(at.Radiance(1.0, {mu, 0.5}), expected, 3e-4 * expected)
            << "the sun moved by 1e-4";
      }
      // And where a line of sight decays like diffuse light.
      const double expected = at.Radiance(1.0, {(1.0 + 1e-4) / k, 0.5});
      EXPECT_NEAR(at.Radiance(1.0, {1.0 / k, 0.5}), expected, 3e-4 * expected);
    }
  }
}

TEST(LayerStack, IsReciprocal) {
  const LayerStack stack({{0.1, 1.0, kMoleculeMoments}, {2.0, 0.9, LobeMoments(0.7)}}, 0.3, 16);
  const double there = LayerField::UnderSun(stack, 0.3).Radiance(0.0, {0.8, 1.0}) / 0.3;
  const double back = LayerField::UnderSun(stack, 0.8).Radiance(0.0, {0.3, 1.0}) / 0.8;
  EXPECT_NEAR(there / back, 1.0, 1e-3) << "directions between the streams are not exact";
}

TEST(LayerStack, MixedLayersWeighMomentsByScattering) {
  const LayerOptics mixed =
      MixedLayer({{0.3, 1.0, kMoleculeMoments}, {0.2, 0.5, {1.0, 0.8, 0.6, 0.5}}});
  EXPECT_DOUBLE_EQ(mixed.optical_depth, 0.5);
  EXPECT_DOUBLE_EQ(mixed.albedo, 0.8);
  const std::vector<double> expected{1.0, 0.2, (0.03 + 0.06) / 0.4, 0.125};
  ASSERT_EQ(mixed.chi.size(), expected.size());
  for (std::size_t l = 0; l < expected.size(); ++l) EXPECT_NEAR(mixed.chi[l], expected[l], 1e-15);
}

}  // namespace
}  // namespace alpenglow::renderer
