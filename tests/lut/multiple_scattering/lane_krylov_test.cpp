// SPDX-License-Identifier: MIT
#include "lut/multiple_scattering/lane_krylov.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace alpenglow::lut {
namespace {

constexpr std::size_t kRows = 12;
using Matrix = std::array<std::array<double, kRows>, kRows>;

/// Returns reproducible numbers in [-1, 1].
class Numbers {
 public:
  double Next() {
    state_ = state_ * 1664525u + 1013904223u;
    return static_cast<double>(state_) / 2147483648.0 - 1.0;
  }

 private:
  std::uint32_t state_ = 7;
};

/// Four systems whose solutions are known, of matrices without symmetry.
class LaneKrylovTest : public testing::Test {
 protected:
  LaneKrylovTest() {
    Numbers numbers;
    for (std::size_t lane = 0; lane < kBlockBands; ++lane) {
      for (std::size_t row = 0; row < kRows; ++row) {
        for (double& element : matrices_[lane][row]) element = 0.3 * numbers.Next();
        matrices_[lane][row][row] += 2.0;
      }
    }
    for (std::size_t i = 0; i < kRows * kBlockBands; ++i)
      solutions_.data()[i] = static_cast<float>(numbers.Next());
  }

  [[nodiscard]] AlignedFloats Product(const AlignedFloats& vector) const {
    AlignedFloats product(kRows * kBlockBands);
    for (std::size_t lane = 0; lane < kBlockBands; ++lane) {
      for (std::size_t row = 0; row < kRows; ++row) {
        double sum = 0.0;
        for (std::size_t column = 0; column < kRows; ++column)
          sum += matrices_[lane][row][column] *
                 static_cast<double>(vector.data()[kBlockBands * column + lane]);
        product.data()[kBlockBands * row + lane] = static_cast<float>(sum);
      }
    }
    return product;
  }
  /// Returns the norms of the residuals.
  [[nodiscard]] LaneNumbers Residuals(const AlignedFloats& found) const {
    AlignedFloats difference = Product(found);
    const AlignedFloats wanted = Product(solutions_);
    for (std::size_t i = 0; i < difference.size(); ++i) difference.data()[i] -= wanted.data()[i];
    return Norms(difference);
  }

  std::array<Matrix, kBlockBands> matrices_{};
  AlignedFloats solutions_{kRows * kBlockBands};
};

TEST_F(LaneKrylovTest, SolvesSystemsInAsManyStepsAsRows) {
  LaneKrylov krylov(Product(solutions_));
  LaneNumbers before = Norms(Product(solutions_));
  for (std::size_t step = 0; step < kRows; ++step) {
    krylov.Extend(Product(krylov.Newest()));
    const LaneNumbers now = Residuals(krylov.Solution());
    for (std::size_t lane = 0; lane < kBlockBands; ++lane)
      EXPECT_LE(now[lane], before[lane] + 1e-5) << "a larger subspace has no larger residual";
    before = now;
  }
  const AlignedFloats found = krylov.Solution();
  for (std::size_t i = 0; i < kRows * kBlockBands; ++i)
    EXPECT_NEAR(found.data()[i], solutions_.data()[i], 1e-5F) << "rounding of float";
}

TEST_F(LaneKrylovTest, SolvedAndEmptyLanesStayFinite) {
  for (std::size_t row = 0; row < kRows; ++row) {
    solutions_.data()[kBlockBands * row] = 0.0F;  // the first system has no right side
    matrices_[1][row].fill(0.0);                  // the second is solved by the first step
    matrices_[1][row][row] = 2.0;
  }
  LaneKrylov krylov(Product(solutions_));
  for (std::size_t step = 0; step < kRows; ++step) krylov.Extend(Product(krylov.Newest()));
  const AlignedFloats found = krylov.Solution();
  for (std::size_t i = 0; i < kRows * kBlockBands; ++i)
    EXPECT_NEAR(found.data()[i], solutions_.data()[i], 1e-5F) << "rounding of float";
}

}  // namespace
}  // namespace alpenglow::lut
