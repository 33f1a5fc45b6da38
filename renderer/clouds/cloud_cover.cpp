// SPDX-License-Identifier: MIT
#include "renderer/clouds/cloud_cover.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "renderer/layer.h"
#include "renderer/procedural_mountains/lattice_noise.h"

namespace alpenglow::renderer {
namespace {

constexpr double kColumnSpacing_m = 160.0;
constexpr int kHalvings = 10;

/// Returns whether the optical depth of a column exceeds a limit.
/// @param depth_m  of the shape at a point.
template <typename Depth>
bool IsCovered(const CloudLattice& lattice, const CloudMatter& matter, const glm::dvec2& place,
               double least_optical_depth, const Depth& depth_m) {
  const double step = lattice.voxel_m.z;
  double sum = 0.0;
  for (int k = 0; k < lattice.voxels[2]; ++k) {
    const double z = lattice.origin_m.z + (k + 0.5) * step;
    const double core = matter.column.Extinction_per_m(z);
    if (core == 0.0) continue;
    sum += step * core * matter.edge.FractionAt(depth_m({place.x, place.y, z}));
    if (sum > least_optical_depth) return true;
  }
  return false;
}

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
  const int side = std::max(16, static_cast<int>(lattice.size_m().x / kColumnSpacing_m));
  const double spacing = lattice.size_m().x / side;
  const auto cover_at = [&](double parameter) {
    const auto depth = [&](const glm::dvec3& point) { return depth_m(point, parameter); };
    const auto covered_in = [&](const tbb::blocked_range<int>& rows, int covered) {
      for (int y = rows.begin(); y < rows.end(); ++y) {
        for (int x = 0; x < side; ++x) {
          // Columns lie anywhere in their cells, so that rows of clouds cannot fall between them.
          const glm::dvec2 place =
              spacing *
              (glm::dvec2(x, y) + glm::dvec2(LatticeUniform(x, y, 1U), LatticeUniform(x, y, 2U)));
          covered += IsCovered(lattice, matter, place, wanted.least_optical_depth, depth) ? 1 : 0;
        }
      }
      return covered;
    };
    const int covered =
        tbb::parallel_reduce(tbb::blocked_range<int>(0, side), 0, covered_in, std::plus<>());
    return static_cast<double>(covered) / (side * side);
  };
  double low = wanted.low, high = wanted.high;
  for (int halving = 0; halving < kHalvings; ++halving) {
    const double middle = 0.5 * (low + high);
    (cover_at(middle) < wanted.cover ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace alpenglow::renderer
