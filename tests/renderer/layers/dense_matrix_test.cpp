// SPDX-License-Identifier: MIT
#include "renderer/layers/dense_matrix.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace alpenglow::renderer {
namespace {

DenseMatrix RandomMatrix(std::size_t size) {
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  DenseMatrix matrix(size);
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j < size; ++j) matrix(i, j) = number(engine);
  }
  return matrix;
}

/// Returns a symmetric matrix with eigenvalues >= 0.
DenseMatrix RandomSquare(std::size_t size) {
  const DenseMatrix root = RandomMatrix(size);
  return root * root.Transposed();
}

double LargestDifference(const DenseMatrix& a, const DenseMatrix& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < a.size(); ++j) {
      largest = std::max(largest, std::abs(a(i, j) - b(i, j)));
    }
  }
  return largest;
}

TEST(DenseMatrix, TimesItsInverseIsOne) {
  for (const std::size_t size : {1U, 4U, 17U}) {
    const DenseMatrix matrix = RandomMatrix(size);
    EXPECT_LT(LargestDifference(matrix * InverseOf(matrix), DenseMatrix::Identity(size)), 1e-11)
        << "condition numbers are below 1e4";
  }
}

TEST(DenseMatrix, IsTheSquareOfItsCholeskyFactor) {
  const DenseMatrix matrix = RandomSquare(8);
  const auto factor = CholeskyFactor(matrix);
  ASSERT_TRUE(factor.has_value());
  EXPECT_LT(LargestDifference(*factor * factor->Transposed(), matrix), 1e-13);
  EXPECT_FALSE(CholeskyFactor(DenseMatrix(2) - matrix).has_value()) << "it is not positive";
}

TEST(DenseMatrix, HasOrthonormalEigenvectors) {
  for (const std::size_t size : {1U, 2U, 4U, 16U, 32U}) {
    const DenseMatrix matrix = RandomSquare(size);
    const SymmetricEigen eigen = EigenOfSymmetric(matrix);
    const double largest = *std::max_element(eigen.value.begin(), eigen.value.end());
    EXPECT_LT(LargestDifference(matrix * eigen.vector, eigen.vector.WithColumnsTimes(eigen.value)),
              1e-13 * largest);
    EXPECT_LT(
        LargestDifference(eigen.vector.Transposed() * eigen.vector, DenseMatrix::Identity(size)),
        1e-13);
  }
}

TEST(DenseMatrix, KeepsASmallEigenvalueAccurate) {
  DenseMatrix matrix(2);  // eigenvalues 1e-9 and 2 + 1e-9
  matrix(0, 0) = matrix(1, 1) = 1.0 + 1e-9;
  matrix(0, 1) = matrix(1, 0) = 1.0;
  const SymmetricEigen eigen = EigenOfSymmetric(matrix);
  EXPECT_NEAR(std::min(eigen.value[0], eigen.value[1]), 1e-9, 1e-15) << "rounding of 1 + 1e-9";
}

}  // namespace
}  // namespace alpenglow::renderer
