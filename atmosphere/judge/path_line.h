// SPDX-License-Identifier: MIT
// Where the path tracer looks along a straight piece of a path: rational maps of the distance
//
//   t = begin + length y,   y = v / (1 + k (1 - v)),   v in [0, 1]
//
// each dense at one of its ends (k = length / scale), combined by the balance heuristic.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace alpenglow::atmosphere::judge {

struct DistanceMap {
  double begin_m = 0.0;
  double length_m = 0.0;
  double k = 0.0;
  bool dense_at_end = false;
  int strata = 0;

  [[nodiscard]] double Distance(double v) const {
    const double y = v / (1.0 + k * (1.0 - v));
    return begin_m + length_m * (dense_at_end ? 1.0 - y : y);
  }
  /// Expected points per metre at a distance.
  [[nodiscard]] double Density(double distance_m) const {
    const double from_begin = (distance_m - begin_m) / length_m;
    if (from_begin < 0.0 || from_begin > 1.0) return 0.0;
    const double y = dense_at_end ? 1.0 - from_begin : from_begin;
    const double fall = 1.0 + k * y;
    return strata * (1.0 + k) / (fall * fall * length_m);
  }
};

/// The maps of one piece.
class DistanceMaps {
 public:
  static constexpr std::size_t kMost = 5;

  /// Pieces without length are passed over. @param scale_m  > 0; over what distance from the dense
  /// end the points thin out.
  void Add(double begin_m, double end_m, double scale_m, bool dense_at_end, int strata) {
    const double length = end_m - begin_m;
    if (!(length > 0.0)) return;
    maps_[count_++] = {begin_m, length, length / std::max(scale_m, 1e-9 * length), dense_at_end,
                       strata};
  }
  [[nodiscard]] const DistanceMap* begin() const { return maps_.data(); }
  [[nodiscard]] const DistanceMap* end() const { return maps_.data() + count_; }

  /// Length of the line that a point at this distance stands for.
  [[nodiscard]] double Weight(double distance_m) const {
    double density = 0.0;
    for (const DistanceMap& map : *this) density += map.Density(distance_m);
    return 1.0 / density;
  }

 private:
  std::array<DistanceMap, kMost> maps_{};
  std::size_t count_ = 0;
};

}  // namespace alpenglow::atmosphere::judge
