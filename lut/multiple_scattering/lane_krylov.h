// SPDX-License-Identifier: MIT
// This header provides the solution of four linear systems at once by the method of generalised
// minimal residuals (Saad, Schultz 1986, SIAM J. Sci. Stat. Comput. 7, 856).
//
// Every vector holds the four systems interleaved: entry i of system k at [4 i + k]. The caller
// applies the matrices, which need not be known otherwise, to one vector after the other.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "lut/layer.h"
#include "lut/multiple_scattering/moment_kernel.h"

namespace alpenglow::lut {

using LaneNumbers = std::array<double, kBlockBands>;

/// Returns the square roots of the sums of squares.
[[nodiscard]] LaneNumbers Norms(const AlignedFloats& vector);

/// The search for the solutions. It adds one vector to each subspace at a time.
class LaneKrylov {
 public:
  /// Begins with the vectors of zeros as solutions.
  explicit LaneKrylov(AlignedFloats right_side);

  /// Returns the vectors to which the caller applies the matrices next. They have norm 1, or are 0
  /// where a system is solved.
  [[nodiscard]] const AlignedFloats& Newest() const { return basis_.back(); }
  /// Takes the products of the matrices and Newest().
  void Extend(AlignedFloats product);

  /// Returns the vectors with the smallest residuals among the sums of all Newest() so far.
  [[nodiscard]] AlignedFloats Solution() const;

 private:
  struct Rotation {
    LaneNumbers cosine, sine;
  };
  void Rotate(std::vector<LaneNumbers>& column);

  std::vector<AlignedFloats> basis_;
  std::vector<std::vector<LaneNumbers>> triangle_;  // [column][row]
  std::vector<Rotation> rotations_;
  std::vector<LaneNumbers> projected_;  // the right sides, rotated
};

}  // namespace alpenglow::lut
