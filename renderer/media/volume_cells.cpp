// SPDX-License-Identifier: MIT
#include "renderer/media/volume_cells.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <numeric>

namespace alpenglow::renderer {
namespace {

// Optical depth of a cell, without the forward peak, below which smaller cells change nothing.
constexpr double kVolumeCellDepth = 0.3;
constexpr int kLeastCells = 6, kMostCellsAlong = 400;  // of the finest grid, along an axis
// Along the shortest side of a deep body, with one cell for this optical depth.
constexpr int kLeastCellsOfDeep = 16;
constexpr double kDepthOfLeastCells = 1.25;
constexpr int kMostSamplesPerSide = 4;
// Beams through each side of a cell on the surface, along an axis.
constexpr int kBeamsPerSide = 4;
// Planes of beams are shared among this number of sums, which are added in order.
constexpr int kSunBeamSums = 16;

/// Returns the axes of a body from the longest to the shortest side, as columns of a matrix.
glm::dmat3 AxesByLength(const VolumePlacement& placement) {
  const std::array<glm::dvec3, 3> axis{placement.across, placement.ahead, placement.up};
  std::array<int, 3> order{0, 1, 2};
  std::ranges::stable_sort(order, std::greater<>(), [&](int i) { return placement.size_m[i]; });
  const auto of = [&](std::size_t i) { return axis[static_cast<std::size_t>(order[i])]; };
  return {of(0), of(1), of(2)};
}

glm::dvec3 SidesByLength(const VolumePlacement& placement) {
  std::array<double, 3> side{placement.size_m.x, placement.size_m.y, placement.size_m.z};
  std::ranges::sort(side, std::greater<>());
  return {side[0], side[1], side[2]};
}

/// Returns the number of cells of the finest grid along each axis of a box.
/// @param size_m  from the longest to the shortest.
std::array<int, 3> CellCountOf(const glm::dvec3& size_m, double thickest_per_m, double most_cells) {
  const double thin_m = kVolumeCellDepth / thickest_per_m;
  std::array<int, 3> count{};
  double volume_m3 = size_m.x * size_m.y * size_m.z, cells = most_cells;
  for (int axis = 2; axis >= 0; --axis) {
    const double side_m = std::max(std::pow(volume_m3 / cells, 1.0 / (axis + 1)), thin_m);
    int along = static_cast<int>(std::lround(std::min(size_m[axis] / side_m, 1e6)));
    if (axis == 2 && along < kLeastCells) {
      const double deep = std::min(size_m.z * thickest_per_m / kDepthOfLeastCells, 1e3);
      along = std::clamp(static_cast<int>(deep), kLeastCells, kLeastCellsOfDeep);
    }
    along = std::clamp(along, kLeastCells, kMostCellsAlong);
    count[static_cast<std::size_t>(axis)] = along;
    volume_m3 /= size_m[axis];
    cells = std::max(cells / along, 1.0);
  }
  return count;
}

/// Returns the lattice of a box around the origin, of which the cells are larger by a factor than
/// those of a count.
CloudCellLattice LatticeOf(const glm::dvec3& size_m, const std::array<int, 3>& finest, int times) {
  CloudCellLattice lattice{finest, -0.5 * size_m, glm::dvec3(1.0)};
  for (int axis = 0; axis < 3; ++axis) {
    int& count = lattice.count[static_cast<std::size_t>(axis)];
    count = std::max(static_cast<int>(std::lround(static_cast<double>(count) / times)),
                     std::max(kLeastCells / times, 1));
    lattice.cell_m[axis] = size_m[axis] / count;
    // Light just outside of the body is that of the cells around it.
    lattice.origin_m[axis] -= lattice.cell_m[axis];
    count += 2;
  }
  return lattice;
}

/// Returns the number of samples along each side of a cell that resolves a density and a surface.
int SamplesPerSide(const LocalBody& volume, double most_cells) {
  const auto samples = volume.Samples();
  if (!samples)
    return volume.placement().shape == VolumePlacement::Shape::kBox ? 2 : kMostSamplesPerSide;
  const double all = 1.0 * (*samples)[0] * (*samples)[1] * (*samples)[2];
  return std::clamp(static_cast<int>(std::lround(std::cbrt(all / most_cells))), 2,
                    kMostSamplesPerSide);
}

using CellPlace = std::array<int, 3>;

/// Calls visit(place, begin_m, end_m) for the cells along a ray, in order, until it returns false.
template <typename Visit>
void EachCellAlong(const CloudCellLattice& lattice, const glm::dvec3& origin,
                   const glm::dvec3& direction, double length_m, const Visit& visit) {
  const glm::dvec3 start = (origin - lattice.origin_m) / lattice.cell_m;
  const glm::dvec3 step = direction / lattice.cell_m;
  double at_m = 0.0, end_m = length_m;
  for (int axis = 0; axis < 3; ++axis) {
    const double count = lattice.count[static_cast<std::size_t>(axis)];
    if (step[axis] == 0.0) {
      if (start[axis] < 0.0 || start[axis] > count) return;
      continue;
    }
    const double low_m = -start[axis] / step[axis], high_m = (count - start[axis]) / step[axis];
    at_m = std::max(at_m, std::min(low_m, high_m));
    end_m = std::min(end_m, std::max(low_m, high_m));
  }
  CellPlace cell{};
  glm::dvec3 next_m(std::numeric_limits<double>::infinity());
  for (int axis = 0; axis < 3; ++axis) {
    int& index = cell[static_cast<std::size_t>(axis)];
    const double here = start[axis] + at_m * step[axis];
    index = std::clamp(static_cast<int>(std::floor(here)), 0,
                       lattice.count[static_cast<std::size_t>(axis)] - 1);
    if (step[axis] != 0.0)
      next_m[axis] = (index + (step[axis] > 0.0 ? 1.0 : 0.0) - start[axis]) / step[axis];
  }
  while (at_m < end_m) {
    const int axis =
        next_m.x < next_m.y ? (next_m.x < next_m.z ? 0 : 2) : (next_m.y < next_m.z ? 1 : 2);
    const double until_m = std::clamp(next_m[axis], at_m, end_m);
    if (!visit(cell, at_m, until_m)) return;
    at_m = until_m;
    int& index = cell[static_cast<std::size_t>(axis)];
    index += step[axis] > 0.0 ? 1 : -1;
    if (index < 0 || index >= lattice.count[static_cast<std::size_t>(axis)]) return;
    next_m[axis] += std::abs(1.0 / step[axis]);
  }
}

}  // namespace

glm::dvec3 VolumeWay::At(double column_m) const {
  if (nodes_.empty()) return origin_;
  const auto after = std::ranges::lower_bound(nodes_, column_m, {}, &Node::column_m);
  if (after == nodes_.end()) return origin_ + nodes_.back().distance_m * direction_;
  if (after == nodes_.begin()) return origin_ + after->distance_m * direction_;
  const Node& before = *std::prev(after);
  const double share = (column_m - before.column_m) / (after->column_m - before.column_m);
  return origin_ + std::lerp(before.distance_m, after->distance_m, share) * direction_;
}

VolumeCells::VolumeCells(const LocalBody& volume, const Options& options)
    : volume_(volume),
      middle_(volume.Middle()),
      frame_from_cells_(AxesByLength(volume.placement())),
      samples_per_side_(SamplesPerSide(volume, options.most_cells)) {
  const glm::dvec3 size_m = SidesByLength(volume.placement());
  const std::array<int, 3> finest = CellCountOf(size_m, options.thickest_per_m, options.most_cells);
  lattice_ = LatticeOf(size_m, finest, 1);
  Limit(options.scaled_per_m);
  for (const int times : {4, 2, 1}) {
    grids_.push_back(std::make_shared<const CloudCells>(
        LatticeOf(size_m, finest, times), [&](const CloudBox& cell) { return ContentOf(cell); }));
  }
}

std::size_t VolumeCells::PlaceOf(const glm::dvec3& in_cells) const {
  const glm::dvec3 at = glm::floor((in_cells - lattice_.origin_m) / lattice_.cell_m);
  std::size_t place = 0;
  for (int axis = 2; axis >= 0; --axis) {
    const int count = lattice_.count[static_cast<std::size_t>(axis)];
    place = place * static_cast<std::size_t>(count) +
            static_cast<std::size_t>(std::clamp(at[axis], 0.0, count - 1.0));
  }
  return place;
}

double VolumeCells::DensityAt(const glm::dvec3& in_cells) const {
  const double density = volume_.DensityAt(PointInFrame(in_cells));
  if (!is_limited_ || density <= 0.0) return density;
  return density * static_cast<double>(kept_[PlaceOf(in_cells)]);
}

CloudCellContent VolumeCells::ContentOf(const CloudBox& cell) const {
  double sum = 0.0;
  EachSample(cell, [&](const glm::dvec3&, double density) { sum += density; });
  if (sum <= 0.0) return {};
  return {sum / std::pow(samples_per_side_, 3), 1.0};
}

void VolumeCells::Limit(double scaled_per_m) {
  const glm::dvec3& cell_m = lattice_.cell_m;
  const double shortest_m = std::min({cell_m.x, cell_m.y, cell_m.z});
  const int columns = lattice_.count[0], lines = lattice_.count[1], levels = lattice_.count[2];
  const auto size = static_cast<std::size_t>(columns) * static_cast<std::size_t>(lines) *
                    static_cast<std::size_t>(levels);
  std::vector<float> whole(size);  // depths of cells of the body
  tbb::parallel_for(0, lines * levels, [&](int row) {
    for (int x = 0; x < columns; ++x) {
      const glm::dvec3 low = lattice_.origin_m + glm::dvec3(x, row % lines, row / lines) * cell_m;
      double sum = 0.0, samples = 0.0;
      EachSample({low, low + cell_m}, [&](const glm::dvec3&, double density) {
        sum += density;
        samples += 1.0;
      });
      whole[static_cast<std::size_t>(row * columns + x)] =
          static_cast<float>(samples > 0.0 ? scaled_per_m * shortest_m * sum / samples : 0.0);
    }
  });
  std::vector<float> depth(size);
  std::ranges::transform(whole, depth.begin(),
                         [](float of) { return std::min(of, static_cast<float>(kMostDepth)); });
  const std::array<int, 3> stride{1, columns, columns * lines};
  bool changed = true;
  while (changed) {
    changed = false;
    for (int i = 0; i < static_cast<int>(size); ++i) {
      float& here = depth[static_cast<std::size_t>(i)];
      if (here <= static_cast<float>(kOuterDepth)) continue;
      for (int axis = 0; axis < 3; ++axis) {
        const double wider = std::exp2(std::min(cell_m[axis] / shortest_m - 1.0, 10.0));
        for (const int side : {-1, 1}) {
          // Outermost cells are outside of the body, so that the place exists.
          const auto beside =
              static_cast<std::size_t>(i + side * stride[static_cast<std::size_t>(axis)]);
          const auto most = static_cast<float>(
              wider * std::max(kOuterDepth, kGrowth * static_cast<double>(depth[beside])));
          if (here <= most) continue;
          here = most;
          changed = true;
        }
      }
    }
  }
  kept_.resize(size);
  for (std::size_t i = 0; i < size; ++i) {
    kept_[i] = whole[i] > 0.0F ? depth[i] / whole[i] : 1.0F;
    is_limited_ = is_limited_ || kept_[i] < 1.0F;
  }
}

template <typename Visit>
void VolumeCells::EachStretch(const glm::dvec3& origin, const glm::dvec3& direction,
                              double length_m, const Visit& visit) const {
  const std::optional<LineSpan> span = volume_.SpanAlong(origin, direction, length_m);
  if (!span) return;
  const glm::dvec3 start = origin + span->begin_m * direction;
  EachCellAlong(
      lattice_, PointInCells(start), DirectionInCells(direction), span->end_m - span->begin_m,
      [&](const CellPlace& cell, double begin_m, double end_m) {
        const std::size_t place =
            (static_cast<std::size_t>(cell[2]) * static_cast<std::size_t>(lattice_.count[1]) +
             static_cast<std::size_t>(cell[1])) *
                static_cast<std::size_t>(lattice_.count[0]) +
            static_cast<std::size_t>(cell[0]);
        const double column_m =
            static_cast<double>(kept_[place]) *
            volume_.Column(start + begin_m * direction, direction, end_m - begin_m);
        return visit(span->begin_m + begin_m, span->begin_m + end_m, column_m);
      });
}

double VolumeCells::Column(const glm::dvec3& origin, const glm::dvec3& direction,
                           double length_m) const {
  double column_m = 0.0;
  EachStretch(origin, direction, length_m, [&](double, double, double more_m) {
    column_m += more_m;
    return true;
  });
  return column_m;
}

VolumeWay VolumeCells::WayAlong(const glm::dvec3& origin, const glm::dvec3& direction,
                                double most_column_m) const {
  std::vector<VolumeWay::Node> nodes;
  EachStretch(origin, direction, std::numeric_limits<double>::infinity(),
              [&](double begin_m, double end_m, double more_m) {
                if (nodes.empty()) nodes.push_back({begin_m, 0.0});
                if (more_m > 0.0) {
                  if (nodes.back().distance_m < begin_m)
                    nodes.push_back({begin_m, nodes.back().column_m});
                  nodes.push_back({end_m, nodes.back().column_m + more_m});
                }
                return nodes.back().column_m < most_column_m;
              });
  return {origin, direction, std::move(nodes)};
}

std::vector<float> VolumeCells::BeamIn(const CloudCells& cells, const glm::dvec3& travel,
                                       double scaled_per_m) const {
  const CloudCellLattice& lattice = cells.lattice();
  const glm::dvec3& cell_m = lattice.cell_m;
  std::vector<std::vector<double>> sums(kSunBeamSums);
  tbb::parallel_for(0, kSunBeamSums, [&](int part) {
    std::vector<double>& lost_m2 = sums[static_cast<std::size_t>(part)];
    lost_m2.assign(cells.full(), 0.0);
    const auto follow = [&](const glm::dvec3& start, double area_m2) {
      double left = 1.0;
      EachCellAlong(lattice, start, travel, 1e9,
                    [&](const CellPlace& place, double begin_m, double end_m) {
                      const std::int32_t cell = cells.FullCellOf(place);
                      if (cell < 0) return true;
                      const auto i = static_cast<std::size_t>(cell);
                      const double through =
                          std::exp(-scaled_per_m * cells.Extinction_per_m(i) * (end_m - begin_m));
                      lost_m2[i] += area_m2 * left * (1.0 - through);
                      left *= through;
                      return left > 1e-7;
                    });
    };
    for (int axis = 0; axis < 3; ++axis) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      const double area_m2 =
          std::abs(travel[axis]) * cell_m[u] * cell_m[v] / (kBeamsPerSide * kBeamsPerSide);
      if (area_m2 == 0.0) continue;
      const int beams_u = kBeamsPerSide * lattice.count[static_cast<std::size_t>(u)];
      const int beams_v = kBeamsPerSide * lattice.count[static_cast<std::size_t>(v)];
      for (int j = beams_v * part / kSunBeamSums; j < beams_v * (part + 1) / kSunBeamSums; ++j) {
        for (int i = 0; i < beams_u; ++i) {
          glm::dvec3 start = lattice.origin_m;
          if (travel[axis] < 0.0)
            start[axis] += lattice.count[static_cast<std::size_t>(axis)] * cell_m[axis];
          start[u] += (i + 0.5) / kBeamsPerSide * cell_m[u];
          start[v] += (j + 0.5) / kBeamsPerSide * cell_m[v];
          follow(start, area_m2);
        }
      }
    }
  });
  const double volume_m3 = cell_m.x * cell_m.y * cell_m.z;
  std::vector<float> beam(cells.full());
  for (std::size_t cell = 0; cell < beam.size(); ++cell) {
    double lost_m2 = 0.0;
    for (const std::vector<double>& sum : sums) lost_m2 += sum[cell];
    beam[cell] =
        static_cast<float>(lost_m2 / (scaled_per_m * cells.Extinction_per_m(cell) * volume_m3));
  }
  return beam;
}

}  // namespace alpenglow::renderer
