// SPDX-License-Identifier: MIT
#include "atmosphere/math/error_statistics.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "atmosphere/base/finite.h"

namespace alpenglow::atmosphere {
namespace {

constexpr double kStandardErrors = 3.0;

}  // namespace

ErrorStatistics::ErrorStatistics(std::vector<double> errors, double noise)
    : ascending_(std::move(errors)), noise_(noise) {
  RequireFinite(ascending_, "errors");
  std::sort(ascending_.begin(), ascending_.end());
  const auto count = static_cast<double>(ascending_.size());
  for (const double error : ascending_) {
    const double square = error * error;
    mean_ += error / count;
    mean_square_ += square / count;
    mean_fourth_ += square * square / count;
  }
}

double ErrorStatistics::Rms() const {
  return RmsIsBound() ? 0.5 * noise_ : std::sqrt(mean_square_ - noise_ * noise_);
}

bool ErrorStatistics::RmsIsBound() const {
  return noise_ > 0.0 && mean_square_ < 1.25 * noise_ * noise_;
}

double ErrorStatistics::RmsAtMost() const {
  const double variance = std::max(mean_fourth_ - mean_square_ * mean_square_, 0.0);
  const double standard_error =
      ascending_.empty() ? 0.0 : std::sqrt(variance / static_cast<double>(ascending_.size()));
  return std::sqrt(mean_square_ + kStandardErrors * standard_error);
}

double ErrorStatistics::Quantile(double share) const {
  if (ascending_.empty()) return 0.0;
  const auto count = static_cast<double>(ascending_.size());
  const double rank = std::clamp(std::ceil(share * count) - 1.0, 0.0, count - 1.0);
  return ascending_[static_cast<std::size_t>(rank)];
}

double ErrorStatistics::QuantileAtMost(double share) const {
  if (ascending_.empty()) return 0.0;
  const double rank_error =
      std::sqrt(share * (1.0 - share) / static_cast<double>(ascending_.size()));
  return Quantile(share + kStandardErrors * rank_error);
}

double RmsOf(const std::vector<double>& values) { return ErrorStatistics(values).Rms(); }

}  // namespace alpenglow::atmosphere
