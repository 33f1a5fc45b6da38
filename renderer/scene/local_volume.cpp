// SPDX-License-Identifier: MIT
#include "renderer/scene/local_volume.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>
#include <string>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/lamp/lamp.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {
namespace {

constexpr int kBlock = 4;  // samples per side

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

VolumeGrid::VolumeGrid(const std::array<int, 3>& size, std::vector<float> values)
    : size_(size), values_(std::move(values)) {
  CheckGridSize(size);
  if (values_.size() != CountOf(size)) {
    throw InputError(fmt::format("{} values for a grid of {} x {} x {} samples", values_.size(),
                                 size[0], size[1], size[2]));
  }
  for (std::size_t i = 0; i < values_.size(); ++i) {
    if (!(values_[i] >= 0.0F && std::isfinite(values_[i]))) {
      throw InputError(
          fmt::format("value {} of the grid is {}; densities must be finite and not "
                      "negative",
                      i, values_[i]));
    }
  }
  FindLargest();
}

void VolumeGrid::FindLargest() {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    blocks_[axis] = (size_[axis] - 2) / kBlock + 1;
  }
  for (int bz = 0; bz < blocks_[2]; ++bz) {
    for (int by = 0; by < blocks_[1]; ++by) {
      for (int bx = 0; bx < blocks_[0]; ++bx) {
        float most = 0.0F;
        for (int z = kBlock * bz; z <= std::min(kBlock * (bz + 1), size_[2] - 1); ++z) {
          for (int y = kBlock * by; y <= std::min(kBlock * (by + 1), size_[1] - 1); ++y) {
            for (int x = kBlock * bx; x <= std::min(kBlock * (bx + 1), size_[0] - 1); ++x) {
              most = std::max(most, values_[Index(x, y, z)]);
            }
          }
        }
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

std::vector<VolumeGrid::Piece> VolumeGrid::PiecesAlong(const glm::dvec3& origin,
                                                       const glm::dvec3& direction, double begin,
                                                       double end) const {
  const glm::dvec3 scale = glm::dvec3(size_[0], size_[1], size_[2]) / double{kBlock};
  const glm::dvec3 from = origin * scale - 0.5 / kBlock;
  const glm::dvec3 slope = direction * scale;
  std::vector<Piece> pieces;
  WalkPlanes(from, slope, begin, end, [&](double a, double b) {
    const glm::dvec3 middle = from + 0.5 * (a + b) * slope;
    std::size_t index = 0;
    for (int axis = 2; axis >= 0; --axis) {
      const int blocks = blocks_[static_cast<std::size_t>(axis)];
      const int block = std::clamp(static_cast<int>(std::floor(middle[axis])), 0, blocks - 1);
      index = index * static_cast<std::size_t>(blocks) + static_cast<std::size_t>(block);
    }
    const auto largest = static_cast<double>(largest_in_block_[index]);
    if (largest > 0.0) pieces.push_back({a, b, largest});
  });
  return pieces;
}

double VolumeGrid::Column(const glm::dvec3& origin, const glm::dvec3& direction, double begin,
                          double end) const {
  constexpr double kGauss = 0.21132486540518712;  // (1 - 1 / sqrt 3) / 2
  const glm::dvec3 scale(size_[0], size_[1], size_[2]);
  double sum = 0.0;
  for (const Piece& piece : PiecesAlong(origin, direction, begin, end)) {
    WalkPlanes(
        origin * scale - 0.5, direction * scale, piece.begin, piece.end, [&](double a, double b) {
          const double near = a + kGauss * (b - a);
          const double far = b - kGauss * (b - a);
          sum += 0.5 * (b - a) * (At(origin + near * direction) + At(origin + far * direction));
        });
  }
  return sum;
}

namespace {

/// A line in the coordinates of the unit cube.
struct UnitLine {
  glm::dvec3 origin, direction;
};

UnitLine InUnits(const LocalVolume& volume, const glm::dvec3& origin, const glm::dvec3& direction) {
  const VolumePlacement& p = volume.placement();
  return {volume.UnitFromFrame(origin),
          glm::dvec3(glm::dot(direction, p.across), glm::dot(direction, p.ahead),
                     glm::dot(direction, p.up)) /
              p.size_m};
}

std::optional<LineSpan> InUnitCube(const UnitLine& line, double length_m) {
  double begin = 0.0, end = length_m;
  for (int axis = 0; axis < 3; ++axis) {
    if (line.direction[axis] == 0.0) {
      if (!(line.origin[axis] >= 0.0 && line.origin[axis] <= 1.0)) return std::nullopt;
      continue;
    }
    const double a = -line.origin[axis] / line.direction[axis];
    const double b = (1.0 - line.origin[axis]) / line.direction[axis];
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  if (!(begin < end)) return std::nullopt;
  return LineSpan{begin, end};
}

// Returns the part of a line in the sphere of radius 1/2 in the middle of the cube.
std::optional<LineSpan> InUnitBall(const UnitLine& line, double length_m) {
  const glm::dvec3 from = line.origin - 0.5;
  const double a = glm::dot(line.direction, line.direction);
  const double nearest = -glm::dot(from, line.direction) / a;
  // Square the distance vector from the middle: b^2 - 4 a c would lose digits to cancellation.
  const glm::dvec3 off = from + nearest * line.direction;
  const double left = 0.25 - glm::dot(off, off);
  if (left <= 0.0) return std::nullopt;
  const double half = std::sqrt(left / a);
  const LineSpan span{std::max(nearest - half, 0.0), std::min(nearest + half, length_m)};
  if (!(span.begin_m < span.end_m)) return std::nullopt;
  return span;
}

}  // namespace

LocalVolume::LocalVolume(const VolumePlacement& placement, std::optional<double> scale_height_m,
                         std::shared_ptr<const VolumeGrid> grid)
    : placement_(placement), scale_height_m_(scale_height_m), grid_(std::move(grid)) {
  for (int axis = 0; axis < 3; ++axis) ALPENGLOW_ENSURE(placement.size_m[axis], >, 0.0);
  ALPENGLOW_ENSURE(int{scale_height_m.has_value()} + int{grid_ != nullptr}, <=, 1);
}

glm::dvec3 LocalVolume::Middle() const { return FrameFromUnit(glm::dvec3(0.5)); }

glm::dvec3 LocalVolume::UnitFromFrame(const glm::dvec3& point) const {
  const glm::dvec3 off = point - placement_.bottom;
  return glm::dvec3(glm::dot(off, placement_.across) / placement_.size_m.x + 0.5,
                    glm::dot(off, placement_.ahead) / placement_.size_m.y + 0.5,
                    glm::dot(off, placement_.up) / placement_.size_m.z);
}

glm::dvec3 LocalVolume::FrameFromUnit(const glm::dvec3& unit) const {
  return placement_.bottom + (unit.x - 0.5) * placement_.size_m.x * placement_.across +
         (unit.y - 0.5) * placement_.size_m.y * placement_.ahead +
         unit.z * placement_.size_m.z * placement_.up;
}

double LocalVolume::DensityIn(const glm::dvec3& unit) const {
  if (grid_) return grid_->At(unit);
  if (scale_height_m_) return std::exp(-unit.z * placement_.size_m.z / *scale_height_m_);
  return 1.0;
}

double LocalVolume::DensityAt(const glm::dvec3& point) const {
  const glm::dvec3 unit = UnitFromFrame(point);
  const glm::dvec3 off = unit - 0.5;
  const bool inside = placement_.shape == VolumePlacement::Shape::kBox
                          ? std::max({std::abs(off.x), std::abs(off.y), std::abs(off.z)}) <= 0.5
                          : glm::dot(off, off) <= 0.25;
  return inside ? DensityIn(unit) : 0.0;
}

std::optional<LineSpan> LocalVolume::SpanAlong(const glm::dvec3& origin,
                                               const glm::dvec3& direction, double length_m) const {
  const UnitLine line = InUnits(*this, origin, direction);
  return placement_.shape == VolumePlacement::Shape::kBox ? InUnitCube(line, length_m)
                                                          : InUnitBall(line, length_m);
}

std::vector<DensePiece> LocalVolume::PiecesAlong(const glm::dvec3& origin,
                                                 const glm::dvec3& direction,
                                                 double length_m) const {
  const std::optional<LineSpan> span = SpanAlong(origin, direction, length_m);
  if (!span) return {};
  const UnitLine line = InUnits(*this, origin, direction);
  if (!grid_) {
    const double most = std::max(DensityIn(line.origin + span->begin_m * line.direction),
                                 DensityIn(line.origin + span->end_m * line.direction));
    return {{span->begin_m, span->end_m, most}};
  }
  std::vector<DensePiece> pieces;
  for (const auto& [begin, end, most] :
       grid_->PiecesAlong(line.origin, line.direction, span->begin_m, span->end_m)) {
    pieces.push_back({begin, end, most});
  }
  return pieces;
}

double LocalVolume::Column(const glm::dvec3& origin, const glm::dvec3& direction,
                           double length_m) const {
  const std::optional<LineSpan> span = SpanAlong(origin, direction, length_m);
  if (!span) return 0.0;
  const UnitLine line = InUnits(*this, origin, direction);
  if (grid_) return grid_->Column(line.origin, line.direction, span->begin_m, span->end_m);
  const double length = span->end_m - span->begin_m;
  if (!scale_height_m_) return length;
  const double rise = line.direction.z * length * placement_.size_m.z / *scale_height_m_;
  return ExponentialColumn(length, DensityIn(line.origin + span->begin_m * line.direction),
                           DensityIn(line.origin + span->end_m * line.direction), rise);
}

}  // namespace alpenglow::renderer
