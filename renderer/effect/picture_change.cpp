// SPDX-License-Identifier: MIT
#include "renderer/effect/picture_change.h"

#include <algorithm>
#include <cmath>

#include "atmosphere/text/error.h"

namespace alpenglow::renderer {
namespace {

double Norm(const std::array<float, 3>& rgb) {
  double sum = 0.0;
  for (const float value : rgb) sum += static_cast<double>(value) * static_cast<double>(value);
  return std::sqrt(sum);
}

// The value that a share of all values does not exceed.
double Quantile(const std::vector<double>& sorted, double share) {
  const double last = static_cast<double>(sorted.size()) - 1.0;
  const double rank = std::ceil(share * static_cast<double>(sorted.size())) - 1.0;
  return sorted[static_cast<std::size_t>(std::clamp(rank, 0.0, last))];
}

}  // namespace

double PixelChange(const std::array<float, 3>& a, const std::array<float, 3>& b,
                   double floor_cd_per_m2) {
  const std::array<float, 3> difference{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
  return Norm(difference) / std::max(0.5 * (Norm(a) + Norm(b)), floor_cd_per_m2);
}

double ChangeFloor(const Image& reference) {
  constexpr double kStepsBelowMiddleGrey = 4.0;
  const double ev100 = MeterEv100(reference, kSunDiskLuminance_cd_per_m2);
  return kMeterConstant / 100.0 * std::exp2(ev100 - kStepsBelowMiddleGrey);
}

PictureChange ChangeOf(const Image& reference, const Image& other) {
  ALPENGLOW_ENSURE(reference.rgb.size(), ==, other.rgb.size());
  const double floor = ChangeFloor(reference);
  std::vector<double> changes;
  for (std::size_t i = 0; i < reference.rgb.size(); ++i) {
    changes.push_back(PixelChange(reference.rgb[i], other.rgb[i], floor));
  }
  return ChangeEstimate::Of(std::move(changes)).seen;
}

ChangeEstimate ChangeEstimate::Of(std::vector<double> changes) {
  constexpr double kStandardErrors = 3.0;
  if (changes.empty()) return {};
  std::sort(changes.begin(), changes.end());
  const auto count = static_cast<double>(changes.size());
  double squares = 0.0, fourths = 0.0;
  for (const double d : changes) {
    squares += d * d / count;
    fourths += d * d * d * d / count;
  }
  const double error = std::sqrt(std::max(fourths - squares * squares, 0.0) / count);
  const double rank_error = std::sqrt(0.99 * 0.01 / count);
  return {{std::sqrt(squares), Quantile(changes, 0.99)},
          {std::sqrt(squares + kStandardErrors * error),
           Quantile(changes, 0.99 + kStandardErrors * rank_error)}};
}

}  // namespace alpenglow::renderer
