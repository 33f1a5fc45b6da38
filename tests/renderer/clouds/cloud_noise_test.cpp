// SPDX-License-Identifier: MIT
#include "renderer/clouds/cloud_noise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "renderer/clouds/periodic_map.h"

namespace alpenglow::renderer {
namespace {

struct Moments {
  double mean = 0.0, deviation = 0.0;
};

/// Returns the moments of noise at the centres of its texels.
Moments MomentsOf(const TilingNoise& noise) {
  double sum = 0.0, squares = 0.0;
  const int n = noise.side();
  for (int z = 0; z < n; ++z) {
    for (int y = 0; y < n; ++y) {
      for (int x = 0; x < n; ++x) {
        const double value = noise.At(glm::dvec3(x, y, z) / static_cast<double>(n));
        sum += value;
        squares += value * value;
      }
    }
  }
  const double count = std::pow(n, 3), mean = sum / count;
  return {mean, std::sqrt(squares / count - mean * mean)};
}

TEST(CloudNoise, CubesHaveMeanZeroAndDeviationOne) {
  for (const TilingNoise& noise :
       {TilingNoise::Billow(32, {4, 3, 0.55, 3}), TilingNoise::Value(32, {4, 3, 0.5, 3})}) {
    const Moments moments = MomentsOf(noise);
    EXPECT_NEAR(moments.mean, 0.0, 1e-6) << "values are floats";
    EXPECT_NEAR(moments.deviation, 1.0, 1e-6);
  }
}

TEST(CloudNoise, CubesRepeatWithoutSeam) {
  const TilingNoise noise = TilingNoise::Billow(32, {4, 3, 0.55, 3});
  for (int i = 0; i < 200; ++i) {
    const glm::dvec3 at(0.0137 * i, 0.0471 * i, 0.0293 * i);
    // Positions of 10 periods have rounding of 1e-15 of a period, and slopes are below 100.
    EXPECT_NEAR(noise.At(at), noise.At(at + glm::dvec3(3.0, -2.0, 7.0)), 1e-5);
    EXPECT_NEAR(noise.At({0.0, at.y, at.z}), noise.At({1e-9, at.y, at.z}), 1e-5);
    EXPECT_NEAR(noise.At({0.0, at.y, at.z}), noise.At({1.0 - 1e-9, at.y, at.z}), 1e-5);
  }
}

TEST(CloudNoise, ComponentsOfVectorsAreIndependentCubes) {
  const NoiseOctaves octaves{4, 3, 0.5, 3};
  const TilingVectorNoise vectors(32, octaves);
  const TilingNoise first = TilingNoise::Value(32, octaves);
  double product = 0.0, largest = 0.0;
  constexpr int kPoints = 20000;
  for (int i = 0; i < kPoints; ++i) {
    const glm::dvec3 at(0.0137 * i, 0.0471 * i, 0.00293 * i);
    const glm::dvec3 value = vectors.At(at);
    EXPECT_NEAR(value.x, first.At(at), 1e-6) << "the order of sums of floats";
    product += value.x * value.y / kPoints;
    largest = std::max({largest, value.x, value.y, value.z});
  }
  // 64 independent cells of the first octave leave a correlation of 1 / 8 by chance.
  EXPECT_LT(std::abs(product), 0.3);
  EXPECT_LE(largest, vectors.Largest() + 1e-6);
}

TEST(CloudNoise, CubesStayWithinTheirBounds) {
  const TilingNoise noise = TilingNoise::Billow(32, {4, 3, 0.55, 3});
  for (int i = 0; i < 5000; ++i) {
    const double value = noise.At({0.0137 * i, 0.0471 * i, 0.00293 * i});
    EXPECT_LE(value, noise.Largest() + 1e-6);
    EXPECT_GE(value, noise.Least() - 1e-6);
  }
}

TEST(CloudNoise, BillowsHaveRoundTopsAndSharpCreases) {
  // A sum of max(0, 1 - d^2) has no upward kink: between texels of one octave its second difference
  // is at most that of a parabola, -2 step^2, away from creases, where it is positive.
  const TilingNoise noise = TilingNoise::Billow(64, {4, 1, 0.5, 3});
  double least = 0.0, most = 0.0;
  for (int i = 0; i < 64 * 64; ++i) {
    const glm::dvec3 at = glm::dvec3(i % 64, i / 64, 11) / 64.0, step(1.0 / 64, 0.0, 0.0);
    const double second = noise.At(at + step) - 2.0 * noise.At(at) + noise.At(at - step);
    least = std::min(least, second);
    most = std::max(most, second);
  }
  EXPECT_GT(most, 3.0 * -least) << "creases are sharper than tops";
}

TEST(CloudNoise, ValueNoiseRepeatsOnTheGroundOnly) {
  for (int i = 0; i < 100; ++i) {
    const glm::dvec3 at(0.37 * i, 0.81 * i, 0.53 * i);
    const double here = ValueNoise(at, 6, 5U);
    EXPECT_NEAR(here, ValueNoise(at + glm::dvec3(6.0, -12.0, 0.0), 6, 5U), 1e-12) << "rounding";
    EXPECT_LE(std::abs(here), 1.0);
  }
  EXPECT_NE(ValueNoise({0.5, 0.5, 0.5}, 6, 5U), ValueNoise({0.5, 0.5, 6.5}, 6, 5U));
}

TEST(CloudNoise, ValueNoiseHasItsStandardDeviation) {
  // Values of variance 1/3 are blended with weights f and 1 - f along three axes. The mean of
  // f^2 + (1 - f)^2 over Perlin's fade is 362/462, so the variance is (362/462)^3 / 3.
  double sum = 0.0, squares = 0.0;
  constexpr int kCount = 200000;
  for (int i = 0; i < kCount; ++i) {
    const double value = ValueNoise({0.618034 * i, 0.754878 * i, 0.56984 * i}, 1000, 5U);
    sum += value;
    squares += value * value;
  }
  const double mean = sum / kCount;
  // About 1e5 independent values: standard errors of 0.0013 and 0.001.
  EXPECT_NEAR(mean, 0.0, 0.006);
  EXPECT_NEAR(std::sqrt(squares / kCount - mean * mean),
              std::sqrt(std::pow(362.0 / 462.0, 3) / 3.0), 0.005);
}

TEST(CloudNoise, CellDistancesRepeatAndAreOrdered) {
  for (int i = 0; i < 300; ++i) {
    const glm::dvec2 at(0.37 * i, 0.213 * i);
    const CellDistances here = DistancesInCells(at, 0.3, 8, 2U);
    const CellDistances there = DistancesInCells(at + glm::dvec2(-8.0, 16.0), 0.3, 8, 2U);
    EXPECT_NEAR(here.nearest, there.nearest, 1e-9) << "rounding";
    EXPECT_NEAR(here.second, there.second, 1e-9);
    EXPECT_LE(here.nearest, here.second);
  }
}

TEST(CloudNoise, CellsChangeSmoothlyWithTime) {
  for (int i = 0; i < 300; ++i) {
    const glm::dvec2 at(0.37 * i, 0.213 * i);
    // A point crosses less than a cell per unit of time, at most 1.875 times as fast in between.
    EXPECT_NEAR(DistancesInCells(at, 0.999, 8, 2U).nearest,
                DistancesInCells(at, 1.001, 8, 2U).nearest, 0.002 * 2.7);
  }
}

TEST(PeriodicMap, InterpolatesAndRepeats) {
  const PeriodicMap map(8, 80.0, [](const glm::dvec2& at) { return at.x + 2.0 * at.y; });
  EXPECT_DOUBLE_EQ(map.At({15.0, 25.0}), 65.0) << "linear between samples";
  EXPECT_DOUBLE_EQ(map.At({15.0 + 80.0, 25.0 - 160.0}), 65.0);
  EXPECT_DOUBLE_EQ(map.At({75.0, 0.0}), 35.0) << "halfway from 70 to 0";
}

TEST(PeriodicMap, BoundOfABoxHoldsInIt) {
  const GroundNoise noise{40.0, 3, 0.5, 100.0, 4};
  const PeriodicMap map(32, 160.0, [&](const glm::dvec2& at) { return noise.At(at, 7.0, 160.0); });
  const double largest = map.LargestIn({33.0, 150.0}, {57.0, 171.0});
  for (int i = 0; i < 1000; ++i) {
    const glm::dvec2 at(33.0 + 24.0 * (i % 32) / 31.0, 150.0 + 21.0 * (i / 32) / 31.0);
    EXPECT_LE(map.At(at), largest);
  }
  EXPECT_LE(largest, map.Quantile(1.0));
  EXPECT_LE(map.Quantile(0.2), map.Quantile(0.8));
}

}  // namespace
}  // namespace alpenglow::renderer
