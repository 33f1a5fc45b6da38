// SPDX-License-Identifier: MIT
#include "renderer/clouds/cloud_cover.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "renderer/layer.h"
#include "renderer/procedural_mountains/lattice_noise.h"

namespace alpenglow::renderer {
namespace {

constexpr double kColumnSpacing_m = 160.0;
constexpr int kLeastColumns = 64;  // along x and y
constexpr int kCoverHalvings = 10;

/// Returns whether the optical depth of the column in the middle of a voxel exceeds a limit. The
/// depth there is the mean of the four corners around it, as that of a stored field is.
/// @param voxel  number along x and y. @param depth_m  of the shape at a point.
template <typename Depth>
bool ColumnIsCovered(const CloudLattice& lattice, const CloudMatter& matter,
                     const glm::ivec2& voxel, double least_optical_depth, const Depth& depth_m) {
  double sum = 0.0;
  for (int k = 0; k < lattice.voxels[2]; ++k) {
    const glm::dvec3 corner = lattice.origin_m + lattice.voxel_m * glm::dvec3(voxel, k);
    const double core = matter.column.Extinction_per_m(corner.z);
    if (core == 0.0) continue;
    double depth = 0.0;
    for (const glm::dvec2 offset : {glm::dvec2(0, 0), {1, 0}, {0, 1}, {1, 1}}) {
      depth += 0.25 * std::clamp(depth_m(corner + lattice.voxel_m * glm::dvec3(offset, 0.0)),
                                 kLeastCloudDepth_m, kMostCloudDepth_m);
    }
    sum += lattice.voxel_m.z * core * matter.edge.FractionAt(depth);
    if (sum > least_optical_depth) return true;
  }
  return false;
}

/// UndecidedColumns of a field whose cover is not decided yet.
class UndecidedColumns {
 public:
  /// The columns lie anywhere in their cells, so that rows of clouds cannot fall between them.
  UndecidedColumns(int voxels, int side) {
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        const glm::dvec2 jitter(LatticeUniform(x, y, 1U), LatticeUniform(x, y, 2U));
        voxels_.emplace_back((glm::dvec2(x, y) + jitter) * (static_cast<double>(voxels) / side));
      }
    }
  }

  /// Returns 1 for every column for which a predicate is true.
  template <typename Predicate>
  [[nodiscard]] std::vector<char> Evaluated(const Predicate& predicate) const {
    std::vector<char> values(voxels_.size());
    tbb::parallel_for(std::size_t{0}, voxels_.size(),
                      [&](std::size_t i) { values[i] = predicate(voxels_[i]) ? 1 : 0; });
    return values;
  }

  /// Drops the columns with a value; returns their number.
  std::size_t KeepOthers(const std::vector<char>& values, bool dropped) {
    std::vector<glm::ivec2> kept;
    for (std::size_t i = 0; i < voxels_.size(); ++i) {
      if ((values[i] == 1) != dropped) kept.push_back(voxels_[i]);
    }
    const std::size_t count = voxels_.size() - kept.size();
    voxels_ = std::move(kept);
    return count;
  }

 private:
  std::vector<glm::ivec2> voxels_;
};

}  // namespace

OpticalDepthMap VerticalOpticalDepths(const CloudField& field, int side) {
  const auto n = static_cast<std::size_t>(side);
  const glm::dvec3 size = field.lattice().size_m();
  OpticalDepthMap map{side, size.x / side, std::vector<float>(n * n)};
  const double step = 0.5 * field.lattice().voxel_m.z;
  tbb::parallel_for(0, side, [&](int y) {
    for (int x = 0; x < side; ++x) {
      glm::dvec3 point = field.lattice().origin_m + map.spacing_m * glm::dvec3(x + 0.5, y + 0.5, 0);
      double sum = 0.0;
      for (int k = 0; k < 2 * field.lattice().voxels[2]; ++k) {
        point.z = field.lattice().origin_m.z + (k + 0.5) * step;
        sum += step * field.Extinction_per_m(point);
      }
      map.optical_depth[static_cast<std::size_t>(y) * n + static_cast<std::size_t>(x)] =
          static_cast<float>(sum);
    }
  });
  return map;
}

double CoverOf(const OpticalDepthMap& map, double least_optical_depth) {
  const auto covered =
      std::count_if(map.optical_depth.begin(), map.optical_depth.end(),
                    [&](float depth) { return static_cast<double>(depth) > least_optical_depth; });
  return static_cast<double>(covered) / static_cast<double>(map.optical_depth.size());
}

double ParameterForCover(const CloudLattice& lattice, const CloudMatter& matter,
                         const DepthWithParameter& depth_m, const WantedCover& wanted) {
  const int side = std::max(kLeastColumns, static_cast<int>(lattice.size_m().x / kColumnSpacing_m));
  UndecidedColumns columns(lattice.voxels[0], side);
  const auto covered_at = [&](double parameter) {
    const auto depth = [&](const glm::dvec3& point) { return depth_m(point, parameter); };
    return columns.Evaluated([&](const glm::ivec2& voxel) {
      return ColumnIsCovered(lattice, matter, voxel, wanted.least_optical_depth, depth);
    });
  };
  const auto target = static_cast<std::size_t>(wanted.cover * side * side + 0.5);
  double low = wanted.low, high = wanted.high;
  // UndecidedColumns that are covered at the low end, or not at the high end, are the same between them.
  std::size_t covered = columns.KeepOthers(covered_at(low), true);
  columns.KeepOthers(covered_at(high), false);
  for (int halving = 0; halving < kCoverHalvings; ++halving) {
    const double middle = 0.5 * (low + high);
    const std::vector<char> at_middle = covered_at(middle);
    const auto more = static_cast<std::size_t>(std::count(at_middle.begin(), at_middle.end(), 1));
    if (covered + more < target) {
      covered += columns.KeepOthers(at_middle, true);
      low = middle;
    } else {
      columns.KeepOthers(at_middle, false);
      high = middle;
    }
  }
  return 0.5 * (low + high);
}

}  // namespace alpenglow::renderer
