// SPDX-License-Identifier: MIT
#include "renderer/layers/dense_matrix.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "atmosphere/base/error.h"

namespace alpenglow::renderer {

DenseMatrix DenseMatrix::Identity(std::size_t size) {
  DenseMatrix one(size);
  for (std::size_t i = 0; i < size; ++i) one(i, i) = 1.0;
  return one;
}

DenseMatrix DenseMatrix::Transposed() const {
  DenseMatrix result(size_);
  for (std::size_t i = 0; i < size_; ++i) {
    for (std::size_t j = 0; j < size_; ++j) result(j, i) = (*this)(i, j);
  }
  return result;
}

DenseMatrix DenseMatrix::WithColumnsTimes(const std::vector<double>& factors) const {
  DenseMatrix result = *this;
  for (std::size_t i = 0; i < size_; ++i) {
    for (std::size_t j = 0; j < size_; ++j) result(i, j) *= factors[j];
  }
  return result;
}

std::vector<double> DenseMatrix::TransposedTimes(const std::vector<double>& vector) const {
  std::vector<double> result(size_, 0.0);
  for (std::size_t i = 0; i < size_; ++i) {
    for (std::size_t j = 0; j < size_; ++j) result[j] += (*this)(i, j) * vector[i];
  }
  return result;
}

DenseMatrix operator*(const DenseMatrix& a, const DenseMatrix& b) {
  DenseMatrix result(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t k = 0; k < a.size(); ++k) {
      for (std::size_t j = 0; j < a.size(); ++j) result(i, j) += a(i, k) * b(k, j);
    }
  }
  return result;
}

std::vector<double> operator*(const DenseMatrix& a, const std::vector<double>& vector) {
  std::vector<double> result(a.size(), 0.0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < a.size(); ++j) result[i] += a(i, j) * vector[j];
  }
  return result;
}

DenseMatrix operator+(DenseMatrix a, const DenseMatrix& b) {
  for (std::size_t i = 0; i < a.value_.size(); ++i) a.value_[i] += b.value_[i];
  return a;
}

DenseMatrix operator-(DenseMatrix a, const DenseMatrix& b) {
  for (std::size_t i = 0; i < a.value_.size(); ++i) a.value_[i] -= b.value_[i];
  return a;
}

std::optional<DenseMatrix> CholeskyFactor(const DenseMatrix& matrix) {
  const std::size_t n = matrix.size();
  DenseMatrix lower(n);
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t i = j; i < n; ++i) {
      double rest = matrix(i, j);
      for (std::size_t k = 0; k < j; ++k) rest -= lower(i, k) * lower(j, k);
      if (i > j) {
        lower(i, j) = rest / lower(j, j);
      } else if (rest > 0.0) {
        lower(j, j) = std::sqrt(rest);
      } else {
        return std::nullopt;
      }
    }
  }
  return lower;
}

DenseMatrix InverseOf(DenseMatrix matrix) {
  const std::size_t n = matrix.size();
  DenseMatrix inverse = DenseMatrix::Identity(n);
  for (std::size_t j = 0; j < n; ++j) {
    std::size_t pivot = j;
    for (std::size_t i = j + 1; i < n; ++i) {
      if (std::abs(matrix(i, j)) > std::abs(matrix(pivot, j))) pivot = i;
    }
    ALPENGLOW_ENSURE(std::abs(matrix(pivot, j)), >, 0.0);
    for (std::size_t k = 0; k < n; ++k) {
      std::swap(matrix(j, k), matrix(pivot, k));
      std::swap(inverse(j, k), inverse(pivot, k));
    }
    const double scale = 1.0 / matrix(j, j);
    for (std::size_t k = 0; k < n; ++k) {
      matrix(j, k) *= scale;
      inverse(j, k) *= scale;
    }
    for (std::size_t i = 0; i < n; ++i) {
      const double factor = matrix(i, j);
      if (i == j || factor == 0.0) continue;
      for (std::size_t k = 0; k < n; ++k) {
        matrix(i, k) -= factor * matrix(j, k);
        inverse(i, k) -= factor * inverse(j, k);
      }
    }
  }
  return inverse;
}

namespace {

/// A rotation in the plane of two coordinates.
struct JacobiRotation {
  double cosine, sine;
};

/// Returns the rotation by at most 45 degrees that removes the element `off` between two diagonal
/// elements.
JacobiRotation RotationFor(double first, double second, double off) {
  const double theta = (second - first) / (2.0 * off);
  const double tangent =
      std::copysign(1.0, theta) / (std::abs(theta) + std::sqrt(1.0 + theta * theta));
  const double cosine = 1.0 / std::sqrt(1.0 + tangent * tangent);
  return {cosine, tangent * cosine};
}

void RotateColumns(DenseMatrix& matrix, std::size_t p, std::size_t q, JacobiRotation by) {
  for (std::size_t i = 0; i < matrix.size(); ++i) {
    const double a = matrix(i, p), b = matrix(i, q);
    matrix(i, p) = by.cosine * a - by.sine * b;
    matrix(i, q) = by.sine * a + by.cosine * b;
  }
}

void RotateRows(DenseMatrix& matrix, std::size_t p, std::size_t q, JacobiRotation by) {
  for (std::size_t i = 0; i < matrix.size(); ++i) {
    const double a = matrix(p, i), b = matrix(q, i);
    matrix(p, i) = by.cosine * a - by.sine * b;
    matrix(q, i) = by.sine * a + by.cosine * b;
  }
}

}  // namespace

SymmetricEigen EigenOfSymmetric(DenseMatrix matrix) {
  const std::size_t n = matrix.size();
  DenseMatrix vectors = DenseMatrix::Identity(n);
  // An element counts as removed when it is small relative to both of its diagonal elements, which
  // keeps small eigenvalues accurate, or negligible in the whole. Convergence is quadratic; ten
  // sweeps are usual.
  constexpr int kMostSweeps = 60;
  constexpr double kRemoved = 1e-17, kNegligible = 1e-22;
  double whole = 0.0;
  for (std::size_t i = 0; i < n; ++i) whole += std::abs(matrix(i, i));
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    bool is_done = true;
    for (std::size_t p = 0; p < n; ++p) {
      for (std::size_t q = p + 1; q < n; ++q) {
        const double off = matrix(p, q);
        const double size = std::sqrt(std::abs(matrix(p, p) * matrix(q, q)));
        if (std::abs(off) <= kRemoved * size + kNegligible * whole) continue;
        is_done = false;
        const JacobiRotation by = RotationFor(matrix(p, p), matrix(q, q), off);
        RotateColumns(matrix, p, q, by);
        RotateRows(matrix, p, q, by);
        matrix(p, q) = matrix(q, p) = 0.0;
        RotateColumns(vectors, p, q, by);
      }
    }
    if (is_done) break;
  }
  SymmetricEigen eigen{std::vector<double>(n), std::move(vectors)};
  for (std::size_t i = 0; i < n; ++i) eigen.value[i] = matrix(i, i);
  return eigen;
}

}  // namespace alpenglow::renderer
