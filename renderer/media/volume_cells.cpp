// SPDX-License-Identifier: MIT
#include "renderer/media/volume_cells.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <limits>
#include <optional>
#include <utility>

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
// Lines of beams are shared among this number of sums, which are added in order.
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
CloudCellLattice VolumeLatticeOf(const glm::dvec3& size_m, const std::array<int, 3>& finest,
                                 int times) {
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

/// Returns the interval of a line within a lattice; positions and steps are in cells.
std::optional<LineSpan> SpanInLattice(const CloudCellLattice& lattice, const glm::dvec3& start,
                                      const glm::dvec3& step, double length_m) {
  LineSpan span{0.0, length_m};
  for (int axis = 0; axis < 3; ++axis) {
    const double count = lattice.count[static_cast<std::size_t>(axis)];
    if (step[axis] == 0.0) {
      if (start[axis] < 0.0 || start[axis] > count) return std::nullopt;
      continue;
    }
    const double low_m = -start[axis] / step[axis], high_m = (count - start[axis]) / step[axis];
    span.begin_m = std::max(span.begin_m, std::min(low_m, high_m));
    span.end_m = std::min(span.end_m, std::max(low_m, high_m));
  }
  return span.begin_m < span.end_m ? std::optional(span) : std::nullopt;
}

/// Calls visit(place, begin_m, end_m) for the cells along a ray, in order, until it returns false.
template <typename Visit>
void EachCellAlong(const CloudCellLattice& lattice, const glm::dvec3& origin,
                   const glm::dvec3& direction, double length_m, const Visit& visit) {
  const glm::dvec3 start = (origin - lattice.origin_m) / lattice.cell_m;
  const glm::dvec3 step = direction / lattice.cell_m;
  const std::optional<LineSpan> span = SpanInLattice(lattice, start, step, length_m);
  if (!span) return;
  CellPlace cell{};
  glm::dvec3 next_m(std::numeric_limits<double>::infinity());
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const double here = start[axis] + span->begin_m * step[axis];
    cell[a] = std::clamp(static_cast<int>(std::floor(here)), 0, lattice.count[a] - 1);
    if (step[axis] != 0.0)
      next_m[axis] = (cell[a] + (step[axis] > 0.0 ? 1.0 : 0.0) - start[axis]) / step[axis];
  }
  double at_m = span->begin_m;
  while (at_m < span->end_m) {
    const int axis =
        next_m.x < next_m.y ? (next_m.x < next_m.z ? 0 : 2) : (next_m.y < next_m.z ? 1 : 2);
    const double until_m = std::clamp(next_m[axis], at_m, span->end_m);
    if (!visit(cell, at_m, until_m)) return;
    at_m = until_m;
    const auto a = static_cast<std::size_t>(axis);
    cell[a] += step[axis] > 0.0 ? 1 : -1;
    if (cell[a] < 0 || cell[a] >= lattice.count[a]) return;
    next_m[axis] += std::abs(1.0 / step[axis]);
  }
}

std::size_t PlaceInLattice(const CloudCellLattice& lattice, const CellPlace& cell) {
  const auto columns = static_cast<std::size_t>(lattice.count[0]);
  const auto lines = static_cast<std::size_t>(lattice.count[1]);
  return (static_cast<std::size_t>(cell[2]) * lines + static_cast<std::size_t>(cell[1])) * columns +
         static_cast<std::size_t>(cell[0]);
}

/// Lowers the depth of a cell to what the cells beside it allow. Returns whether it changed.
bool LowerDepth(const CloudCellLattice& lattice, const CellPlace& cell, std::vector<float>& depth) {
  const glm::dvec3& cell_m = lattice.cell_m;
  const double shortest_m = std::min({cell_m.x, cell_m.y, cell_m.z});
  float& here = depth[PlaceInLattice(lattice, cell)];
  bool changed = false;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double wider =
        std::exp2(std::min(cell_m[static_cast<int>(axis)] / shortest_m - 1.0, 10.0));
    for (const int side : {-1, 1}) {
      CellPlace beside = cell;
      beside[axis] += side;
      const auto most = static_cast<float>(
          wider * std::max(VolumeCells::kOuterDepth,
                           2.0 * static_cast<double>(depth[PlaceInLattice(lattice, beside)])));
      changed = changed || here > most;
      here = std::min(here, most);
    }
  }
  return changed;
}

/// Returns the depths of cells of the limited body.
/// @param whole  those of the body; cells at the border of the lattice are empty.
std::vector<float> LimitedDepths(const CloudCellLattice& lattice, const std::vector<float>& whole) {
  std::vector<float> depth(whole.size());
  std::ranges::transform(whole, depth.begin(), [](float of) {
    return std::min(of, static_cast<float>(VolumeCells::kMostDepth));
  });
  bool changed = true;
  while (changed) {
    changed = false;
    for (int z = 1; z < lattice.count[2] - 1; ++z) {
      for (int y = 1; y < lattice.count[1] - 1; ++y) {
        for (int x = 1; x < lattice.count[0] - 1; ++x)
          changed = LowerDepth(lattice, {x, y, z}, depth) || changed;
      }
    }
  }
  return depth;
}

/// A beam into cells of a body.
struct SunBeam {
  const CloudCells& cells;
  CloudCellLattice lattice;
  glm::dvec3 travel;
  double scaled_per_m;

  /// Adds the power that one of its parts loses, for unit irradiance, to that of each cell.
  void Follow(const glm::dvec3& start, double area_m2, std::vector<double>& lost_m2) const {
    double left = 1.0;
    EachCellAlong(lattice, start, travel, std::numeric_limits<double>::infinity(),
                  [&](const CellPlace& place, double begin_m, double end_m) {
                    const std::int32_t full = cells.FullCellOf(place);
                    if (full < 0) return true;
                    const auto cell = static_cast<std::size_t>(full);
                    const double through =
                        std::exp(-scaled_per_m * cells.Extinction_per_m(cell) * (end_m - begin_m));
                    lost_m2[cell] += area_m2 * left * (1.0 - through);
                    left *= through;
                    return left > 1e-7;
                  });
  }

  /// Follows those of `part` of kSunBeamSums through the side of the lattice across an axis.
  void FollowThrough(int axis, int part, std::vector<double>& lost_m2) const {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const auto beams = [&](int a) {
      return kBeamsPerSide * lattice.count[static_cast<std::size_t>(a)];
    };
    const glm::dvec3 step_m = lattice.cell_m / static_cast<double>(kBeamsPerSide);
    const double area_m2 = std::abs(travel[axis]) * step_m[u] * step_m[v];
    if (area_m2 == 0.0) return;
    glm::dvec3 start = lattice.origin_m;
    if (travel[axis] < 0.0) start[axis] += beams(axis) * step_m[axis];
    for (int j = beams(v) * part / kSunBeamSums; j < beams(v) * (part + 1) / kSunBeamSums; ++j) {
      start[v] = lattice.origin_m[v] + (j + 0.5) * step_m[v];
      for (int i = 0; i < beams(u); ++i) {
        start[u] = lattice.origin_m[u] + (i + 0.5) * step_m[u];
        Follow(start, area_m2, lost_m2);
      }
    }
  }
};

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
  lattice_ = VolumeLatticeOf(size_m, finest, 1);
  Limit(options.scaled_per_m);
  for (const int times : {4, 2, 1}) {
    grids_.push_back(
        std::make_shared<const CloudCells>(VolumeLatticeOf(size_m, finest, times),
                                           [&](const CloudBox& cell) { return ContentOf(cell); }));
  }
}

std::size_t VolumeCells::PlaceOf(const glm::dvec3& in_cells) const {
  const glm::dvec3 at = glm::floor((in_cells - lattice_.origin_m) / lattice_.cell_m);
  CellPlace cell{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    cell[axis] =
        static_cast<int>(std::clamp(at[static_cast<int>(axis)], 0.0, lattice_.count[axis] - 1.0));
  return PlaceInLattice(lattice_, cell);
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
  std::vector<float> whole(static_cast<std::size_t>(columns) * static_cast<std::size_t>(lines) *
                           static_cast<std::size_t>(levels));
  tbb::parallel_for(0, lines * levels, [&](int row) {
    for (int x = 0; x < columns; ++x) {
      const CellPlace cell{x, row % lines, row / lines};
      const glm::dvec3 low = lattice_.origin_m + glm::dvec3(x, cell[1], cell[2]) * cell_m;
      double sum = 0.0, samples = 0.0;
      EachSample({low, low + cell_m}, [&](const glm::dvec3&, double density) {
        sum += density;
        samples += 1.0;
      });
      const double mean = samples > 0.0 ? sum / samples : 0.0;
      whole[PlaceInLattice(lattice_, cell)] = static_cast<float>(scaled_per_m * shortest_m * mean);
    }
  });
  const std::vector<float> depth = LimitedDepths(lattice_, whole);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    kept_.push_back(whole[i] > 0.0F ? depth[i] / whole[i] : 1.0F);
    is_limited_ = is_limited_ || depth[i] < whole[i];
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
        const double whole_m =
            volume_.Column(start + begin_m * direction, direction, end_m - begin_m);
        return visit(span->begin_m + begin_m, span->begin_m + end_m,
                     static_cast<double>(kept_[PlaceInLattice(lattice_, cell)]) * whole_m);
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
  const SunBeam beam{cells, cells.lattice(), travel, scaled_per_m};
  std::vector<std::vector<double>> lost_m2(kSunBeamSums, std::vector<double>(cells.full(), 0.0));
  tbb::parallel_for(0, kSunBeamSums, [&](int part) {
    for (int axis = 0; axis < 3; ++axis)
      beam.FollowThrough(axis, part, lost_m2[static_cast<std::size_t>(part)]);
  });
  const glm::dvec3& cell_m = beam.lattice.cell_m;
  const double volume_m3 = cell_m.x * cell_m.y * cell_m.z;
  std::vector<float> irradiance;
  for (std::size_t cell = 0; cell < cells.full(); ++cell) {
    double sum_m2 = 0.0;
    for (const std::vector<double>& part_m2 : lost_m2) sum_m2 += part_m2[cell];
    irradiance.push_back(
        static_cast<float>(sum_m2 / (scaled_per_m * cells.Extinction_per_m(cell) * volume_m3)));
  }
  return irradiance;
}

}  // namespace alpenglow::renderer
