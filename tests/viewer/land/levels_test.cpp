// SPDX-License-Identifier: MIT
// Levels of detail of the land: what is drawn, what turns, what is hidden.
#include "renderer/terrain/level_ranges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <map>
#include <set>

#include "renderer/terrain/seen_chunks.h"
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
    return {tiles_->lattice(), PlaceOfSample(column, row, 0.0), above_m, 1e6};
  }
  [[nodiscard]] static bool All(const ChunkKey&) { return true; }

  std::optional<LandTiles> tiles_;
  std::optional<ChunkTree> tree_;
};

// d of a sample, as level_ranges.h has it.
double DistanceOf(const LandEye& eye, double column, double row) {
  return eye.DistanceOver(eye.ChordTo(LatticePlace{column, row}));
}

// Samples of all corners that a chunk's cells have.
double Side(const ChunkKey& key) { return kChunkCells * std::exp2(key.level); }

struct LevelCase {
  LandEye eye;
  std::vector<LevelRange> ranges;
  std::vector<DrawnChunk> drawn;
};

// Eyes low and high, with everything there and with levels that do not reach out yet.
// @param place_of  a place for a column and a row from -90 to 810.
std::vector<LevelCase> CasesOn(const LandTiles& tiles, const ChunkTree& tree,
                               const std::function<Place(double column, double row)>& place_of) {
  std::vector<LevelCase> cases;
  for (int i = 0; i < 60; ++i) {
    const double column = 900.0 * std::fmod(0.7549 * i, 1.0) - 90.0;
    const double row = 900.0 * std::fmod(0.5698 * i, 1.0) - 90.0;
    const LandEye eye(tiles.lattice(), place_of(column, row),
                      i % 3 == 0 ? 4000.0 * std::fmod(0.61 * i, 1.0) : 0.0, 1e6);
    LandDemand demand =
        DemandOf(tree, eye, i % 2 == 0 ? 96.0 : 64.0, [](const ChunkKey&) { return true; });
    if (i % 4 == 1) {
      for (std::size_t level = 0; level + 1 < demand.reach_m.size(); ++level)
        demand.reach_m[level] *= std::fmod(0.37 * (i + 3.0 * static_cast<double>(level)), 1.0);
    }
    LevelCase made{eye, RangesOf(demand.reach_m, eye), {}};
    made.drawn = DrawnChunks(tree, eye, made.ranges, [](const ChunkKey&) { return true; });
    cases.push_back(made);
  }
  return cases;
}

std::vector<LevelCase> Cases(const LandTiles& tiles, const ChunkTree& tree) {
  return CasesOn(tiles, tree,
                 [](double column, double row) { return PlaceOfSample(column, row, 0.0); });
}

TEST_F(LevelRanges, ChunksCoverAllLandExactlyOnce) {
  for (const LevelCase& each : Cases(*tiles_, *tree_)) {
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

// Checks the condition that joins two levels, at each border of two chunks. Returns the number of
// borders between levels.
int CheckBorders(const ChunkTree& tree, const std::vector<LevelCase>& cases) {
  int borders = 0;
  for (const LevelCase& each : cases) {
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
        const ChunkKey beside = tree.Neighbour(chunk.key, columns, rows);
        if (!tree.Exists(beside) || drawn.contains(beside)) {
          EXPECT_EQ(chunk.coarse_sides & bit, 0U);
          continue;
        }
        if (!drawn.contains(beside.Parent())) {
          EXPECT_EQ(chunk.coarse_sides & bit, 0U) << "finer ones lie there";
          bool finer = false;
          for (const ChunkKey& child : tree.Children(beside)) finer |= drawn.contains(child);
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
          if (level + 1 < tree.top()) {
            EXPECT_LE(d, each.ranges[fine + 1].start_m) << "which is still its own";
          }
        }
      }
    }
  }
  return borders;
}

TEST_F(LevelRanges, AtABorderTheFinerLevelIsMorphedAndTheCoarserIsNot) {
  EXPECT_GT(CheckBorders(*tree_, Cases(*tiles_, *tree_)), 500) << "there was something to test";
}

/// Land around a pole, whose cells are about square 50 km away.
class PolarLevels : public LandFolder, public ::testing::WithParamInterface<double> {
 protected:
  void SetUp() override {
    LandFolder::SetUp();
    WritePolarModel(folder_ / "pole.tif", GetParam(), 0.01);
    tiles_.emplace(LandSource{{folder_ / "pole.tif"}, VoidPolicy::kFill, std::nullopt});
    tree_.emplace(*tiles_);
  }
  std::optional<LandTiles> tiles_;
  std::optional<ChunkTree> tree_;
};
INSTANTIATE_TEST_SUITE_P(BothPoles, PolarLevels, ::testing::Values(1.0, -1.0));

// Hard case 17.
TEST_P(PolarLevels, LevelsMeetAroundThePoleAndAcrossTheDateLine) {
  const auto near_pole = [](double column, double row) {
    return CheckedPlace({GetParam() * (90.0 - 0.7 * std::abs(row) / 810.0),
                         std::remainder(180.0 + 0.2 * column, 360.0), 0.0});
  };
  EXPECT_GT(CheckBorders(*tree_, CasesOn(*tiles_, *tree_, near_pole)), 100);
}

// Hard case 17.
TEST_P(PolarLevels, DistanceAcrossThePoleIsTheShortWay) {
  const auto all = [](const ChunkKey&) { return true; };
  for (const double longitude : {0.0, 75.0, 180.0}) {
    const LandEye eye(tiles_->lattice(), CheckedPlace({GetParam() * 89.99, longitude, 0.0}), 0.0,
                      1e6);
    const auto drawn =
        DrawnChunks(*tree_, eye, RangesOf(DemandOf(*tree_, eye, 64.0, all).reach_m, eye), all);
    for (const double around : {0.0, 90.0, 180.0, 270.0}) {
      LatticePlace there = tiles_->lattice().At(GetParam() * 89.95 * kRadiansPerDegree,
                                                (longitude + around) * kRadiansPerDegree);
      there.column = tiles_->lattice().WithinTurn(there.column);
      const auto holds = [&](const DrawnChunk& chunk) {
        const double side = Side(chunk.key);
        return there.column >= chunk.key.column * side &&
               there.column < (chunk.key.column + 1) * side && there.row >= chunk.key.row * side &&
               there.row < (chunk.key.row + 1) * side;
      };
      const auto found = std::find_if(drawn.begin(), drawn.end(), holds);
      ASSERT_NE(found, drawn.end());
      EXPECT_EQ(found->key.level, 0) << "up to seven kilometres away, " << around << " degrees on";
    }
  }
}

// The least distance of many points of an area, on a sphere of this radius.
double LeastChord(const LandEye& eye, const LatticeArea& area, double north_rad) {
  const auto unit = [](double latitude, double longitude) {
    return glm::dvec3(std::cos(latitude) * std::cos(longitude),
                      std::cos(latitude) * std::sin(longitude), std::sin(latitude));
  };
  const glm::dvec3 from = unit(eye.latitude_rad, eye.at.column * eye.step_lon_rad);
  double least = 2.0;
  constexpr int kSteps = 64;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= kSteps; ++j) {
      const double column = area.first_column + (area.last_column - area.first_column) * i / kSteps;
      const double row = area.first_row + (area.last_row - area.first_row) * j / kSteps;
      least = std::min(least, glm::distance(from, unit(north_rad - row * eye.step_lat_rad,
                                                       column * eye.step_lon_rad)));
    }
  }
  return eye.radius_m() * least;
}

// Hard case 17.
TEST_P(PolarLevels, DistanceOfAChunkIsThatOfItsNearestPoint) {
  const LandLattice& lattice = tiles_->lattice();
  for (int i = 0; i < 200; ++i) {
    const auto random = [&](double factor) { return std::fmod(factor * (i + 1), 1.0); };
    const LandEye eye(lattice,
                      CheckedPlace({GetParam() * (90.0 - 1.0 * random(0.7549)),
                                    360.0 * random(0.5698) - 180.0, 0.0}),
                      0.0, 1e6);
    const double first = std::floor(480.0 * random(0.61)),
                 row = 1.0 + std::floor(30.0 * random(0.33));
    const LatticeArea area{first, row, first + 16.0, row + 16.0};
    const double chord = eye.ChordTo(area), least = LeastChord(eye, area, lattice.north_rad);
    EXPECT_LE(chord, least + 1.0) << "no point is nearer";
    EXPECT_NEAR(chord, least, 500.0) << "points are up to a step of 64 apart: 0.4 km";
  }
}

TEST_F(LevelRanges, LevelsMorphOverALongStretch) {
  for (const LevelCase& each : Cases(*tiles_, *tree_)) {
    for (const LevelRange& range : each.ranges) {
      if (range.end_m > 0.0 && range.end_m < 1e29) {
        EXPECT_LE(range.start_m, 0.91 * range.end_m);
      }
    }
  }
}

TEST_F(LevelRanges, AbsentChunksAreNotDrawnAndHideNothing) {
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

TEST_F(LevelRanges, EverySampleIsDrawnNearTheEyeAndFewerFromAbove) {
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

// --- the drawn surface while the eye flies: every vertex moves as land/land.vert.glsl moves it ---

class DrawnSurface {
 public:
  explicit DrawnSurface(const LoadedHeights& heights)
      : heights_(heights),
        tree_(heights.tiles()),
        anchor_{LocalFrame(kWgs84, PlaceOfSample(360.0, 360.0, 0.0)), 360, 360} {}

  void Look(const LandEye& eye) {
    const auto all = [](const ChunkKey&) { return true; };
    eye_ = eye;
    ranges_ = RangesOf(DemandOf(tree_, eye, 96.0, all).reach_m, eye);
    drawn_.clear();
    for (const DrawnChunk& chunk : DrawnChunks(tree_, eye, ranges_, all)) drawn_[chunk.key] = chunk;
  }

  struct Height {
    double drawn_m, own_m, coarse_m;
  };
  // Returns the height of the triangle over a place between samples.
  [[nodiscard]] Height At(double column, double row) {
    for (int level = 0; level <= tree_.top(); ++level) {
      const double side = kChunkCells * std::exp2(level);
      const ChunkKey key{level, static_cast<int>(column / side), static_cast<int>(row / side)};
      const auto found = drawn_.find(key);
      if (found != drawn_.end()) return On(found->second, column, row);
    }
    ADD_FAILURE() << "nothing is drawn there";
    return {};
  }

 private:
  struct Corner {
    double column, row;
    Height height;
  };

  [[nodiscard]] const LandChunk& Chunk(const ChunkKey& key) {
    const auto found = chunks_.find(key);
    if (found != chunks_.end()) return found->second;
    return chunks_.emplace(key, MakeChunk(heights_, key, tree_.top(), anchor_)).first->second;
  }

  [[nodiscard]] Corner CornerOf(const LandChunk& chunk, std::uint16_t vertex) const {
    const ChunkVertex& v = chunk.vertices[vertex];
    const auto height = [&](const std::array<float, 3>& p) {
      return anchor_.frame.GeodeticFromEnu(Point<Enu>{{p[0], p[1], p[2]}}).height_m;
    };
    const double column = static_cast<double>(v.sample[0]) + anchor_.column;
    const double row = static_cast<double>(v.sample[1]) + anchor_.row;
    const double d = DistanceOf(eye_, column, row);
    const LevelRange& range = ranges_[static_cast<std::size_t>(chunk.key.level)];
    const double turned =
        std::clamp((d - range.start_m) / (0.999 * range.end_m - range.start_m), 0.0, 1.0);
    const double own = height(v.position_m), coarse = height(v.coarse_position_m);
    return {column, row, {own + turned * (coarse - own), own, coarse}};
  }

  [[nodiscard]] Height On(const DrawnChunk& drawn, double column, double row) {
    const LandChunk& chunk = Chunk(drawn.key);
    const auto triangles = WithCoarseSides(chunk.triangles, chunk.ends, drawn.coarse_sides);
    for (std::size_t t = 0; t < triangles.size(); t += 3) {
      const Corner a = CornerOfCached(chunk, triangles[t], column, row);
      if (std::abs(a.column - column) > 2 << drawn.key.level ||
          std::abs(a.row - row) > 2 << drawn.key.level)
        continue;
      const Corner b = CornerOf(chunk, triangles[t + 1]), c = CornerOf(chunk, triangles[t + 2]);
      const double whole =
          (b.column - a.column) * (c.row - a.row) - (c.column - a.column) * (b.row - a.row);
      const double of_b =
          ((column - a.column) * (c.row - a.row) - (c.column - a.column) * (row - a.row)) / whole;
      const double of_c =
          ((b.column - a.column) * (row - a.row) - (column - a.column) * (b.row - a.row)) / whole;
      const double of_a = 1.0 - of_b - of_c;
      if (of_a < -1e-9 || of_b < -1e-9 || of_c < -1e-9) continue;
      const auto mean = [&](double Height::*of) {
        return of_a * a.height.*of + of_b * b.height.*of + of_c * c.height.*of;
      };
      return {mean(&Height::drawn_m), mean(&Height::own_m), mean(&Height::coarse_m)};
    }
    ADD_FAILURE() << "no triangle is over the place";
    return {};
  }

  // Returns the place alone of a corner that is far from (column, row).
  [[nodiscard]] Corner CornerOfCached(const LandChunk& chunk, std::uint16_t vertex, double column,
                                      double row) const {
    const ChunkVertex& v = chunk.vertices[vertex];
    const double at_column = static_cast<double>(v.sample[0]) + anchor_.column;
    const double at_row = static_cast<double>(v.sample[1]) + anchor_.row;
    const double far = 2 << chunk.key.level;
    if (std::abs(at_column - column) > far || std::abs(at_row - row) > far)
      return {at_column, at_row, {}};
    return CornerOf(chunk, vertex);
  }

  const LoadedHeights& heights_;
  ChunkTree tree_;
  LandAnchor anchor_;
  LandEye eye_;
  std::vector<LevelRange> ranges_;
  std::map<ChunkKey, DrawnChunk> drawn_;
  std::map<ChunkKey, LandChunk> chunks_;
};

class LandInFlight : public LandFolder {};

TEST_F(LandInFlight, SurfaceNeverJumps) {
  WriteTiles(3);
  const LoadedHeights heights = AllHeights({{folder_}, VoidPolicy::kFill, std::nullopt});
  DrawnSurface surface(heights);
  LandEye eye;
  constexpr int kSteps = 120, kPlaces = 12;
  constexpr double kStep_m = 20.0;
  std::vector<double> before;
  double fastest = 0.0, widest = 0.0;  // [rad]
  for (int step = 0; step < kSteps; ++step) {
    // Level, then upwards.
    constexpr double kColumn_m = 31.8;
    eye = LandEye(heights.tiles().lattice(),
                  PlaceOfSample(20.0 + std::min(step, 80) * kStep_m / kColumn_m, 360.0, 0.0),
                  std::max(step - 80, 0) * kStep_m, 1e6);
    surface.Look(eye);
    for (std::size_t place = 0; place < kPlaces; ++place) {
      const double column = 30.3 + 55.0 * static_cast<double>(place), row = 330.7;
      const auto height = surface.At(column, row);
      const double d = DistanceOf(eye, column, row);
      widest = std::max(widest, std::abs(height.own_m - height.coarse_m) / d);
      if (step > 0) fastest = std::max(fastest, std::abs(height.drawn_m - before[place]) / d);
      before.resize(kPlaces);
      before[place] = height.drawn_m;
    }
  }
  EXPECT_LT(fastest, 3e-4) << "a third of a pixel of 1280 over 60 degrees in 20 m of flight";
  EXPECT_GT(widest, 3e-3) << "levels that differ by that would be seen to pop";
}

// --- what the skyline hides ---

// A wall 1 km north of the eye, 2 km wide and 100 m over the eye.
std::vector<LandSkyline::Between> Wall() {
  std::vector<LandSkyline::Between> wall;
  for (double x = -1000.0; x <= 1000.0; x += 50.0)
    wall.push_back({{x, 1000.0, 100.0}, {x, 1000.0, 110.0}});
  return wall;
}

TEST(LandSkyline, AWallHidesLowerLandBehindIt) {
  LandSkyline skyline;
  skyline.Add(Wall());
  EXPECT_FALSE(skyline.Hides({0.0, 500.0, 0.0}, 10.0, 0.0)) << "before it";
  EXPECT_TRUE(skyline.Hides({0.0, 3000.0, 0.0}, 50.0, 150.0))
      << "under the line of sight over its corners, 100 m in 1414 m";
  EXPECT_FALSE(skyline.Hides({0.0, 3000.0, 0.0}, 50.0, 301.0)) << "over it";
  EXPECT_FALSE(skyline.Hides({3000.0, 3000.0, 0.0}, 50.0, 0.0)) << "half behind its end";
  EXPECT_FALSE(skyline.Hides({3000.0, 0.0, 0.0}, 50.0, 0.0)) << "beside it";
  EXPECT_FALSE(skyline.Hides({0.0, -3000.0, 0.0}, 50.0, 0.0)) << "opposite";
}

TEST(LandSkyline, UsesTheLowerOfTwoLevels) {
  std::vector<LandSkyline::Between> turning = Wall();
  for (LandSkyline::Between& vertex : turning) vertex.other.z = 20.0;
  LandSkyline skyline;
  skyline.Add(turning);
  EXPECT_FALSE(skyline.Hides({0.0, 3000.0, 0.0}, 50.0, 100.0));
  EXPECT_TRUE(skyline.Hides({0.0, 3000.0, 0.0}, 50.0, 20.0));
}

TEST(LandSkyline, AWallHidesNothingInFrontOfIt) {
  LandSkyline skyline;
  skyline.Add(Wall());
  EXPECT_FALSE(skyline.Hides({0.0, 1400.0, 0.0}, 50.0, -10.0)) << "the wall's ends are 1414 m away";
  EXPECT_TRUE(skyline.Hides({0.0, 1500.0, 0.0}, 50.0, -10.0));
}

TEST(LandSkyline, ACrestHidesGroundBehindItFromAbove) {
  std::vector<LandSkyline::Between> crest = Wall();
  for (LandSkyline::Between& vertex : crest) {
    vertex.one.z = -100.0;
    vertex.other.z = -100.0;
  }
  LandSkyline skyline;
  skyline.Add(crest);
  EXPECT_TRUE(skyline.Hides({0.0, 2000.0, 0.0}, 50.0, -300.0));
  EXPECT_FALSE(skyline.Hides({0.0, 2000.0, 0.0}, 50.0, -150.0));
}

TEST(LandSkyline, AGapInAWallHidesNothing) {
  LandSkyline skyline;
  const std::vector<LandSkyline::Between> wall = Wall();
  skyline.Add(std::span(wall).first(18));
  skyline.Add(std::span(wall).last(18));  // 250 m are open in the middle
  EXPECT_FALSE(skyline.Hides({0.0, 3000.0, 0.0}, 50.0, 0.0));
}

}  // namespace
}  // namespace alpenglow::viewer
