// SPDX-License-Identifier: MIT
#include "renderer/lamp/lamp_tree.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>

#include "renderer/ground/band_light.h"

namespace alpenglow::renderer {

LampTree::LampTree(std::vector<PlacedLamp> lamps, const LampEye& eye, const LampStage& stage) {
  for (PlacedLamp& lamp : lamps) Add(ShiningOn(eye, stage, std::move(lamp)), stage);
  lamps_ = nodes_.size();
  LampNodes even;
  for (std::uint32_t i = 0; i < lamps_; ++i) {
    const bool is_even = Light(i).lamp.profile.kind == LampProfile::Kind::kIsotropic;
    (is_even ? even : roots_).push_back(i);
  }
  if (!even.empty()) roots_.push_back(Join(std::move(even), eye, stage));
  MakeGlows(stage);
}

LampNode& LampTree::Add(PlacedLamp placed, const LampStage& stage) {
  LampNode node;
  const double altitude_m = stage.AltitudeOf(placed.lamp.position_m);
  for (const LampLayer& layer : placed.middle_air.layers) {
    node.extinction_per_m += layer.extinction_per_m[0] * layer.Density(altitude_m);
  }
  node.light = std::move(placed);
  nodes_.push_back(std::move(node));
  return nodes_.back();
}

LampNodes LampTree::AlongLongestSide(LampNodes members) const {
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
  for (const std::uint32_t i : members) {
    low = glm::min(low, Light(i).lamp.position_m);
    high = glm::max(high, Light(i).lamp.position_m);
  }
  const glm::dvec3 size = high - low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  std::sort(members.begin(), members.end(), [&](std::uint32_t a, std::uint32_t b) {
    const double at_a = Light(a).lamp.position_m[axis];
    const double at_b = Light(b).lamp.position_m[axis];
    return at_a != at_b ? at_a < at_b : a < b;
  });
  return members;
}

std::uint32_t LampTree::Join(LampNodes members, const LampEye& eye, const LampStage& stage) {
  if (members.size() == 1) return members.front();
  members = AlongLongestSide(std::move(members));
  const auto middle = members.begin() + static_cast<std::ptrdiff_t>(members.size() / 2);
  const std::uint32_t left = Join({members.begin(), middle}, eye, stage);
  const std::uint32_t right = Join({middle, members.end()}, eye, stage);
  AddSum(members, eye, stage).children = {left, right};
  return static_cast<std::uint32_t>(nodes_.size() - 1);
}

LampNode& LampTree::AddSum(const LampNodes& members, const LampEye& eye, const LampStage& stage) {
  PlacedLamp sum;
  sum.intensity = Bands<float>(stage.bands());
  glm::dvec3 centre(0.0);
  for (const std::uint32_t i : members) {
    const PlacedLamp& light = Light(i);
    sum.candela += light.candela;
    centre += light.candela * light.lamp.position_m;
    sum.lamp.radius_m = std::max(sum.lamp.radius_m, light.lamp.radius_m);
    sum.intensity = sum.intensity + light.intensity;
  }
  sum.lamp.position_m = centre / sum.candela;
  sum.above_ground_m = stage.HeightOverGround(sum.lamp.position_m);
  sum = Before(eye, stage, std::move(sum));
  glm::dmat3 moments(0.0);
  double radius = 0.0;
  for (const std::uint32_t i : members) {
    const glm::dvec3 off = Light(i).lamp.position_m - sum.lamp.position_m;
    moments += Light(i).candela / sum.candela * glm::outerProduct(off, off);
    radius = std::max(radius, glm::length(off));
  }
  LampNode& node = Add(std::move(sum), stage);
  node.moments = moments;
  node.radius_m = radius;
  return node;
}

void LampTree::StandBefore(const LampEye& eye, const LampStage& stage) {
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    PlacedLamp& light = nodes_[i].light;
    light =
        i < lamps_ ? ShiningOn(eye, stage, std::move(light)) : Before(eye, stage, std::move(light));
  }
}

// Lamps share a table when they stand alike: within a tenth of the thinnest layer's scale height,
// and within a fifth of their height over the ground.
void LampTree::MakeGlows(const LampStage& stage) {
  double thinnest_m = std::numeric_limits<double>::infinity();
  for (const LampLayer& layer : stage.layers())
    thinnest_m = std::min(thinnest_m, layer.scale_height_m);
  const double alike_m = std::clamp(0.1 * thinnest_m, 0.5, 100.0);
  struct Stand {
    double altitude_m, above_m;
  };
  std::vector<Stand> stands;
  for (const LampNode& node : nodes_) {
    const Stand here{stage.AltitudeOf(node.light.lamp.position_m), node.light.above_ground_m};
    const auto same = std::find_if(stands.begin(), stands.end(), [&](const Stand& other) {
      return std::abs(other.altitude_m - here.altitude_m) <= alike_m &&
             std::abs(other.above_m - here.above_m) <= 0.2 * std::max(here.above_m, 0.5);
    });
    glow_of_node_.push_back(static_cast<std::size_t>(same - stands.begin()));
    if (same != stands.end()) continue;
    stands.push_back(here);
    glows_.push_back(std::make_shared<const LampGlow>(stage.layers(), here.altitude_m,
                                                      here.altitude_m - here.above_m));
  }
}

}  // namespace alpenglow::renderer
