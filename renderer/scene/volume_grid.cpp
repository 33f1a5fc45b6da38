// SPDX-License-Identifier: MIT
#include "renderer/scene/volume_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "atmosphere/base/error.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {
namespace {

constexpr int kVolumeBlock = 4;  // samples per side

/// Finds the next crossing of a line with the planes `first + step k` of one axis.
class PlaneWalk {
 public:
  // @param at  coordinate at t = begin, in units of planes.
  PlaneWalk(double at, double slope, double begin) : slope_(slope) {
    if (slope_ == 0.0) return;
    const double next = slope_ > 0.0 ? std::floor(at) + 1.0 : std::ceil(at) - 1.0;
    next_ = begin + (next - at) / slope_;
    step_ = 1.0 / std::abs(slope_);
  }
  [[nodiscard]] double next() const { return next_; }
  void Pass() { next_ += step_; }

 private:
  double slope_;
  double next_ = std::numeric_limits<double>::infinity();
  double step_ = 0.0;
};

/// Calls visit(begin, end) for the pieces of a line between planes at integer coordinates.
template <typename Visit>
void WalkPlanes(const glm::dvec3& origin, const glm::dvec3& direction, double begin, double end,
                const Visit& visit) {
  const glm::dvec3 at = origin + begin * direction;
  std::array<PlaneWalk, 3> walks{PlaneWalk(at.x, direction.x, begin),
                                 PlaneWalk(at.y, direction.y, begin),
                                 PlaneWalk(at.z, direction.z, begin)};
  double from = begin;
  while (from < end) {
    PlaneWalk& nearest = *std::min_element(
        walks.begin(), walks.end(),
        [](const PlaneWalk& a, const PlaneWalk& b) { return a.next() < b.next(); });
    const double to = std::min(nearest.next(), end);
    if (to > from) visit(from, to);
    from = std::max(from, to);
    nearest.Pass();
  }
}

std::size_t CountOf(const std::array<int, 3>& size) {
  std::size_t count = 1;
  for (const int side : size) count *= static_cast<std::size_t>(side);
  return count;
}

}  // namespace

void CheckGridSize(const std::array<int, 3>& size) {
  for (const int side : size) {
    if (!(side >= 2 && side <= kMostGridSamples)) {
      throw InputError(fmt::format("a grid of {} x {} x {} samples; each side must have 2 to {}",
                                   size[0], size[1], size[2], kMostGridSamples));
    }
  }
}

VolumeGrid::VolumeGrid(const std::array<int, 3>& size, std::vector<float> values,
                       GridValues allowed)
    : size_(size), values_(std::move(values)) {
  CheckGridSize(size);
  if (values_.size() != CountOf(size)) {
    throw InputError(fmt::format("{} values for a grid of {} x {} x {} samples", values_.size(),
                                 size[0], size[1], size[2]));
  }
  for (std::size_t i = 0; i < values_.size(); ++i) {
    const bool is_allowed = values_[i] >= 0.0F || allowed == GridValues::kAny;
    if (is_allowed && std::isfinite(values_[i])) continue;
    throw InputError(fmt::format("value {} of the grid is {}; {}", i, values_[i],
                                 allowed == GridValues::kAny
                                     ? "values must be finite"
                                     : "densities must be finite and not negative"));
  }
  FindLargest();
}

void VolumeGrid::FindLargest() {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    blocks_[axis] = (size_[axis] - 2) / kVolumeBlock + 1;
  }
  for (int bz = 0; bz < blocks_[2]; ++bz) {
    for (int by = 0; by < blocks_[1]; ++by) {
      for (int bx = 0; bx < blocks_[0]; ++bx) {
        float least = std::numeric_limits<float>::max(), most = -least;
        for (int z = kVolumeBlock * bz; z <= std::min(kVolumeBlock * (bz + 1), size_[2] - 1); ++z) {
          for (int y = kVolumeBlock * by; y <= std::min(kVolumeBlock * (by + 1), size_[1] - 1);
               ++y) {
            for (int x = kVolumeBlock * bx; x <= std::min(kVolumeBlock * (bx + 1), size_[0] - 1);
                 ++x) {
              least = std::min(least, values_[Index(x, y, z)]);
              most = std::max(most, values_[Index(x, y, z)]);
            }
          }
        }
        least_in_block_.push_back(least);
        largest_in_block_.push_back(most);
        largest_ = std::max(largest_, static_cast<double>(most));
      }
    }
  }
}

double VolumeGrid::At(const glm::dvec3& point) const {
  std::array<int, 3> low{};
  std::array<double, 3> share{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const double u = std::clamp(point[axis] * size_[a] - 0.5, 0.0, size_[a] - 1.0);
    low[a] = std::min(static_cast<int>(u), size_[a] - 2);
    share[a] = u - low[a];
  }
  const auto along_x = [&](int y, int z) {
    const float* row = values_.data() + Index(low[0], low[1] + y, low[2] + z);
    return (1.0 - share[0]) * static_cast<double>(row[0]) + share[0] * static_cast<double>(row[1]);
  };
  const auto along_xy = [&](int z) {
    return (1.0 - share[1]) * along_x(0, z) + share[1] * along_x(1, z);
  };
  return (1.0 - share[2]) * along_xy(0) + share[2] * along_xy(1);
}

std::vector<ValuePiece> VolumeGrid::BlocksAlong(const glm::dvec3& origin,
                                                const glm::dvec3& direction, double begin,
                                                double end) const {
  const glm::dvec3 scale = glm::dvec3(size_[0], size_[1], size_[2]) / double{kVolumeBlock};
  const glm::dvec3 from = origin * scale - 0.5 / kVolumeBlock;
  const glm::dvec3 slope = direction * scale;
  std::vector<ValuePiece> pieces;
  WalkPlanes(from, slope, begin, end, [&](double a, double b) {
    const glm::dvec3 middle = from + 0.5 * (a + b) * slope;
    std::size_t index = 0;
    for (int axis = 2; axis >= 0; --axis) {
      const int blocks = blocks_[static_cast<std::size_t>(axis)];
      const int block = std::clamp(static_cast<int>(std::floor(middle[axis])), 0, blocks - 1);
      index = index * static_cast<std::size_t>(blocks) + static_cast<std::size_t>(block);
    }
    pieces.push_back({a, b, static_cast<double>(least_in_block_[index]),
                      static_cast<double>(largest_in_block_[index])});
  });
  return pieces;
}

std::vector<DensePiece> VolumeGrid::PiecesAlong(const glm::dvec3& origin,
                                                const glm::dvec3& direction, double begin_m,
                                                double end_m) const {
  std::vector<DensePiece> pieces;
  for (const ValuePiece& block : BlocksAlong(origin, direction, begin_m, end_m)) {
    if (block.largest > 0.0) pieces.push_back({block.begin, block.end, block.largest});
  }
  return pieces;
}

double CubicPiece::At(double s) const {
  const double t = 1.0 - s;
  return t * t * (t * coefficients[0] + 3.0 * s * coefficients[1]) +
         s * s * (3.0 * t * coefficients[2] + s * coefficients[3]);
}

std::vector<CubicPiece> VolumeGrid::CubicsAlong(const glm::dvec3& origin,
                                                const glm::dvec3& direction, double begin,
                                                double end) const {
  const glm::dvec3 scale(size_[0], size_[1], size_[2]);
  std::vector<CubicPiece> pieces;
  WalkPlanes(origin * scale - 0.5, direction * scale, begin, end, [&](double a, double b) {
    std::array<double, 4> v{};
    for (std::size_t i = 0; i < v.size(); ++i)
      v[i] = At(origin + (a + static_cast<double>(i) / 3.0 * (b - a)) * direction);
    pieces.push_back({a,
                      b,
                      {v[0], (-5.0 * v[0] + 18.0 * v[1] - 9.0 * v[2] + 2.0 * v[3]) / 6.0,
                       (2.0 * v[0] - 9.0 * v[1] + 18.0 * v[2] - 5.0 * v[3]) / 6.0, v[3]}});
  });
  return pieces;
}

double VolumeGrid::Column(const glm::dvec3& origin, const glm::dvec3& direction, double begin,
                          double end) const {
  constexpr double kGauss = 0.21132486540518712;  // (1 - 1 / sqrt 3) / 2
  const glm::dvec3 scale(size_[0], size_[1], size_[2]);
  double sum = 0.0;
  for (const DensePiece& piece : PiecesAlong(origin, direction, begin, end)) {
    WalkPlanes(origin * scale - 0.5, direction * scale, piece.begin_m, piece.end_m,
               [&](double a, double b) {
                 const double near = a + kGauss * (b - a);
                 const double far = b - kGauss * (b - a);
                 sum +=
                     0.5 * (b - a) * (At(origin + near * direction) + At(origin + far * direction));
               });
  }
  return sum;
}

}  // namespace alpenglow::renderer
