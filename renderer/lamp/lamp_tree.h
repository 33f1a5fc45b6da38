// SPDX-License-Identifier: MIT
// The tree of a scene's lamps: inner nodes stand for all lamps below them (Walter et al. 2005,
// "Lightcuts", ACM TOG 24, 1098). Only lamps that shine evenly are under one; all others stand for
// themselves.
#pragma once

#include <array>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "renderer/lamp/lamp_glow.h"
#include "renderer/lamp/lamp_plan.h"
#include "renderer/lamp/placed_lamp.h"

namespace alpenglow::renderer {

/// A node of the tree: a lamp, or one that stands for others.
struct LampNode {
  PlacedLamp light;
  glm::dmat3 moments{0.0};  // second moments of the lamps about its place, per candela [m^2]
  double radius_m = 0.0;    // of the lamps' places around its own
  double extinction_per_m = 0.0;
  std::optional<std::array<std::uint32_t, 2>> children;
};

class LampTree {
 public:
  /// The lamps are nodes 0 and on, in their order.
  LampTree(std::vector<PlacedLamp> lamps, const LampEye& eye, const LampStage& stage);

  [[nodiscard]] const std::vector<LampNode>& nodes() const { return nodes_; }
  [[nodiscard]] const PlacedLamp& Light(std::uint32_t node) const { return nodes_[node].light; }
  [[nodiscard]] std::size_t lamps() const { return lamps_; }
  [[nodiscard]] const LampNodes& roots() const { return roots_; }
  /// What the air that the node lights brings to surfaces.
  [[nodiscard]] const LampGlow& GlowOf(std::uint32_t node) const {
    return *glows_[glow_of_node_[node]];
  }

  /// Everything that depends on the eye, anew.
  void StandBefore(const LampEye& eye, const LampStage& stage);

 private:
  LampNode& Add(PlacedLamp placed, const LampStage& stage);
  /// One that stands for the members.
  LampNode& AddSum(const LampNodes& members, const LampEye& eye, const LampStage& stage);
  /// Lamps of these numbers under one node: halves along the longest side.
  std::uint32_t Join(LampNodes members, const LampEye& eye, const LampStage& stage);
  /// In the order of their places along the longest side of the box that holds them.
  [[nodiscard]] LampNodes AlongLongestSide(LampNodes members) const;
  void MakeGlows(const LampStage& stage);

  std::vector<LampNode> nodes_;  // the scene's lamps, then those that stand for others
  std::size_t lamps_ = 0;
  LampNodes roots_;
  std::vector<std::shared_ptr<const LampGlow>> glows_;
  std::vector<std::size_t> glow_of_node_;
};

}  // namespace alpenglow::renderer
