// SPDX-License-Identifier: MIT
// What the air that a lamp lights brings to surfaces: lamp -> air -> surface, in air of exponential
// density over a level ground.
//
//   E(n) = integral over directions d with n.d > 0 of  L(d) n.d,    L = Airlight from the surface
//
// L is integrated over the sphere around points at several distances from the lamp and elevations
// of the lamp over their horizon, and kept as moments of real spherical harmonics about the
// direction to the lamp, even about the vertical plane through it. Irradiance of any normal is then
// a short sum with the moments of the clamped cosine (Ramamoorthi, Hanrahan 2001, SIGGRAPH, "An
// efficient representation for irradiance environment maps"). Between distances the logarithm of
// the moment 00 times the distance is linear, and level ground has its exact irradiance: E falls as
// 1/d near a lamp, exponentially far from it. Rays end at the level ground at the lamp's foot, or
// at the surface where that is lower.
//
// The tree of a scene's lamps: inner nodes stand for all lamps below them (Walter et al. 2005,
// "Lightcuts", ACM TOG 24, 1098). Only lamps that shine evenly are under one; all others stand for
// themselves.
#pragma once

#include <array>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "atmosphere/lamp/airlight.h"
#include "lut/diffuse/spherical_harmonics.h"
#include "renderer/lamp/lamp_light.h"
#include "renderer/lamp/placed_lamp.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Of an isotropic lamp of intensity 1 at one altitude. Immutable.
class LampGlow {
 public:
  /// @param ground_altitude_m  at the lamp's foot, not above it.
  /// Of the moments.
  static constexpr int kDegree = 6;

  LampGlow(const std::vector<LampLayer>& layers, double lamp_altitude_m, double ground_altitude_m);

  /// Irradiance [m^-2], in every band.
  /// @param to_lamp  from the surface [m]; its length is clamped to what was tabulated, 0.2 m to
  ///     20 km. normal, up: unit.
  /// Error against quadrature over the hemisphere, in fog of scale heights of 25 to 100 m up to 4
  /// optical depths from the lamp, in parts of the irradiance of the normal that gets most: below
  /// 18 %, rms 5 %.
  [[nodiscard]] Bands<double> On(const glm::dvec3& to_lamp, const glm::dvec3& normal,
                                 const glm::dvec3& up) const;

 private:
  /// Of one place, a band: logarithm of the moment 00 times the distance, and all moments relative
  /// to 00, times those of the clamped cosine.
  struct Light {
    double log_mean = 0.0;
    Moments lobe{};
    double level = 0.0;  // what level ground gets more than the moments say, over the moment 00
  };

  [[nodiscard]] std::vector<Light> LightAt(double distance_m, double sine) const;

  LampAir air_;
  double lamp_altitude_m_, ground_altitude_m_;
  std::vector<Light> lights_;  // [(distance * elevations + elevation) * bands + band]
};

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
