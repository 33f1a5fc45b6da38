// SPDX-License-Identifier: MIT
// What the air that a lamp lights brings to surfaces (renderer/lamp/lamp_tree.h), ready for
// interpolation by a graphics card: six terms over distance and rise of the lamp.
//
//   E(n) = exp(term 0) / d * LampGlowOnSlope(n, terms 1 to 5)             [m^-2], by band
//
// Term 0 is the logarithm of what level ground gets times the distance. The others, of
// atmosphere/lamp/lamp_ray.glsl, are fitted by least squares to slopes of up to 60 degrees, gentle
// ones before steep ones (the fourth power of the cosine).
//
// Where a lamp lights the ground around it: on plan, the signed distance to the edge of the shade
// that terrain throws, found with the renderer's own shadow rays (LampStage::Shades).
//
// Shade ends at sides of triangles and at their shadows on others, along lines that are straight
// for many steps of a lattice. The distance to a straight line is linear between nodes, so that the
// edge is where it was found, far finer than the lattice; only corners are rounded (Green 2007,
// "Improved Alpha-Tested Magnification for Vector Textures and Special Effects", SIGGRAPH courses).
// Every level is twice as coarse and as wide as the one before, and empty where that one serves.
//
// The LitPlans of lamps, made one by one beside drawing, once.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec4.hpp>
#include <vector>

#include "renderer/lamp/lamp_tree.h"
#include "renderer/lamp/placed_lamp.h"
#include "viewer/job/latest_job.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// Places of distances and rises are those of lamp_ray.glsl, each step of LampGlow in four.
inline constexpr int kGlowDistances = 61;
inline constexpr int kGlowRises = 33;
inline constexpr double kNearestGlow_m = 0.2;
inline constexpr double kFarthestGlow_m = 2e4;
inline constexpr int kGlowTerms = 6;

/// [(term * kGlowRises + rise) * kGlowDistances + distance]; bands that there are not have level
/// ground dark and slopes alike. At most four bands.
[[nodiscard]] std::vector<glm::vec4> SampledGlow(const LampGlow& glow);

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

class LitPlanFollower {
 public:
  /// Of a lamp by its number, from 0.
  using Make = std::function<LitPlan(std::size_t)>;
  /// @param make  called on a thread of this; what it refers to must outlive this.
  LitPlanFollower(std::size_t lamps, Make make) : lamps_(lamps), job_(std::move(make)) {}

  /// Takes in what is finished and asks for the next.
  void Follow();
  /// Waits for all of them.
  void Settle();
  /// Of the first lamps, as many as are finished.
  [[nodiscard]] const std::vector<LitPlan>& plans() const { return plans_; }

 private:
  std::size_t lamps_;
  std::vector<LitPlan> plans_;
  LatestJob<std::size_t, LitPlan> job_;
};

}  // namespace alpenglow::viewer
