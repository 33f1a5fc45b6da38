// SPDX-License-Identifier: MIT
// Random numbers of the path tracer: a function of (seed, batch, path, how many were drawn), so
// that threads do not matter.
//
// Paths of a batch are the points of a Korobov lattice moved by a random shift (Cranley and
// Patterson 1976, SIAM J. Numer. Anal. 13, 904), which spreads the first dimensions evenly; batches
// are independent, and their scatter is the standard error. Later dimensions are independent
// numbers of the generator SplitMix64 (Steele, Lea, Flood 2014, OOPSLA, 453).
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace alpenglow::atmosphere::judge {

inline constexpr std::size_t kPathsPerBatch = 251;

class PathRandom {
 public:
  PathRandom(std::uint64_t seed, std::uint64_t batch, std::uint64_t path)
      : batch_key_(Mixed(Mixed(seed + kStep) ^ (batch * kStep))),
        state_(Mixed(batch_key_ ^ (path + 1) * 0xD1B54A32D192ED03U)),
        path_(path) {}

  /// Uniform in [0, 1).
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

}  // namespace alpenglow::atmosphere::judge
