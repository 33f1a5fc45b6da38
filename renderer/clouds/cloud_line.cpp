// SPDX-License-Identifier: MIT
#include "renderer/clouds/cloud_line.h"

#include <array>
#include <cmath>

namespace alpenglow::renderer {

void CloudField::Line::FindBlock() {
  const glm::dvec3 at = voxel_ + at_m_ * per_m_;
  const Cell cell = field_->CellIn(at);
  depth_ = nullptr;
  if (!cell.is_inside) {
    const CloudSpan span = field_->SpanAhead(origin_ + at_m_ * direction_, direction_);
    // A point on the border may be inside by the rounding of SpanAhead().
    block_until_m_ =
        at_m_ + (span.majorant_per_m > 0.0 ? field_->behind_border_m() : span.length_m);
    return;
  }
  const Bricks& bricks = *field_->bricks_;
  const std::size_t brick = field_->BrickOf(cell);
  block_until_m_ = at_m_ + field_->LengthIn_m(cell, bricks.distance[brick], m_per_voxel_);
  if (bricks.slot[brick] < 0) return;
  const auto slot = static_cast<std::size_t>(bricks.slot[brick]);
  for (int axis = 0; axis < 3; ++axis) {
    low_[axis] = at[axis] - cell.share[axis] - cell.voxel[static_cast<std::size_t>(axis)] % kSide;
  }
  depth_ = bricks.depth.data() + slot * kBrick;
  filled_ = bricks.filled[slot];
  if (!bricks.extinction_per_m.empty()) {
    extinction_per_m_ = bricks.extinction_per_m.data() + slot * kBrick;
  }
}

double CloudField::Line::ClearAhead_m(double distance_m) {
  GoTo(distance_m);
  if (depth_ == nullptr) return block_until_m_ - at_m_;
  constexpr double kVoxels = kSide / kCubes;
  const glm::dvec3 at = (voxel_ + at_m_ * per_m_ - low_) / kVoxels;
  std::array<int, 3> cube{}, step{};
  std::array<double, 3> next_m{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const bool is_forward = per_m_[axis] >= 0.0;
    cube[a] = std::min(static_cast<int>(at[axis]), kCubes - 1);
    step[a] = is_forward ? 1 : -1;
    next_m[a] = per_m_[axis] == 0.0
                    ? kEndless_m
                    : kVoxels * (cube[a] + (is_forward ? 1 : 0) - at[axis]) * m_per_voxel_[axis];
  }
  double border_m = -1.0;  // of the last cube without cloud
  for (;;) {
    const int number = (cube[2] * kCubes + cube[1]) * kCubes + cube[0];
    if ((filled_ >> static_cast<unsigned>(number) & 1U) != 0) break;
    const std::size_t axis =
        next_m[0] < next_m[1] ? (next_m[0] < next_m[2] ? 0 : 2) : (next_m[1] < next_m[2] ? 1 : 2);
    border_m = std::max(next_m[axis], 0.0);
    cube[axis] += step[axis];
    if (static_cast<unsigned>(cube[axis]) >= kCubes) return block_until_m_ - at_m_;
    next_m[axis] += kVoxels * std::abs(m_per_voxel_[static_cast<int>(axis)]);
  }
  if (border_m < 0.0) return 0.0;
  return std::min(border_m + field_->behind_border_m(), block_until_m_ - at_m_);
}

}  // namespace alpenglow::renderer
