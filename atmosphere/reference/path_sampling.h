// SPDX-License-Identifier: MIT
// Sampling for the path tracer: random numbers, and distances along segments of a path.
//
// A random number is a function of (seed, batch, path, number of earlier draws), so that results do
// not depend on threads. The paths of a batch are the points of a Korobov lattice with a random
// shift (Cranley and Patterson 1976, SIAM J. Numer. Anal. 13, 904), which distributes the first
// dimensions evenly. Batches are independent, and their scatter is the standard error. Later
// dimensions are independent numbers of the generator SplitMix64 (Steele, Lea, Flood 2014, OOPSLA,
// 453).
//
// Distances along a straight segment of a path are sampled with rational maps
//
//   t = begin + length y,   y = v / (1 + k (1 - v)),   v in [0, 1]
//
// Each map is dense at one of its ends (k = length / scale); the maps are combined by the balance
// heuristic.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace alpenglow::atmosphere::reference {

inline constexpr std::size_t kPathsPerBatch = 251;

class PathRandom {
 public:
  PathRandom(std::uint64_t seed, std::uint64_t batch, std::uint64_t path)
      : batch_key_(Mixed(Mixed(seed + kStep) ^ (batch * kStep))),
        state_(Mixed(batch_key_ ^ (path + 1) * 0xD1B54A32D192ED03U)),
        path_(path) {}

  /// Returns a number that is uniform in [0, 1).
  double Next() {
    state_ += kStep;
    const double independent = Fraction(Mixed(state_));
    if (drawn_ >= kLatticeDimensions) return independent;
    const double shift = Fraction(Mixed(batch_key_ + ++drawn_ * kStep));
    const double point = static_cast<double>(path_ * generator_ % kPathsPerBatch) /
                         static_cast<double>(kPathsPerBatch);
    generator_ = generator_ * kGenerator % kPathsPerBatch;
    return point + shift < 1.0 ? point + shift : point + shift - 1.0;
  }

 private:
  static constexpr std::uint64_t kStep = 0x9E3779B97F4A7C15U;
  static constexpr std::uint64_t kGenerator = 33;
  static constexpr std::uint64_t kLatticeDimensions = 12;

  static std::uint64_t Mixed(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31);
  }
  static double Fraction(std::uint64_t z) { return static_cast<double>(z >> 11) * 0x1p-53; }

  std::uint64_t batch_key_;
  std::uint64_t state_;
  std::uint64_t path_;
  std::uint64_t generator_ = 1;
  std::uint64_t drawn_ = 0;
};

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
  /// Returns the expected number of points per metre at a distance.
  [[nodiscard]] double Density(double distance_m) const {
    const double from_begin = (distance_m - begin_m) / length_m;
    if (from_begin < 0.0 || from_begin > 1.0) return 0.0;
    const double y = dense_at_end ? 1.0 - from_begin : from_begin;
    const double fall = 1.0 + k * y;
    return strata * (1.0 + k) / (fall * fall * length_m);
  }
};

/// The maps of one segment.
class DistanceMaps {
 public:
  static constexpr std::size_t kMost = 5;

  /// Adds a map; segments without length are ignored.
  /// @param scale_m  > 0; distance from the dense end over which the density of points decreases.
  void Add(double begin_m, double end_m, double scale_m, bool dense_at_end, int strata) {
    const double length = end_m - begin_m;
    if (!(length > 0.0)) return;
    maps_[count_++] = {begin_m, length, length / std::max(scale_m, 1e-9 * length), dense_at_end,
                       strata};
  }
  [[nodiscard]] const DistanceMap* begin() const { return maps_.data(); }
  [[nodiscard]] const DistanceMap* end() const { return maps_.data() + count_; }

  /// Returns the length of line that a point at this distance represents.
  [[nodiscard]] double Weight(double distance_m) const {
    double density = 0.0;
    for (const DistanceMap& map : *this) density += map.Density(distance_m);
    return 1.0 / density;
  }

 private:
  std::array<DistanceMap, kMost> maps_{};
  std::size_t count_ = 0;
};

}  // namespace alpenglow::atmosphere::reference
