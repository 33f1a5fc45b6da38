// SPDX-License-Identifier: MIT
#include "atmosphere/math/error_statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

#include "atmosphere/base/error.h"

namespace alpenglow::atmosphere {
namespace {

TEST(ErrorStatistics, OfFourErrorsFollowTheFormulas) {
  const ErrorStatistics errors({0.03, 0.01, 0.01, 0.01});
  const double square = 0.0012 / 4.0, fourth = (0.81e-6 + 0.03e-6) / 4.0;
  const double standard_error = std::sqrt((fourth - square * square) / 4.0);
  EXPECT_NEAR(errors.Rms(), std::sqrt(square), 1e-15);
  EXPECT_NEAR(errors.RmsAtMost(), std::sqrt(square + 3.0 * standard_error), 1e-15);
  EXPECT_NEAR(errors.mean(), 0.015, 1e-15);
  EXPECT_EQ(errors.Quantile(0.5), 0.01);
  EXPECT_EQ(errors.Quantile(0.99), 0.03);
  EXPECT_EQ(errors.Largest(), 0.03);
  EXPECT_EQ(errors.count(), 4U);
}

TEST(ErrorStatistics, NonFiniteErrorsAreRefused) {
  EXPECT_THROW(static_cast<void>(ErrorStatistics({0.01, std::nan("")})), InternalError);
}

/// Returns the share of samples of 160 errors in which the rms of the law lies below
/// RmsAtMost().
template <typename Law>
double ShareUnderTheLimit(Law law, double rms) {
  constexpr int kSamples = 4000;
  std::mt19937 random(1);
  int under = 0;
  for (int sample = 0; sample < kSamples; ++sample) {
    std::vector<double> errors(160);
    for (double& error : errors) error = std::abs(law(random));
    under += rms < ErrorStatistics(std::move(errors)).RmsAtMost() ? 1 : 0;
  }
  return static_cast<double>(under) / kSamples;
}

// 4000 samples tell a share of 0.97 to 0.003.
TEST(ErrorStatistics, UpperLimitOfTheRmsHoldsAsOftenAsStated) {
  EXPECT_NEAR(ShareUnderTheLimit(std::normal_distribution<double>(), 1.0), 0.99, 0.006);
  EXPECT_NEAR(ShareUnderTheLimit(std::exponential_distribution<double>(), std::sqrt(2.0)), 0.972,
              0.009);
}

TEST(ErrorStatistics, QuantilesAreValuesOfTheSample) {
  std::vector<double> hundred(100);
  std::iota(hundred.rbegin(), hundred.rend(), 1.0);
  const ErrorStatistics of(hundred);
  EXPECT_EQ(of.Quantile(0.5), 50.0);
  EXPECT_EQ(of.Quantile(0.95), 95.0);
  EXPECT_EQ(of.Quantile(0.99), 99.0);
  const ErrorStatistics of_one({7.0});
  EXPECT_EQ(of_one.Quantile(0.5), 7.0);
  EXPECT_EQ(of_one.Quantile(0.99), 7.0);
  EXPECT_EQ(ErrorStatistics({1.0, 2.0, 30.0}).Quantile(0.95), 30.0) << "the worst of few";
}

TEST(ErrorStatistics, OfAnEmptySampleAreZero) {
  const ErrorStatistics none(std::vector<double>{});
  EXPECT_EQ(none.count(), 0U);
  for (const double value : {none.mean(), none.Rms(), none.RmsAtMost(), none.Largest(),
                             none.Quantile(0.5), none.QuantileAtMost(0.99)})
    EXPECT_EQ(value, 0.0);
}

}  // namespace
}  // namespace alpenglow::atmosphere
