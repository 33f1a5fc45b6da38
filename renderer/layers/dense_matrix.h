// SPDX-License-Identifier: MIT
// Small dense square matrices: products, Cholesky's factor, inverses, and the eigenvalues and
// eigenvectors of symmetric matrices by cyclic Jacobi rotations (Jacobi 1846, J. reine angew. Math.
// 30, 51; rotations as in Rutishauser 1966, Numer. Math. 9, 1).
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "renderer/layer.h"

namespace alpenglow::renderer {

/// A square matrix, row-major.
class DenseMatrix {
 public:
  /// Makes a matrix of zeros.
  explicit DenseMatrix(std::size_t size = 0) : size_(size), value_(size * size, 0.0) {}
  [[nodiscard]] static DenseMatrix Identity(std::size_t size);

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] double& operator()(std::size_t row, std::size_t column) {
    return value_[row * size_ + column];
  }
  [[nodiscard]] double operator()(std::size_t row, std::size_t column) const {
    return value_[row * size_ + column];
  }

  [[nodiscard]] DenseMatrix Transposed() const;
  /// Returns the matrix with its columns scaled by the factors.
  [[nodiscard]] DenseMatrix WithColumnsTimes(const std::vector<double>& factors) const;
  /// Returns the transposed matrix times a vector.
  [[nodiscard]] std::vector<double> TransposedTimes(const std::vector<double>& vector) const;

  friend DenseMatrix operator*(const DenseMatrix& a, const DenseMatrix& b);
  friend std::vector<double> operator*(const DenseMatrix& a, const std::vector<double>& vector);
  friend DenseMatrix operator+(DenseMatrix a, const DenseMatrix& b);
  friend DenseMatrix operator-(DenseMatrix a, const DenseMatrix& b);

 private:
  std::size_t size_;
  std::vector<double> value_;
};

/// Returns the lower triangular L with L L^T = matrix; nothing if the matrix is not positive
/// definite.
/// @param matrix  symmetric.
[[nodiscard]] std::optional<DenseMatrix> CholeskyFactor(const DenseMatrix& matrix);

/// Returns the inverse, by elimination with row pivots. Throws InternalError for a singular matrix.
[[nodiscard]] DenseMatrix InverseOf(DenseMatrix matrix);

/// Eigenvalues, and orthonormal eigenvectors as columns.
struct SymmetricEigen {
  std::vector<double> value;
  DenseMatrix vector;
};
/// Returns the eigenvalues and eigenvectors; the residual of A v = x v is below 1e-13 of the largest
/// eigenvalue for sizes up to 32.
/// @param matrix  symmetric.
[[nodiscard]] SymmetricEigen EigenOfSymmetric(DenseMatrix matrix);

}  // namespace alpenglow::renderer
