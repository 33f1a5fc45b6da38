// SPDX-License-Identifier: MIT
#include "renderer/cloud_light/cloud_krylov.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "atmosphere/math/numerics.h"
#include "tests/fixtures/thread_counts.h"

namespace alpenglow::renderer {
namespace {

using Vector = std::vector<CloudHarmonics>;

constexpr std::size_t kCells = 5000;

/// Returns a vector of numbers in [-1, 1).
Vector Numbers(int base) {
  Vector vector(kCells);
  int i = 0;
  for (CloudHarmonics& cell : vector) {
    for (float& value : cell) value = static_cast<float>(2.0 * Halton(++i, base) - 1.0);
  }
  return vector;
}

/// Returns a matrix without symmetry times a vector: every value mixes with those of neighbours.
Vector Mixing(const Vector& in) {
  Vector out(in.size());
  for (std::size_t cell = 0; cell < in.size(); ++cell) {
    const CloudHarmonics& next = in[(cell + 1) % in.size()];
    const CloudHarmonics& before = in[(cell + in.size() - 7) % in.size()];
    for (std::size_t k = 0; k < kCloudMoments; ++k) {
      out[cell][k] = 0.6F * next[k] + 0.35F * before[(k + 3) % kCloudMoments];
    }
  }
  return out;
}

double Norm(const Vector& vector) {
  double sum = 0.0;
  for (const CloudHarmonics& cell : vector) {
    for (const float value : cell) sum += static_cast<double>(value) * static_cast<double>(value);
  }
  return std::sqrt(sum);
}

/// Returns |b + K m - m| / |b|.
double Residual(const Vector& right_side, const Vector& moments) {
  Vector rest = Mixing(moments);
  for (std::size_t cell = 0; cell < rest.size(); ++cell) {
    for (std::size_t k = 0; k < kCloudMoments; ++k) {
      rest[cell][k] += right_side[cell][k] - moments[cell][k];
    }
  }
  return Norm(rest) / Norm(right_side);
}

TEST(CloudKrylov, ResidualIsBelowTheTolerance) {
  const Vector right_side = Numbers(3);
  for (const Vector& start : {Vector(kCells), Numbers(5)}) {
    const KrylovSolution found = SolveByKrylov(right_side, start, 1e-4, 200, Mixing);
    EXPECT_LT(found.residual, 1e-4);
    // Rounding of floats adds a few of their 6e-8 to every step.
    EXPECT_NEAR(Residual(right_side, found.moments), found.residual, 1e-5);
  }
}

TEST(CloudKrylov, StopsAfterTheGivenNumberOfSteps) {
  const Vector right_side = Numbers(3);
  const KrylovSolution found = SolveByKrylov(right_side, Vector(kCells), 1e-6, 4, Mixing);
  EXPECT_EQ(found.applications, 4);
  EXPECT_NEAR(Residual(right_side, found.moments), found.residual, 1e-5);
  EXPECT_GT(found.residual, 1e-6);
}

TEST(CloudKrylov, ExactStartIsReturned) {
  const Vector right_side = Numbers(3);
  const KrylovSolution found = SolveByKrylov(right_side, Vector(kCells), 1e-4, 200, Mixing);
  const KrylovSolution again = SolveByKrylov(right_side, found.moments, 1.1e-4, 200, Mixing);
  EXPECT_EQ(again.applications, 1);
  EXPECT_EQ(again.moments, found.moments);
}

TEST(CloudKrylov, IsZeroWithoutSource) {
  const KrylovSolution found = SolveByKrylov(Vector(kCells), Numbers(2), 1e-4, 200, Mixing);
  EXPECT_EQ(found.moments, Vector(kCells));
  EXPECT_EQ(found.residual, 0.0);
}

TEST(CloudKrylov, IsTheSameForAnyNumberOfThreads) {
  const Vector right_side = Numbers(3);
  tests::EqualForAnyNumberOfThreads(
      [&] { return SolveByKrylov(right_side, Vector(kCells), 1e-3, 200, Mixing).moments; });
}

}  // namespace
}  // namespace alpenglow::renderer
