// SPDX-License-Identifier: MIT
// This header provides statistics of errors: of rays in a report, texels of a table, pixels of a
// picture. The times of frames are described by the same numbers.
#pragma once

#include <cstddef>
#include <vector>

namespace alpenglow::atmosphere {

/// Statistics of one sample. All are 0 for an empty one. Bounds named "at most" hold for all values
/// of which the sample is a random part: they add three standard errors. For 160 errors, the rms of
/// the whole lies below RmsAtMost() in 99 % of samples of a normal and 97 % of an exponential law.
class ErrorStatistics {
 public:
  ErrorStatistics() = default;
  /// @param errors  in any order; finite, or InternalError is thrown.
  /// @param noise  root mean square of the standard errors of the reference, which the errors
  ///   contain; 0 if it has none.
  explicit ErrorStatistics(std::vector<double> errors, double noise = 0.0);

  [[nodiscard]] std::size_t count() const { return ascending_.size(); }
  [[nodiscard]] double mean() const { return mean_; }
  [[nodiscard]] double Largest() const { return ascending_.empty() ? 0.0 : ascending_.back(); }

  /// Returns the root mean square without the noise. If less than half of the noise is left, half of
  /// the noise is returned as a bound, because some dozen errors do not allow a lower one.
  [[nodiscard]] double Rms() const;
  [[nodiscard]] bool RmsIsBound() const;
  [[nodiscard]] double RmsAtMost() const;

  /// Returns the quantile by nearest rank: the smallest value that is not exceeded by at least
  /// `share` of all values. @param share  in [0, 1]; 0.5: the median.
  [[nodiscard]] double Quantile(double share) const;
  [[nodiscard]] double QuantileAtMost(double share) const;

 private:
  std::vector<double> ascending_;
  double noise_ = 0.0, mean_ = 0.0, mean_square_ = 0.0, mean_fourth_ = 0.0;
};

/// Returns the root mean square; 0 without values.
[[nodiscard]] double RmsOf(const std::vector<double>& values);

}  // namespace alpenglow::atmosphere
