// SPDX-License-Identifier: MIT
// Small dense systems of linear equations.
#pragma once

#include <vector>

namespace alpenglow::atmosphere {

/// Solves a symmetric positive definite system by Cholesky's factorisation. Throws InternalError
/// when a pivot is not positive.
/// @param matrix  n x n, row-major; the lower triangle is read. n = right_side.size().
[[nodiscard]] std::vector<double> SolvePositiveDefinite(std::vector<double> matrix,
                                                        std::vector<double> right_side);

}  // namespace alpenglow::atmosphere
