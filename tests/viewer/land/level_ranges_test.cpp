// SPDX-License-Identifier: MIT
#include "renderer/terrain/level_ranges.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "tests/renderer/terrain/land_files.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {
namespace {

using namespace tests;

class LevelRanges : public LandFolder {
 protected:
  void SetUp() override {
    LandFolder::SetUp();
    WriteTiles(3);
    tiles_.emplace(LandSource{{folder_}, VoidPolicy::kFill, std::nullopt});
    tree_.emplace(*tiles_);
  }
  [[nodiscard]] LandEye EyeAt(double column, double row, double above_m) const {
    return {{column, row}, SampleSizeAt(tiles_->lattice(), 0.81), above_m, 1e6};
  }
  [[nodiscard]] static bool All(const ChunkKey&) { return true; }

  std::optional<LandTiles> tiles_;
  std::optional<ChunkTree> tree_;
};

// d of a sample, as level_ranges.h has it.
double DistanceOf(const LandEye& eye, double column, double row) {
  return std::hypot((column - eye.at.column) * eye.size.column_m,
                    (row - eye.at.row) * eye.size.row_m, eye.above_m);
}

// Samples of all corners that a chunk's cells have.
double Side(const ChunkKey& key) { return kChunkCells * std::exp2(key.level); }

struct Case {
  LandEye eye;
  std::vector<LevelRange> ranges;
  std::vector<DrawnChunk> drawn;
};

// Eyes low and high, with everything there and with levels that do not reach out yet.
std::vector<Case> Cases(const LandTiles& tiles, const ChunkTree& tree) {
  std::vector<Case> cases;
  const SampleSize size = SampleSizeAt(tiles.lattice(), 0.81);
  for (int i = 0; i < 60; ++i) {
    const double column = 900.0 * std::fmod(0.7549 * i, 1.0) - 90.0;
    const double row = 900.0 * std::fmod(0.5698 * i, 1.0) - 90.0;
    const LandEye eye{
        {column, row}, size, i % 3 == 0 ? 4000.0 * std::fmod(0.61 * i, 1.0) : 0.0, 1e6};
    LandDemand demand =
        DemandOf(tree, eye, i % 2 == 0 ? 96.0 : 64.0, [](const ChunkKey&) { return true; });
    if (i % 4 == 1) {
      for (std::size_t level = 0; level + 1 < demand.reach_m.size(); ++level)
        demand.reach_m[level] *= std::fmod(0.37 * (i + 3.0 * static_cast<double>(level)), 1.0);
    }
    Case made{eye, RangesOf(demand.reach_m, eye), {}};
    made.drawn = DrawnChunks(tree, eye, made.ranges, [](const ChunkKey&) { return true; });
    cases.push_back(made);
  }
  return cases;
}

TEST_F(LevelRanges, ChunksCoverAllLandOnce) {
  for (const Case& each : Cases(*tiles_, *tree_)) {
    double area = 0.0;
    for (const DrawnChunk& chunk : each.drawn) {
      const double side = Side(chunk.key);
      const double wide = std::min((chunk.key.column + 1) * side, 720.0) - chunk.key.column * side;
      const double high = std::min((chunk.key.row + 1) * side, 720.0) - chunk.key.row * side;
      area += wide * high;
    }
    EXPECT_DOUBLE_EQ(area, 720.0 * 720.0) << "a quadtree's leaves do not overlap";
  }
}

// What keeps levels together, asked at each border of two chunks.
TEST_F(LevelRanges, WhereTwoLevelsMeetTheFinerHasTurnedAndTheCoarserHasNotBegun) {
  int borders = 0;
  for (const Case& each : Cases(*tiles_, *tree_)) {
    std::set<ChunkKey> drawn;
    for (const DrawnChunk& chunk : each.drawn) drawn.insert(chunk.key);
    for (const DrawnChunk& chunk : each.drawn) {
      const auto& [level, column, row] = chunk.key;
      struct Next {
        int columns, rows;
        unsigned bit;
      };
      for (const auto& [columns, rows, bit] :
           {Next{0, -1, kNorthSide}, {1, 0, kEastSide}, {0, 1, kSouthSide}, {-1, 0, kWestSide}}) {
        const ChunkKey beside{level, column + columns, row + rows};
        if (!tree_->Exists(beside) || drawn.contains(beside)) {
          EXPECT_EQ(chunk.coarse_sides & bit, 0U);
          continue;
        }
        if (!drawn.contains(beside.Parent())) {
          EXPECT_EQ(chunk.coarse_sides & bit, 0U) << "finer ones lie there";
          bool finer = false;
          for (const ChunkKey& child : tree_->Children(beside)) finer |= drawn.contains(child);
          EXPECT_TRUE(finer) << "levels that meet differ by one";
          continue;
        }
        ++borders;
        EXPECT_EQ(chunk.coarse_sides & bit, bit);
        const double side = Side(chunk.key);
        for (int k = 0; k <= kChunkCells; ++k) {
          const double along = k * std::exp2(level);
          const double at_column = column * side + (columns == 1    ? side
                                                    : columns == -1 ? 0
                                                                    : along);
          const double at_row = row * side + (rows == 1 ? side : rows == -1 ? 0.0 : along);
          const double d = DistanceOf(each.eye, at_column, at_row);
          const auto fine = static_cast<std::size_t>(level);
          EXPECT_GE(d, each.ranges[fine].end_m) << "the finer side is the coarser surface";
          if (level + 1 < tree_->top()) {
            EXPECT_LE(d, each.ranges[fine + 1].start_m) << "which is still its own";
          }
        }
      }
    }
  }
  EXPECT_GT(borders, 500) << "there was something to test";
}

TEST_F(LevelRanges, ALevelTurnsOverAStretchThatIsNotShort) {
  for (const Case& each : Cases(*tiles_, *tree_)) {
    for (const LevelRange& range : each.ranges) {
      if (range.end_m > 0.0 && range.end_m < 1e29) {
        EXPECT_LE(range.start_m, 0.91 * range.end_m);
      }
    }
  }
}

TEST_F(LevelRanges, WhatIsNotThereIsNeitherDrawnNorHidesWhatIs) {
  const LandEye eye = EyeAt(360.0, 360.0, 0.0);
  const ChunkKey missing{1, 10, 11};
  const auto is_there = [&](const ChunkKey& key) { return key != missing; };
  const LandDemand demand = DemandOf(*tree_, eye, 96.0, is_there);
  EXPECT_TRUE(std::any_of(demand.wanted.begin(), demand.wanted.end(),
                          [&](const WantedChunk& wanted) { return wanted.key == missing; }));
  const auto ranges = RangesOf(demand.reach_m, eye);
  for (const DrawnChunk& chunk : DrawnChunks(*tree_, eye, ranges, is_there)) {
    EXPECT_NE(chunk.key, missing);
    EXPECT_FALSE(chunk.key.level == 0 && chunk.key.Parent() == missing);
  }
  EXPECT_LE(ranges[1].end_m, tree_->Distance(missing.Parent(), eye));
}

TEST_F(LevelRanges, NearTheEyeEverySampleIsDrawnAndFromAboveFewer) {
  const LandEye low = EyeAt(360.0, 360.0, 0.0);
  const auto near =
      DrawnChunks(*tree_, low, RangesOf(DemandOf(*tree_, low, 96.0, All).reach_m, low), All);
  EXPECT_EQ(near.front().key.level, 0);
  const LandEye high = EyeAt(360.0, 360.0, 40e3);
  const auto far =
      DrawnChunks(*tree_, high, RangesOf(DemandOf(*tree_, high, 96.0, All).reach_m, high), All);
  EXPECT_GE(far.front().key.level, 3);
  EXPECT_LT(far.size(), near.size());
}

}  // namespace
}  // namespace alpenglow::viewer
