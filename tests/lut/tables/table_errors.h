// SPDX-License-Identifier: MIT
// Statistics of the errors of tables.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "atmosphere/math/error_statistics.h"
#include "lut/layer.h"
#include "tests/fixtures/quantile.h"

namespace alpenglow::lut {

/// Collects differences between a method and the reference solution on the same work.
class TableErrors {
 public:
  void Add(double value, double truth) {
    absolute_.push_back(std::abs(value - truth));
    truth_squares_ += truth * truth;
  }

  [[nodiscard]] double Max() const { return *std::max_element(absolute_.begin(), absolute_.end()); }
  [[nodiscard]] double Rms() const { return RmsOf(absolute_); }
  /// Returns the rms relative to the rms of the truth.
  [[nodiscard]] double RelativeRms() const {
    return Rms() / std::sqrt(truth_squares_ / static_cast<double>(absolute_.size()));
  }
  /// Returns the error that a share of all (0.5: the median) do not exceed.
  [[nodiscard]] double Quantile(double share) const {
    std::vector<double> sorted = absolute_;
    std::sort(sorted.begin(), sorted.end());
    return tests::Quantile(sorted, share);
  }

 private:
  std::vector<double> absolute_;
  double truth_squares_ = 0.0;
};

}  // namespace alpenglow::lut
