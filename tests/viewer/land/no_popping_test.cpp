// SPDX-License-Identifier: MIT
// The drawn surface while the eye flies, followed vertex by vertex as land.vert.glsl moves them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "renderer/terrain/level_ranges.h"
#include "tests/renderer/terrain/land_files.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {
namespace {

using namespace tests;

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
  // Of the triangle over a place between samples.
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
    const double d = std::hypot((column - eye_.at.column) * eye_.size.column_m,
                                (row - eye_.at.row) * eye_.size.row_m, eye_.above_m);
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

  // Its place alone where it is far off.
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

TEST_F(LandInFlight, NothingPops) {
  WriteTiles(3);
  const LoadedHeights heights = AllHeights({{folder_}, VoidPolicy::kFill, std::nullopt});
  DrawnSurface surface(heights);
  LandEye eye{{}, SampleSizeAt(heights.tiles().lattice(), 0.81), 0.0, 1e6};
  constexpr int kSteps = 120, kPlaces = 12;
  constexpr double kStep_m = 20.0;
  std::vector<double> before;
  double fastest = 0.0, widest = 0.0;  // [rad]
  for (int step = 0; step < kSteps; ++step) {
    // Level, then upwards.
    eye.at = {20.0 + std::min(step, 80) * kStep_m / eye.size.column_m, 360.0};
    eye.above_m = std::max(step - 80, 0) * kStep_m;
    surface.Look(eye);
    for (std::size_t place = 0; place < kPlaces; ++place) {
      const double column = 30.3 + 55.0 * static_cast<double>(place), row = 330.7;
      const auto height = surface.At(column, row);
      const double d = std::hypot((column - eye.at.column) * eye.size.column_m,
                                  (row - eye.at.row) * eye.size.row_m, eye.above_m);
      widest = std::max(widest, std::abs(height.own_m - height.coarse_m) / d);
      if (step > 0) fastest = std::max(fastest, std::abs(height.drawn_m - before[place]) / d);
      before.resize(kPlaces);
      before[place] = height.drawn_m;
    }
  }
  EXPECT_LT(fastest, 3e-4) << "a third of a pixel of 1280 over 60 degrees in 20 m of flight";
  EXPECT_GT(widest, 3e-3) << "levels that differ by that would be seen to pop";
}

}  // namespace
}  // namespace alpenglow::viewer
