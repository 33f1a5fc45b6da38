// SPDX-License-Identifier: MIT
// Where a lamp lights the ground around it: on plan, the signed distance to the edge of the shade
// that terrain throws, found with the renderer's own shadow rays (LampStage::Shades).
//
// Shade ends at sides of triangles and at their shadows on others, along lines that are straight
// for many steps of a lattice. The distance to a straight line is linear between nodes, so that the
// edge is where it was found, far finer than the lattice; only corners are rounded (Green 2007,
// "Improved Alpha-Tested Magnification for Vector Textures and Special Effects", SIGGRAPH courses).
// Every level is twice as coarse and as wide as the one before, and empty where that one serves.
#pragma once

#include <cstdint>
#include <vector>

#include "renderer/lamp/lamp_stage.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// Nodes of a side of a level; its middle one stands under the lamp.
inline constexpr int kPlanSide = 512;
/// Between the nodes of the first level.
inline constexpr double kPlanStep_m = 2.0;
/// So far from the middle a level serves, to the east and to the north [its steps].
inline constexpr int kPlanReach_steps = kPlanSide / 2 - 2;
/// Distances from the edge are cut off at so many steps.
inline constexpr double kPlanRange_steps = 2.0;
/// The fifth level serves as far as 8 km.
inline constexpr int kMostPlanLevels = 5;

struct LitPlan {
  int levels = 0;
  /// [(level * kPlanSide + row) * kPlanSide + column], rows to the north; 1 to 255 from
  /// -kPlanRange_steps, dark, to kPlanRange_steps, lit; 128 is the edge.
  std::vector<std::uint8_t> texels;
};

/// Levels, from 1 to kMostPlanLevels, beyond which a lamp lights no ground by more than a
/// thousandth of a lux, a hundredth of what the moon can.
[[nodiscard]] int PlanLevelsOf(double candela);

/// Takes 0.1 s a level: half a million rays where shade is intricate. `stage` has terrain.
[[nodiscard]] LitPlan LitPlanAround(const LampStage& stage, const Lamp& lamp, int levels);

}  // namespace alpenglow::viewer
