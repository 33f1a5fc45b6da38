// SPDX-License-Identifier: MIT
#include "renderer/specular/box_tree.h"

#include <numeric>
#include <utility>

namespace alpenglow::renderer {

BoxTree::BoxTree(std::span<const Box> boxes) : order_(boxes.size()) {
  std::iota(order_.begin(), order_.end(), 0U);
  if (!boxes.empty()) Divide(boxes, 0, boxes.size());
}

void BoxTree::Divide(std::span<const Box> boxes, std::size_t first, std::size_t end) {
  const std::size_t number = nodes_.size();
  nodes_.emplace_back();
  Box bounds, centres;
  for (std::size_t i = first; i < end; ++i) {
    const Box& box = boxes[order_[i]];
    bounds = bounds.With(box);
    centres = centres.With({box.Centre(), box.Centre()});
  }
  nodes_[number].box = bounds;
  if (end - first <= kInLeaf) {
    nodes_[number].next = static_cast<std::uint32_t>(first);
    nodes_[number].count = static_cast<std::uint32_t>(end - first);
    return;
  }
  const glm::dvec3 size = centres.high - centres.low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const std::size_t middle = first + (end - first) / 2;
  const auto begin = order_.begin();
  // Numbers decide between equal centres, so that the tree is that of the boxes alone.
  std::nth_element(
      begin + static_cast<std::ptrdiff_t>(first), begin + static_cast<std::ptrdiff_t>(middle),
      begin + static_cast<std::ptrdiff_t>(end), [&](std::uint32_t a, std::uint32_t b) {
        return std::pair(boxes[a].Centre()[axis], a) < std::pair(boxes[b].Centre()[axis], b);
      });
  Divide(boxes, first, middle);
  nodes_[number].next = static_cast<std::uint32_t>(nodes_.size());
  Divide(boxes, middle, end);
}

}  // namespace alpenglow::renderer
