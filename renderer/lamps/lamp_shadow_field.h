// SPDX-License-Identifier: MIT
// Provides LampShadowField: the lit and shadowed ground around a lamp, for interpolation by the
// GPU.
//
// A LampShadowField is a horizontal map of the signed distance to the edge of the shadows of
// terrain, found with the renderer's own shadow rays (LampStage::Shades). Shadows end at sides of
// triangles and at the shadows of these sides on other triangles, along lines that are straight
// over many steps of a lattice. The distance to a straight line is linear between nodes, so the
// edge is located far more accurately than the spacing of the lattice; only corners are rounded
// (Green 2007, "Improved Alpha-Tested Magnification for Vector Textures and Special Effects",
// SIGGRAPH courses). Every level is twice as coarse and twice as wide as the previous one, and
// empty where the previous one is used.
#pragma once

#include <cstdint>
#include <vector>

#include "renderer/lamps/placed_lamp.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Nodes per side of a level; the middle one is below the lamp.
inline constexpr int kPlanSide = 512;
/// Distance between nodes of the first level.
inline constexpr double kPlanStep_m = 2.0;
/// Half width of the area in which a level is used, to the east and to the north [its steps].
inline constexpr int kPlanReach_steps = kPlanSide / 2 - 2;
/// Distances from the edge are clamped to this many steps.
inline constexpr double kPlanRange_steps = 2.0;
/// The fifth level is used up to 8 km.
inline constexpr int kMostPlanLevels = 5;

struct LampShadowField {
  int levels = 0;
  /// [(level * kPlanSide + row) * kPlanSide + column], rows to the north. Values from 1 to 255
  /// stand for -kPlanRange_steps (shadow) to kPlanRange_steps (lit); 128 is the edge.
  std::vector<std::uint8_t> texels;
};

/// Returns the number of levels, from 1 to kMostPlanLevels. Beyond them the lamp illuminates no
/// ground by more than a thousandth of a lux, a hundredth of the illuminance that the moon can
/// reach.
[[nodiscard]] int PlanLevelsOf(double candela);

/// Computes a plan. It takes 0.1 s per level: half a million rays where shadows are intricate.
/// `stage` must have terrain.
[[nodiscard]] LampShadowField LampShadowFieldAround(const LampStage& stage, const Lamp& lamp,
                                                    int levels);

}  // namespace alpenglow::renderer
