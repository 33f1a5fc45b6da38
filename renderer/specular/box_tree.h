// SPDX-License-Identifier: MIT
// A binary tree of boxes that finds those which a ray meets.
//
// A node is divided at the median of the centres of its boxes along the longest side of their bounds
// (Kay and Kajiya 1986, SIGGRAPH 20, 269). The tree, and the order of a visit, depend on the boxes only.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "renderer/layer.h"

namespace alpenglow::renderer {

struct Box {
  glm::dvec3 low{std::numeric_limits<double>::infinity()};
  glm::dvec3 high{-std::numeric_limits<double>::infinity()};

  [[nodiscard]] glm::dvec3 Centre() const { return 0.5 * (low + high); }
  [[nodiscard]] Box With(const Box& other) const {
    return {glm::min(low, other.low), glm::max(high, other.high)};
  }
};

/// A stretch of a ray.
struct RaySpan {
  double begin_m, end_m;
};

/// A ray of finite length, ready to be compared with boxes.
class BoxRay {
 public:
  BoxRay(const glm::dvec3& origin, const glm::dvec3& direction, double length_m)
      : origin_(origin), inverse_(1.0 / direction), length_m_(length_m) {}

  /// Returns the stretch within a box; no value if it misses the box.
  [[nodiscard]] std::optional<RaySpan> Within(const Box& box) const {
    // An axis along which the ray does not move has infinite distances of both signs, or NaN on a face
    // of the box, which min and max below ignore.
    double begin = 0.0, end = length_m_;
    for (int axis = 0; axis < 3; ++axis) {
      const double a = (box.low[axis] - origin_[axis]) * inverse_[axis];
      const double b = (box.high[axis] - origin_[axis]) * inverse_[axis];
      begin = std::max(begin, std::min(a, b));
      end = std::min(end, std::max(a, b));
    }
    if (!(begin <= end)) return std::nullopt;
    return RaySpan{begin, end};
  }

 private:
  glm::dvec3 origin_, inverse_;
  double length_m_;
};

/// Immutable; safe to use from many threads.
class BoxTree {
 public:
  explicit BoxTree(std::span<const Box> boxes);

  /// Returns the bounds of all boxes; low exceeds high if there are none.
  [[nodiscard]] Box Bounds() const { return nodes_.empty() ? Box{} : nodes_.front().box; }

  /// Returns the memory of the tree [bytes].
  [[nodiscard]] std::size_t bytes() const {
    return nodes_.size() * sizeof(Node) + order_.size() * sizeof(order_.front());
  }

  /// Calls visit(number) for all boxes whose group of up to four is in a box that the ray meets.
  template <typename Visit>
  void VisitAlong(const BoxRay& ray, const Visit& visit) const {
    if (nodes_.empty()) return;
    std::array<std::uint32_t, kMostDepth> open;
    std::size_t count = 0;
    open[count++] = 0;
    while (count > 0) {
      const std::uint32_t number = open[--count];
      const Node& node = nodes_[number];
      if (!ray.Within(node.box)) continue;
      if (node.count > 0) {
        for (std::uint32_t i = 0; i < node.count; ++i) visit(order_[node.next + i]);
      } else {
        open[count++] = node.next;
        open[count++] = number + 1;
      }
    }
  }

 private:
  static constexpr std::size_t kInLeaf = 4;
  // Halves of 2^32 boxes reach leaves after 30 divisions; a visit keeps one more node than that.
  static constexpr std::size_t kMostDepth = 34;

  struct Node {
    Box box;
    std::uint32_t next =
        0;  // leaf: its first box in order_; else the second half; the first follows
    std::uint32_t count = 0;  // of boxes in a leaf; 0: no leaf
  };
  void Divide(std::span<const Box> boxes, std::size_t first, std::size_t end);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;
};

}  // namespace alpenglow::renderer
