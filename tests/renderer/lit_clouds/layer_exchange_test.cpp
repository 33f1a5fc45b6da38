// SPDX-License-Identifier: MIT
#include "renderer/lit_clouds/layer_exchange.h"

#include <gtest/gtest.h>

#include <array>

namespace alpenglow::renderer {
namespace {

constexpr std::array<CloudLayerFluxes, 3> kThreeLayers{
    {{0.06, 0.09, 0.35, 0.65}, {0.06, 0.12, 0.15, 0.85}, {0.04, 0.03, 0.1, 0.88}}};

/// Follows light from interface to interface until less than 1e-15 of it is left.
std::vector<InterfaceFluxes> FollowedBetween(std::span<const CloudLayerFluxes> layers,
                                             const OuterFluxes& outer, double ground_albedo) {
  const std::size_t top = layers.size();
  std::vector<InterfaceFluxes> sum(top + 1);
  std::vector<double> down(top + 1), up(top + 1);
  down[top] = outer.sky;
  for (std::size_t i = 0; i < top; ++i) {
    down[i] += layers[i].sun_down;
    up[i + 1] += layers[i].sun_up;
  }
  up[0] += ground_albedo * outer.direct_on_ground + outer.from_ground;
  for (int order = 0; order < 2000; ++order) {
    std::vector<double> next_down(top + 1), next_up(top + 1);
    for (std::size_t i = 0; i <= top; ++i) {
      sum[i].down += down[i];
      sum[i].up += up[i];
    }
    next_up[0] = ground_albedo * down[0];
    next_down[top] = outer.reflection * up[top];
    for (std::size_t i = 0; i < top; ++i) {
      next_down[i] += layers[i].sky_down * down[i + 1] + layers[i].sky_up * up[i];
      next_up[i + 1] += layers[i].sky_up * down[i + 1] + layers[i].sky_down * up[i];
    }
    down = next_down;
    up = next_up;
  }
  return sum;
}

// Both sum the same series; 1e-12 is rounding.
TEST(LayerExchange, EqualsLightFollowedFromLayerToLayer) {
  const OuterFluxes outer{
      .sky = 0.2, .direct_on_ground = 0.25, .reflection = 0.15, .from_ground = 0.1};
  const auto at = FluxesBetween(kThreeLayers, outer, 0.6);
  const auto followed = FollowedBetween(kThreeLayers, outer, 0.6);
  ASSERT_EQ(at.size(), 4u);
  for (std::size_t i = 0; i < at.size(); ++i) {
    EXPECT_NEAR(at[i].down, followed[i].down, 1e-12) << i;
    EXPECT_NEAR(at[i].up, followed[i].up, 1e-12) << i;
  }
}

// Light that enters leaves through the top or is absorbed by layers or ground; rounding. The layers
// scatter 0.4 of a beam, and 0.1 of it reaches the ground.
TEST(LayerExchange, WhiteLayersOverWhiteGroundReflectEverything) {
  const std::array<CloudLayerFluxes, 2> white{{{0.12, 0.08, 0.4, 0.6}, {0.08, 0.12, 0.3, 0.7}}};
  const auto at = FluxesBetween(white, {.sky = 0.3, .direct_on_ground = 0.1}, 1.0);
  EXPECT_NEAR(at.back().up, 0.8, 1e-12);
}

TEST(LayerExchange, WithoutLayersTheGroundReflectsWhatArrives) {
  const auto at = FluxesBetween({}, {.sky = 0.2, .direct_on_ground = 0.5}, 0.1);
  ASSERT_EQ(at.size(), 1u);
  EXPECT_DOUBLE_EQ(at[0].up, 0.07);
}

}  // namespace
}  // namespace alpenglow::renderer
