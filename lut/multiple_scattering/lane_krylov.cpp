// SPDX-License-Identifier: MIT
#include "lut/multiple_scattering/lane_krylov.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "lut/multiple_scattering/four_bands.h"

namespace alpenglow::lut {
namespace {

// Number of floats that are added in single precision, and that one task changes.
constexpr std::size_t kChunk = 1024;

std::size_t Chunks(const AlignedFloats& vector) { return (vector.size() + kChunk - 1) / kChunk; }
std::size_t EndOf(const AlignedFloats& vector, std::size_t chunk) {
  return std::min((chunk + 1) * kChunk, vector.size());
}

LaneNumbers Products(const AlignedFloats& a, const AlignedFloats& b) {
  LaneNumbers sum{};
  for (std::size_t chunk = 0; chunk < Chunks(a); ++chunk) {
    Four part = {};
    for (std::size_t i = chunk * kChunk; i < EndOf(a, chunk); i += kBlockBands)
      part += LoadFour(a.data() + i) * LoadFour(b.data() + i);
    for (std::size_t lane = 0; lane < kBlockBands; ++lane)
      sum[lane] += static_cast<double>(part[static_cast<int>(lane)]);
  }
  return sum;
}

Four Floats(const LaneNumbers& numbers) {
  Four four = {};
  for (std::size_t lane = 0; lane < kBlockBands; ++lane)
    four[static_cast<int>(lane)] = static_cast<float>(numbers[lane]);
  return four;
}

// Adds factors times terms to `sum`.
void AddTerms(const std::vector<AlignedFloats>& terms, const std::vector<LaneNumbers>& factors,
              AlignedFloats& sum) {
  tbb::parallel_for(std::size_t{0}, Chunks(sum), [&](std::size_t chunk) {
    for (std::size_t term = 0; term < factors.size(); ++term) {
      const Four factor = Floats(factors[term]);
      const float* const from = terms[term].data();
      for (std::size_t i = chunk * kChunk; i < EndOf(sum, chunk); i += kBlockBands)
        StoreFour(sum.data() + i, LoadFour(sum.data() + i) + factor * LoadFour(from + i));
    }
  });
}

// Divides a vector by its norms and returns them.
LaneNumbers Normalise(AlignedFloats& vector) {
  const LaneNumbers norm = Norms(vector);
  LaneNumbers inverse{};
  for (std::size_t lane = 0; lane < kBlockBands; ++lane)
    inverse[lane] = norm[lane] > 0.0 ? 1.0 / norm[lane] : 0.0;
  const Four factor = Floats(inverse);
  for (std::size_t i = 0; i < vector.size(); i += kBlockBands)
    StoreFour(vector.data() + i, LoadFour(vector.data() + i) * factor);
  return norm;
}

}  // namespace

LaneNumbers Norms(const AlignedFloats& vector) {
  LaneNumbers norms = Products(vector, vector);
  for (double& norm : norms) norm = std::sqrt(norm);
  return norms;
}

LaneKrylov::LaneKrylov(AlignedFloats right_side) {
  projected_.push_back(Normalise(right_side));
  basis_.push_back(std::move(right_side));
}

void LaneKrylov::Extend(AlignedFloats product) {
  std::vector<LaneNumbers> column(basis_.size() + 1);
  // One pass leaves a part of the order of rounding over the part that remains; a second removes it.
  for (int pass = 0; pass < 2; ++pass) {
    std::vector<LaneNumbers> less(basis_.size());
    tbb::parallel_for(std::size_t{0}, basis_.size(), [&](std::size_t i) {
      less[i] = Products(basis_[i], product);
      for (std::size_t lane = 0; lane < kBlockBands; ++lane) {
        column[i][lane] += less[i][lane];
        less[i][lane] = -less[i][lane];
      }
    });
    AddTerms(basis_, less, product);
  }
  column.back() = Normalise(product);
  basis_.push_back(std::move(product));
  Rotate(column);
  column.pop_back();
  triangle_.push_back(std::move(column));
}

// Rotates the last element of a column of the projected matrices to 0.
void LaneKrylov::Rotate(std::vector<LaneNumbers>& column) {
  const std::size_t last = rotations_.size();
  rotations_.emplace_back();
  projected_.emplace_back();
  for (std::size_t lane = 0; lane < kBlockBands; ++lane) {
    for (std::size_t i = 0; i < last; ++i) {
      const double c = rotations_[i].cosine[lane], s = rotations_[i].sine[lane];
      const double here = column[i][lane], next = column[i + 1][lane];
      column[i][lane] = c * here + s * next;
      column[i + 1][lane] = c * next - s * here;
    }
    const double length = std::hypot(column[last][lane], column[last + 1][lane]);
    const double c = length > 0.0 ? column[last][lane] / length : 1.0;
    const double s = length > 0.0 ? column[last + 1][lane] / length : 0.0;
    rotations_[last].cosine[lane] = c;
    rotations_[last].sine[lane] = s;
    column[last][lane] = length;
    projected_[last + 1][lane] = -s * projected_[last][lane];
    projected_[last][lane] *= c;
  }
}

AlignedFloats LaneKrylov::Solution() const {
  const std::size_t n = triangle_.size();
  std::vector<LaneNumbers> factors(n);
  for (std::size_t lane = 0; lane < kBlockBands; ++lane) {
    for (std::size_t row = n; row-- > 0;) {
      double sum = projected_[row][lane];
      for (std::size_t k = row + 1; k < n; ++k) sum -= triangle_[k][row][lane] * factors[k][lane];
      factors[row][lane] = triangle_[row][row][lane] > 0.0 ? sum / triangle_[row][row][lane] : 0.0;
    }
  }
  AlignedFloats solution(basis_.front().size());
  AddTerms(basis_, factors, solution);
  return solution;
}

}  // namespace alpenglow::lut
