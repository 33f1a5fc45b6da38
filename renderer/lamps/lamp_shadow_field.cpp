// SPDX-License-Identifier: MIT
#include "renderer/lamps/lamp_shadow_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <optional>

namespace alpenglow::renderer {
namespace {

/// One level of a plan. Positions are columns and rows of its nodes.
class PlanLevel {
 public:
  PlanLevel(const LampStage& stage, const Lamp& lamp, int level)
      : stage_(stage),
        lamp_(lamp),
        step_m_(std::ldexp(kPlanStep_m, level)),
        hole_(level == 0 ? 0 : kHole),
        is_lit_(kPlanSide * kPlanSide, 1),
        from_edge_(kPlanSide * kPlanSide, static_cast<float>(kPlanRange_steps)) {
    to_edge_.fill(std::vector<float>(kPlanSide * kPlanSide, kNoEdge));
    TraceNodes();
    FindEdges();
    EachNode([&](const glm::ivec2& at) {
      if (std::max(at.x, at.y) + 1 < kPlanSide) MeasureCell(at);
    });
  }

  [[nodiscard]] std::uint8_t Texel(std::size_t node) const {
    const double signed_steps = double{is_lit_[node] != 0 ? from_edge_[node] : -from_edge_[node]};
    return static_cast<std::uint8_t>(std::lround(128.0 + 127.0 * signed_steps / kPlanRange_steps));
  }

 private:
  /// Half width of the central hole, whose nodes are not traced because the previous level is used
  /// there. It is 4 steps smaller than the area of the previous level: edges affect nodes at a
  /// distance of two steps, and interpolation reads one step into the area.
  static constexpr int kHole = kPlanReach_steps / 2 - 4;
  /// Bisections for an edge between two nodes. They locate it to a 64th of a step, the resolution
  /// of texels.
  static constexpr int kBisections = 5;
  static constexpr float kNoEdge = -1.0F;

  [[nodiscard]] static std::size_t NodeAt(const glm::ivec2& at) {
    return static_cast<std::size_t>(at.y) * kPlanSide + static_cast<std::size_t>(at.x);
  }
  [[nodiscard]] bool IsInHole(const glm::ivec2& at) const {
    const glm::ivec2 away = glm::abs(at - kPlanSide / 2);
    return std::max(away.x, away.y) < hole_;
  }

  [[nodiscard]] bool IsLitAt(const glm::dvec2& at) const {
    const glm::dvec2 way = step_m_ * (at - 0.5 * kPlanSide);
    const glm::dvec3 place = lamp_.position_m + glm::dvec3(way, 0.0);
    if (const std::optional<SurfaceUnder> ground = stage_.TerrainAt(place))
      return !stage_.Shades(lamp_, ground->hit.smooth_point, ground->hit.geometric_normal);
    const glm::dvec3 up = stage_.UpAt(place);
    return !stage_.Shades(lamp_, place - stage_.AltitudeOf(place) * up, up);
  }

  // Traces every second node in both directions, and the nodes in between only if the ones around
  // them differ.
  void TraceNodes() {
    EachNode([&](const glm::ivec2& at) {
      if (at.x % 2 == 0 && at.y % 2 == 0) is_lit_[NodeAt(at)] = IsLitAt(at);
    });
    EachNode([&](const glm::ivec2& at) {
      if (at.x % 2 == 0 && at.y % 2 == 0) return;
      is_lit_[NodeAt(at)] =
          AlikeAround(at) ? is_lit_[NodeAt(at - at % 2)] : std::uint8_t{IsLitAt(at)};
    });
  }

  // Returns whether all traced nodes around another node are equally lit or in shadow. The
  // neighbourhood is one ring larger than the nearest nodes.
  [[nodiscard]] bool AlikeAround(const glm::ivec2& at) const {
    const std::uint8_t first = is_lit_[NodeAt(at - at % 2)];
    const glm::ivec2 low = glm::max(at - at % 2 - 2, 0);
    const glm::ivec2 high = glm::min(at + at % 2 + 2, kPlanSide - 2);
    for (int row = low.y; row <= high.y; row += 2) {
      for (int column = low.x; column <= high.x; column += 2) {
        if (IsInHole({column, row}) || is_lit_[NodeAt({column, row})] != first) return false;
      }
    }
    return true;
  }

  template <typename Visit>
  void EachNode(const Visit& visit) const {
    for (int row = 0; row < kPlanSide; ++row) {
      for (int column = 0; column < kPlanSide; ++column) {
        if (!IsInHole({column, row})) visit(glm::ivec2(column, row));
      }
    }
  }

  void FindEdges() {
    EachNode([&](const glm::ivec2& at) {
      const glm::ivec2 east = at + glm::ivec2(1, 0), north = at + glm::ivec2(0, 1);
      if (east.x < kPlanSide) to_edge_[0][NodeAt(at)] = EdgeBetween(at, east);
      if (north.y < kPlanSide) to_edge_[1][NodeAt(at)] = EdgeBetween(at, north);
    });
  }

  /// Returns the fraction of the way between two nodes at which light changes to shadow or back;
  /// kNoEdge if it does not.
  [[nodiscard]] float EdgeBetween(const glm::ivec2& from, const glm::ivec2& to) const {
    const bool begins_lit = is_lit_[NodeAt(from)] != 0, ends_lit = is_lit_[NodeAt(to)] != 0;
    if (begins_lit == ends_lit || IsInHole(to)) return kNoEdge;
    double low = 0.0, high = 1.0;
    for (int i = 0; i < kBisections; ++i) {
      const double middle = 0.5 * (low + high);
      const bool is_lit = IsLitAt(glm::mix(glm::dvec2(from), glm::dvec2(to), middle));
      (is_lit == begins_lit ? low : high) = middle;
    }
    return static_cast<float>(0.5 * (low + high));
  }

  // The edge crosses a cell from side to side, and crosses it twice if opposite corners are equal.
  void MeasureCell(const glm::ivec2& cell) {
    std::vector<glm::dvec2> crossings;
    const auto add = [&](const glm::ivec2& from, std::size_t axis) {
      const float share = to_edge_[axis][NodeAt(from)];
      const glm::dvec2 way(axis == 0 ? 1.0 : 0.0, axis == 0 ? 0.0 : 1.0);
      if (share != kNoEdge) crossings.push_back(glm::dvec2(from) + double{share} * way);
    };
    add(cell, 0);
    add(cell + glm::ivec2(1, 0), 1);
    add(cell + glm::ivec2(0, 1), 0);
    add(cell, 1);
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2)
      MeasureTo(crossings[i], crossings[i + 1], cell);
  }

  void MeasureTo(const glm::dvec2& begin, const glm::dvec2& end, const glm::ivec2& cell) {
    for (int row = std::max(cell.y - 1, 0); row <= std::min(cell.y + 2, kPlanSide - 1); ++row) {
      for (int column = std::max(cell.x - 1, 0); column <= std::min(cell.x + 2, kPlanSide - 1);
           ++column) {
        const glm::dvec2 way = end - begin, at = glm::dvec2(column, row) - begin;
        const double length2 = std::max(glm::dot(way, way), 1e-12);
        const double share = std::clamp(glm::dot(at, way) / length2, 0.0, 1.0);
        float& nearest = from_edge_[NodeAt({column, row})];
        nearest = std::min(nearest, static_cast<float>(glm::length(at - share * way)));
      }
    }
  }

  const LampStage& stage_;
  const Lamp& lamp_;
  double step_m_;
  int hole_;
  std::vector<std::uint8_t> is_lit_;
  std::vector<float> from_edge_;               // in steps
  std::array<std::vector<float>, 2> to_edge_;  // edges on the way to the next node east and north
};

}  // namespace

int PlanLevelsOf(double candela) {
  constexpr double kDimmest_lux = 1e-3;
  const double reach_m = std::sqrt(candela / kDimmest_lux);
  const double levels = std::ceil(std::log2(reach_m / (kPlanReach_steps * kPlanStep_m))) + 1.0;
  return static_cast<int>(std::clamp(levels, 1.0, double{kMostPlanLevels}));
}

LampShadowField LampShadowFieldAround(const LampStage& stage, const Lamp& lamp, int levels) {
  LampShadowField plan;
  plan.levels = levels;
  for (int number = 0; number < levels; ++number) {
    const PlanLevel level(stage, lamp, number);
    for (std::size_t node = 0; node < kPlanSide * kPlanSide; ++node)
      plan.texels.push_back(level.Texel(node));
  }
  return plan;
}

}  // namespace alpenglow::renderer
