// SPDX-License-Identifier: MIT
#include "renderer/cloud_light/cloud_krylov.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace alpenglow::renderer {
namespace {

using MomentVector = std::vector<CloudHarmonics>;

constexpr std::size_t kBlockCells = 2048;

/// Calls visit(block, first, end) for blocks of cells, with many threads.
template <typename Visit>
void EachBlock(std::size_t cells, const Visit& visit) {
  const std::size_t blocks = (cells + kBlockCells - 1) / kBlockCells;
  tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t block) {
    visit(block, block * kBlockCells, std::min(cells, (block + 1) * kBlockCells));
  });
}

double Product(const MomentVector& a, const MomentVector& b) {
  std::vector<double> partial((a.size() + kBlockCells - 1) / kBlockCells, 0.0);
  EachBlock(a.size(), [&](std::size_t block, std::size_t first, std::size_t end) {
    double sum = 0.0;
    for (std::size_t cell = first; cell < end; ++cell) {
      // Sixteen products of floats lose less than a millionth.
      float products = 0.0F;
      for (std::size_t k = 0; k < kCloudMoments; ++k) products += a[cell][k] * b[cell][k];
      sum += static_cast<double>(products);
    }
    partial[block] = sum;
  });
  double sum = 0.0;
  for (const double each : partial) sum += each;
  return sum;
}

/// Adds factor * b to a, and multiplies the sum by `scale`.
void AddTo(MomentVector& a, double factor, const MomentVector& b, double scale = 1.0) {
  const auto times = static_cast<float>(factor * scale), scaled = static_cast<float>(scale);
  EachBlock(a.size(), [&](std::size_t, std::size_t first, std::size_t end) {
    for (std::size_t cell = first; cell < end; ++cell) {
      for (std::size_t k = 0; k < kCloudMoments; ++k) {
        a[cell][k] = scaled * a[cell][k] + times * b[cell][k];
      }
    }
  });
}

/// The least-squares problem of the basis, kept triangular by Givens rotations.
class Hessenberg {
 public:
  explicit Hessenberg(double residual) : projected_{residual} {}

  /// Takes a column of products with the basis and the norm of what is left.
  void Add(std::vector<double> column) {
    for (std::size_t i = 0; i < rotation_.size(); ++i) {
      const auto [c, s] = rotation_[i];
      const double upper = c * column[i] + s * column[i + 1];
      column[i + 1] = c * column[i + 1] - s * column[i];
      column[i] = upper;
    }
    const std::size_t last = column.size() - 1;
    const double length = std::hypot(column[last - 1], column[last]);
    const double c = column[last - 1] / length, s = column[last] / length;
    rotation_.emplace_back(c, s);
    column[last - 1] = length;
    column.pop_back();
    projected_.push_back(-s * projected_.back());
    projected_[last - 1] *= c;
    column_.push_back(std::move(column));
  }
  [[nodiscard]] double residual() const { return std::abs(projected_.back()); }
  /// Returns the factors of the basis in the solution.
  [[nodiscard]] std::vector<double> Factors() const {
    std::vector<double> factor(column_.size());
    for (std::size_t i = factor.size(); i-- > 0;) {
      double rest = projected_[i];
      for (std::size_t j = i + 1; j < factor.size(); ++j) rest -= column_[j][i] * factor[j];
      factor[i] = rest / column_[i][i];
    }
    return factor;
  }

 private:
  std::vector<std::pair<double, double>> rotation_;
  std::vector<std::vector<double>> column_;
  std::vector<double> projected_;
};

}  // namespace

KrylovSolution SolveByKrylov(const std::vector<CloudHarmonics>& right_side,
                             std::vector<CloudHarmonics> start, double tolerance, int most,
                             const std::function<MomentVector(const MomentVector&)>& apply) {
  const double size = std::sqrt(Product(right_side, right_side));
  if (size == 0.0) return {MomentVector(right_side.size()), 0, 0.0};
  MomentVector rest = apply(start);
  AddTo(rest, -1.0, start);
  AddTo(rest, 1.0, right_side);
  const double first = std::sqrt(Product(rest, rest));
  Hessenberg problem(first);
  int applications = 1;
  if (first <= tolerance * size) return {std::move(start), applications, first / size};
  std::vector<MomentVector> basis;
  AddTo(rest, 0.0, right_side, 1.0 / first);
  basis.push_back(std::move(rest));
  while (applications < most && problem.residual() > tolerance * size) {
    MomentVector next = apply(basis.back());
    ++applications;
    AddTo(next, -1.0, basis.back(), -1.0);
    std::vector<double> column;
    for (const MomentVector& each : basis) {
      column.push_back(Product(next, each));
      AddTo(next, -column.back(), each);
    }
    column.push_back(std::sqrt(Product(next, next)));
    const double norm = column.back();
    problem.Add(std::move(column));
    if (norm <= 1e-12 * size) break;
    AddTo(next, 0.0, basis.front(), 1.0 / norm);
    basis.push_back(std::move(next));
  }
  const std::vector<double> factor = problem.Factors();
  for (std::size_t i = 0; i < factor.size(); ++i) AddTo(start, factor[i], basis[i]);
  return {std::move(start), applications, problem.residual() / size};
}

}  // namespace alpenglow::renderer
