// SPDX-License-Identifier: MIT
// The aerosol's tabulated phase functions, made ready to be read for all bands at once: as many
// values a node as there are bands, nodes at PhaseNode of phase.glsl, linear between. A look-up
// takes two square roots where PhaseTable takes an inverse cosine and a cube root.
#pragma once

#include <cstddef>
#include <vector>

#include "atmosphere/air/medium.h"
#include "atmosphere/ray/ray_samples.h"

namespace alpenglow {

class PhaseNodes {
 public:
  /// Nodes 0.01 degrees apart at a degree from the forward direction.
  static constexpr std::size_t kNodes = 2048;

  PhaseNodes() = default;
  /// @param medium  its phase functions are tables.
  explicit PhaseNodes(const Medium& medium);

  [[nodiscard]] bool empty() const { return value_.empty(); }

  /// Values [1/sr] of every band. @param nu  in [-1, 1]; values beyond by rounding are clamped.
  [[nodiscard]] Bands<float> At(double nu) const;

 private:
  std::size_t bands_ = 0;
  std::vector<float> value_;  // [node * bands + band]
};

}  // namespace alpenglow
