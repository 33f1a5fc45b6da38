// SPDX-License-Identifier: MIT
#include "renderer/terrain/erosion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "renderer/terrain/lattice_noise.h"

namespace alpenglow::renderer {
namespace {

// A land of noise whose heights come in steps: many basins, and many samples of equal height.
Land Rough(int size, double height_m, double step_m, std::uint32_t seed) {
  Land land{size, 70.0, {}};
  for (int row = 0; row < size; ++row) {
    for (int column = 0; column < size; ++column) {
      const double height = height_m * LatticeUniform(column, row, seed) +
                            0.1 * height_m * FractalNoise(0.1 * column, 0.1 * row, 3, seed);
      land.height_m.push_back(static_cast<float>(step_m * std::round(height / step_m)));
    }
  }
  return land;
}

std::vector<std::size_t> NeighboursOf(const Land& land, std::size_t sample) {
  const int row = static_cast<int>(sample) / land.size;
  const int column = static_cast<int>(sample) % land.size;
  std::vector<std::size_t> neighbours;
  for (int r = std::max(row - 1, 0); r <= std::min(row + 1, land.size - 1); ++r) {
    for (int c = std::max(column - 1, 0); c <= std::min(column + 1, land.size - 1); ++c) {
      if (r != row || c != column) neighbours.push_back(land.index(r, c));
    }
  }
  return neighbours;
}

// The priority flood as Barnes, Lehman and Mulla write it, with one ordered set for its queue and
// keys as the header's order has them: heights in the steps of a float at 20 km, then samples.
struct SlowFlood {
  std::vector<std::uint32_t> order;

  explicit SlowFlood(Land& land) {
    std::set<std::pair<float, std::size_t>> queue;
    std::vector<bool> reached(land.height_m.size(), false);
    const auto reach = [&](std::size_t sample) {
      reached[sample] = true;
      queue.insert({land.height_m[sample] + 20000.0F, sample});
    };
    for (std::size_t i = 0; i < land.height_m.size(); ++i) {
      const auto size = static_cast<std::size_t>(land.size);
      if (land.IsRim(static_cast<int>(i / size), static_cast<int>(i % size))) reach(i);
    }
    while (!queue.empty()) {
      const std::size_t sample = queue.begin()->second;
      queue.erase(queue.begin());
      order.push_back(static_cast<std::uint32_t>(sample));
      for (const std::size_t next : NeighboursOf(land, sample)) {
        if (reached[next]) continue;
        land.height_m[next] = std::max(land.height_m[next], land.height_m[sample] + 1e-3F);
        reach(next);
      }
    }
  }
};

TEST(Erosion, TheFloodVisitsAndFillsAsOneQueueOfAllSamplesDoes) {
  for (const int size : {2, 3, 8, 33, 64}) {
    for (const double step_m : {1e-3, 0.5, 20.0}) {
      Land slow = Rough(size, 90.0, step_m, 3);
      Land fast = slow;
      const SlowFlood flood(slow);
      const Drainage drainage = DrainAndFill(fast, ScatteredSamples(size, 4));
      EXPECT_EQ(drainage.order, flood.order) << size << " samples a side, steps of " << step_m;
      EXPECT_EQ(fast.height_m, slow.height_m) << size << " samples a side, steps of " << step_m;
    }
  }
}

TEST(Erosion, WaterFlowsTheSteepestWayToWhatTheFloodReachedBefore) {
  constexpr int kSize = 40;
  Land land = Rough(kSize, 90.0, 0.5, 5);
  const ScatteredSamples scattered(kSize, 6);
  const Drainage drainage = DrainAndFill(land, scattered);
  std::vector<std::size_t> rank(drainage.order.size());
  for (std::size_t i = 0; i < rank.size(); ++i) rank[drainage.order[i]] = i;
  for (std::size_t sample = 0; sample < rank.size(); ++sample) {
    const int row = static_cast<int>(sample) / kSize, column = static_cast<int>(sample) % kSize;
    if (land.IsRim(row, column)) {
      EXPECT_EQ(drainage.receiver[sample], sample);
      continue;
    }
    float steepest = -1.0F;
    std::size_t receiver = sample;
    for (const std::size_t next : NeighboursOf(land, sample)) {
      const int rows = static_cast<int>(next) / kSize - row;
      const int columns = static_cast<int>(next) % kSize - column;
      const float distance = *scattered.Distances(sample, rows, columns);
      const float slope = (land.height_m[sample] - land.height_m[next]) / distance;
      if (rank[next] > rank[sample] || slope <= steepest) continue;
      steepest = slope;
      receiver = next;
    }
    EXPECT_EQ(drainage.receiver[sample], receiver) << "row " << row << ", column " << column;
  }
}

TEST(Erosion, DistancesOfScatteredSamplesAreTheSameBothWaysAndAThirdOffAtMost) {
  constexpr int kSize = 12;
  const ScatteredSamples scattered(kSize, 7);
  const int middle = 5 * kSize + 5;
  for (int sample = middle; sample < middle + 3; ++sample) {
    for (int rows = -1; rows <= 1; ++rows) {
      for (int columns = -1; columns <= 1; ++columns) {
        if (rows == 0 && columns == 0) continue;
        const auto next = static_cast<std::size_t>(sample + rows * kSize + columns);
        const float there = *scattered.Distances(static_cast<std::size_t>(sample), rows, columns);
        EXPECT_EQ(there, *scattered.Distances(next, -rows, -columns));
        // Two samples, each up to a third of the spacing off along both axes.
        EXPECT_NEAR(there, std::hypot(rows, columns), 2.0 / 3.0 * std::sqrt(2.0));
      }
    }
  }
}

}  // namespace
}  // namespace alpenglow::renderer
