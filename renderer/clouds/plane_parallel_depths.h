// SPDX-License-Identifier: MIT
// Optical depths by altitude of a field of clouds that is the same at every place.
#pragma once

#include <vector>

#include "renderer/clouds/cloud_field.h"

namespace alpenglow::renderer {

/// Returns whether a periodic field has cloud and is the same at every place. It compares the corners of
/// voxels until two differ.
[[nodiscard]] bool IsPlaneParallel(const CloudField& field);

/// Optical depths of a plane-parallel field below its top, by altitude.
class PlaneParallelDepths {
 public:
  /// @param field  for which IsPlaneParallel holds. Depths are sums over a sixteenth of a voxel.
  explicit PlaneParallelDepths(const CloudField& field);

  [[nodiscard]] double base_m() const { return base_m_; }
  [[nodiscard]] double top_m() const { return top_m_; }
  [[nodiscard]] double whole() const { return above_.back(); }
  /// Returns the optical depth above an altitude; outside of the field that of its nearer side.
  [[nodiscard]] double Above(double altitude_m) const;
  /// Returns the altitude of an optical depth in [0, whole()].
  [[nodiscard]] double AltitudeOf(double depth) const;
  [[nodiscard]] double Extinction_per_m(double altitude_m) const;

 private:
  double base_m_, top_m_;
  std::vector<double> above_;  // at even steps, from the top
};

}  // namespace alpenglow::renderer
