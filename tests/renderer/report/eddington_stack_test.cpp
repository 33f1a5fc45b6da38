// SPDX-License-Identifier: MIT
// Two streams of the literature satisfy their own equations, which are differentiated and integrated
// numerically here, and are near discrete ordinates of many streams.
#include "renderer/report/eddington_stack.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "atmosphere/math/constants.h"
#include "renderer/layers/layer_field.h"
#include "renderer/report/layer_cases.h"

namespace alpenglow::renderer {
namespace {

/// A cloud over another one, both without a forward peak, over bright ground.
const std::vector<LayerOptics> kTwoLayers{{0.8, 0.9, {1.0, 0.5}}, {2.5, 0.6, {1.0, -0.2}}};
constexpr double kTwoLayerGround = 0.4, kTwoLayerSun = 0.55;

/// I0 and I1 at a depth.
struct EddingtonField {
  double mean, slope;
};
EddingtonField FieldAt(const EddingtonStack& stack, double depth) {
  const LayerFluxes fluxes = stack.Fluxes(depth);
  return {(fluxes.down + fluxes.up) / (2.0 * kPi), 0.75 * (fluxes.down - fluxes.up) / kPi};
}

TEST(EddingtonStack, FluxesSatisfyTheEquationsOfTheApproximation) {
  const EddingtonStack stack(kTwoLayers, kTwoLayerGround, kTwoLayerSun);
  constexpr double kStep = 1e-4;
  for (const double depth : {0.1, 0.5, 0.79, 0.81, 2.0, 3.2}) {
    const LayerOptics& layer = kTwoLayers[depth < 0.8 ? 0 : 1];
    const double w = layer.albedo, g = layer.chi[1];
    const EddingtonField at = FieldAt(stack, depth);
    const EddingtonField before = FieldAt(stack, depth - kStep),
                         after = FieldAt(stack, depth + kStep);
    const double beam = w / (4.0 * kPi) * std::exp(-depth / kTwoLayerSun);
    // Central differences err by a third of the square of the step times third derivatives.
    EXPECT_NEAR((after.slope - before.slope) / (6.0 * kStep), -(1.0 - w) * at.mean + beam, 1e-7)
        << depth;
    EXPECT_NEAR((after.mean - before.mean) / (2.0 * kStep),
                -(1.0 - w * g) * at.slope + 3.0 * g * kTwoLayerSun * beam, 1e-7)
        << depth;
  }
}

TEST(EddingtonStack, FluxesAreContinuousAndMeetTheGround) {
  const EddingtonStack stack(kTwoLayers, kTwoLayerGround, kTwoLayerSun);
  EXPECT_NEAR(stack.Fluxes(0.0).down, 0.0, 1e-12) << "no diffuse light from above";
  for (const double depth : {0.8, 3.3}) {
    const LayerFluxes above = stack.Fluxes(depth - 1e-9), below = stack.Fluxes(depth);
    EXPECT_NEAR(above.up, below.up, 1e-8);
    EXPECT_NEAR(above.down, below.down, 1e-8);
  }
  const LayerFluxes ground = stack.Fluxes(3.3);
  EXPECT_NEAR(ground.up, kTwoLayerGround * (ground.down + ground.direct), 1e-12);
}

TEST(EddingtonStack, ALayerInTwoPartsIsTheWholeLayer) {
  std::vector<LayerOptics> whole = CloudInAir(7.0, 0.85), parts = whole;
  parts[1].optical_depth = 2.0;
  LayerOptics rest = whole[1];
  rest.optical_depth = 5.0;
  parts.insert(parts.begin() + 2, rest);
  const EddingtonStack one(whole, 0.3, 0.4), two(parts, 0.3, 0.4);
  for (const double depth : {0.0, 0.17, 1.0, 2.17, 5.0, 7.2}) {
    EXPECT_NEAR(one.Fluxes(depth).up, two.Fluxes(depth).up, 1e-9) << depth;
    EXPECT_NEAR(one.Fluxes(depth).down, two.Fluxes(depth).down, 1e-9) << depth;
    for (const double mu : {-0.9, -0.2, 0.03, 0.7}) {
      EXPECT_NEAR(one.Radiance(depth, {mu, 1.0}), two.Radiance(depth, {mu, 1.0}), 1e-9) << mu;
    }
  }
}

TEST(EddingtonStack, RadianceIsTheIntegralOfItsSource) {
  const EddingtonStack stack(kTwoLayers, kTwoLayerGround, kTwoLayerSun);
  constexpr double kEye = 1.1, kBottom = 3.3;
  constexpr int kSteps = 20000;
  for (const LightWay& way : {LightWay{-0.4, 0.7}, LightWay{0.25, 2.0}, LightWay{1.0, 0.0}}) {
    const double end = way.mu > 0.0 ? kBottom : 0.0, steep = std::abs(way.mu);
    const double nu = std::sqrt((1.0 - way.mu * way.mu) * (1.0 - kTwoLayerSun * kTwoLayerSun)) *
                          std::cos(way.azimuth) -
                      way.mu * kTwoLayerSun;
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i) {
      const double depth = kEye + (end - kEye) * (i + 0.5) / kSteps;
      const LayerOptics& layer = kTwoLayers[depth < 0.8 ? 0 : 1];
      const EddingtonField field = FieldAt(stack, depth);
      const double once =
          (1.0 + 3.0 * layer.chi[1] * nu) / (4.0 * kPi) * std::exp(-depth / kTwoLayerSun);
      const double source =
          layer.albedo * (field.mean - layer.chi[1] * field.slope * way.mu + once);
      sum += source * std::exp(-std::abs(depth - kEye) / steep);
    }
    sum *= std::abs(end - kEye) / kSteps / steep;
    if (way.mu > 0.0) sum += stack.Fluxes(kBottom).up / kPi * std::exp(-(kBottom - kEye) / steep);
    // A midpoint rule of 20000 steps, one of which contains the step of the source at 0.8.
    EXPECT_NEAR(stack.Radiance(kEye, way), sum, 2e-4 * sum) << way.mu;
  }
}

TEST(EddingtonStack, ConservesLightWithoutAbsorption) {
  for (const double depth : {0.01, 1.0, 30.0, 500.0}) {
    const EddingtonStack stack({{depth, 1.0, MomentsOfLobe(0.85)}}, 0.0, 0.3);
    const LayerFluxes bottom = stack.Fluxes(depth);
    // An albedo of 1 counts as 1 - 1e-6.
    EXPECT_NEAR((stack.Fluxes(0.0).up + bottom.down + bottom.direct) / 0.3, 1.0,
                1e-4 + 1e-5 * depth)
        << depth;
  }
}

TEST(EddingtonStack, FluxesAreNearThoseOfManyStreams) {
  double largest = 0.0;
  for (const LayerCase& of : LayerCasesOf(0.85, 0)) {
    const LayerStack many(of.layers, of.ground_albedo, 16);
    const LightOfLayers truth = LightIn(of, LayerField::UnderSun(many, of.mu_s));
    const LightOfLayers found = LightIn(of, EddingtonStack(of.layers, of.ground_albedo, of.mu_s));
    for (std::size_t i = 0; i < truth.fluxes.size(); ++i)
      largest = std::max(largest, std::abs(found.fluxes[i] - truth.fluxes[i]));
  }
  // Joseph, Wiscombe and Weinman (1976) find errors of fluxes of a few hundredths.
  EXPECT_LT(largest, 0.08);
  EXPECT_GT(largest, 0.005) << "the test must be able to fail";
}

TEST(EddingtonStack, GrazingRaysThroughDeepCloudsAreFinite) {
  const EddingtonStack stack(CloudInAir(60.0, 0.85), 0.1, 0.5);
  for (const double depth : {0.0, 30.0, 60.2}) {
    for (const double mu : {-0.001, 0.001})
      EXPECT_TRUE(std::isfinite(stack.Radiance(depth, {mu, 1.0}))) << depth << " " << mu;
  }
}

}  // namespace
}  // namespace alpenglow::renderer
