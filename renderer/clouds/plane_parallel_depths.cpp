// SPDX-License-Identifier: MIT
#include "renderer/clouds/plane_parallel_depths.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace alpenglow::renderer {

bool IsPlaneParallel(const CloudField& field) {
  const CloudLattice& lattice = field.lattice();
  if (!lattice.is_periodic || field.matter().detail.noise ||
      field.Bounds().low.z >= field.Bounds().high.z)
    return false;
  const auto corner = [&](int x, int y, int z) {
    return lattice.origin_m + lattice.voxel_m * glm::dvec3(x, y, z);
  };
  for (int y = 0; y < lattice.voxels[1]; ++y) {
    for (int x = 0; x < lattice.voxels[0]; ++x) {
      for (int z = 0; z < lattice.voxels[2]; ++z) {
        const glm::dvec3 first = corner(0, 0, z), other = corner(x, y, z);
        const CloudField::Sample a = field.SampleAt(first), b = field.SampleAt(other);
        if (a.depth_m != b.depth_m || a.extinction_per_m != b.extinction_per_m ||
            field.EffectiveRadius_um(first) != field.EffectiveRadius_um(other))
          return false;
      }
    }
  }
  return true;
}

PlaneParallelDepths::PlaneParallelDepths(const CloudField& field)
    : base_m_(field.base_altitude_m()), top_m_(field.top_altitude_m()) {
  constexpr double kPerVoxel = 16.0;
  const CloudLattice& lattice = field.lattice();
  const int steps = static_cast<int>(std::ceil(kPerVoxel * (top_m_ - base_m_) / lattice.voxel_m.z));
  const double step_m = (top_m_ - base_m_) / steps;
  glm::dvec3 point = lattice.origin_m;
  above_.push_back(0.0);
  for (int i = 0; i < steps; ++i) {
    point.z = top_m_ - (i + 0.5) * step_m;
    above_.push_back(above_.back() + step_m * field.Extinction_per_m(point));
  }
}

double PlaneParallelDepths::Above(double altitude_m) const {
  const auto last = above_.size() - 1;
  const double at =
      std::clamp((top_m_ - altitude_m) / (top_m_ - base_m_), 0.0, 1.0) * static_cast<double>(last);
  const auto step = std::min(static_cast<std::size_t>(at), last - 1);
  return std::lerp(above_[step], above_[step + 1], at - static_cast<double>(step));
}

double PlaneParallelDepths::AltitudeOf(double depth) const {
  const auto next = std::lower_bound(above_.begin() + 1, above_.end() - 1, depth);
  const double rise = *next - *(next - 1);
  const double share = rise > 0.0 ? std::clamp((depth - *(next - 1)) / rise, 0.0, 1.0) : 0.5;
  const double at = static_cast<double>(next - above_.begin()) - 1.0 + share;
  return top_m_ - at / static_cast<double>(above_.size() - 1) * (top_m_ - base_m_);
}

double PlaneParallelDepths::Extinction_per_m(double altitude_m) const {
  const double half_m = 0.5 * (top_m_ - base_m_) / static_cast<double>(above_.size() - 1);
  return (Above(altitude_m - half_m) - Above(altitude_m + half_m)) / (2.0 * half_m);
}

}  // namespace alpenglow::renderer
