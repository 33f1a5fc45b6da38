// SPDX-License-Identifier: MIT
#include "lut/table_search/table_views.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace alpenglow::lut {
namespace {

TEST(ErrorsOfViews, OfFourErrorsAreTheFormulas) {
  const ViewErrors errors = ErrorsOfViews({0.03, 0.01, 0.01, 0.01});
  const double square = 0.0012 / 4.0, fourth = (0.81e-6 + 0.03e-6) / 4.0;
  const double standard_error = std::sqrt((fourth - square * square) / 4.0);
  EXPECT_NEAR(errors.rms, std::sqrt(square), 1e-15);
  EXPECT_NEAR(errors.rms_at_most, std::sqrt(square + 3.0 * standard_error), 1e-15);
  EXPECT_EQ(errors.percentile_99, 0.03);
}

/// The share of samples of 160 errors below whose `rms_at_most` the rms of the law lies.
template <typename Law>
double ShareUnderTheLimit(Law law, double rms) {
  constexpr int kSamples = 4000;
  std::mt19937 random(1);
  int under = 0;
  for (int sample = 0; sample < kSamples; ++sample) {
    std::vector<double> errors(160);
    for (double& error : errors) error = std::abs(law(random));
    under += rms < ErrorsOfViews(std::move(errors)).rms_at_most ? 1 : 0;
  }
  return static_cast<double>(under) / kSamples;
}

// 4000 samples tell a share of 0.97 to 0.003.
TEST(ErrorsOfViews, TheRmsOfTheLawLiesUnderItsLimitAsOftenAsStated) {
  EXPECT_NEAR(ShareUnderTheLimit(std::normal_distribution<double>(), 1.0), 0.99, 0.006);
  EXPECT_NEAR(ShareUnderTheLimit(std::exponential_distribution<double>(), std::sqrt(2.0)), 0.972,
              0.009);
}

}  // namespace
}  // namespace alpenglow::lut
