// SPDX-License-Identifier: MIT
#include "atmosphere/number/cholesky.h"

#include <cmath>

#include "atmosphere/text/error.h"

namespace alpenglow::atmosphere {

std::vector<double> SolvePositiveDefinite(std::vector<double> matrix,
                                          std::vector<double> right_side) {
  const std::size_t n = right_side.size();
  ALPENGLOW_ENSURE(matrix.size(), ==, n * n);
  std::vector<double>& l = matrix;
  std::vector<double>& x = right_side;
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t k = 0; k < j; ++k) {
      for (std::size_t i = j; i < n; ++i) l[i * n + j] -= l[i * n + k] * l[j * n + k];
    }
    ALPENGLOW_ENSURE(l[j * n + j], >, 0.0);
    const double pivot = std::sqrt(l[j * n + j]);
    for (std::size_t i = j; i < n; ++i) l[i * n + j] /= pivot;
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < i; ++k) x[i] -= l[i * n + k] * x[k];
    x[i] /= l[i * n + i];
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; ++k) x[i] -= l[k * n + i] * x[k];
    x[i] /= l[i * n + i];
  }
  return x;
}

}  // namespace alpenglow::atmosphere
