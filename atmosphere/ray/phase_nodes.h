// SPDX-License-Identifier: MIT
// The aerosol's tabulated phase functions, made ready to be read for all bands at once: the nodes of
// PhaseTable, as many values a node as there are bands. A look-up finds its place among them once,
// in float.
#pragma once

#include <cstddef>
#include <vector>

#include "atmosphere/air/medium.h"
#include "atmosphere/ray/ray_samples.h"

namespace alpenglow::atmosphere {

class PhaseNodes {
 public:
  PhaseNodes() = default;
  /// @param medium  its phase functions are tables.
  explicit PhaseNodes(const Medium& medium);

  [[nodiscard]] bool empty() const { return value_.empty(); }

  /// Values [1/sr] of every band, within 3e-5 of the tables'. @param nu  in [-1, 1]; values beyond by
  /// rounding are clamped.
  [[nodiscard]] Bands<float> At(double nu) const;

 private:
  std::size_t bands_ = 0;
  std::vector<float> value_;  // [node * bands + band]
};

}  // namespace alpenglow::atmosphere
