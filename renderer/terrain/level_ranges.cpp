// SPDX-License-Identifier: MIT
#include "renderer/terrain/level_ranges.h"

#include <algorithm>
#include <cmath>
#include <glm/vec2.hpp>
#include <limits>

namespace alpenglow::renderer {
namespace {

constexpr double kAhead = 1.25;       // chunks are requested before they are needed
constexpr double kLatestStart = 0.9;  // of a level's morph range, as a fraction of its end

// Returns the distance from a place to a range, 0 inside it.
double Outside(double place, double first, double last) {
  return std::max({first - place, place - last, 0.0});
}

// Returns the distances to the nearest point of a chunk along columns and rows [m].
glm::dvec2 Away(const ChunkKey& key, const LandEye& eye) {
  const double side = std::exp2(key.level) * kChunkCells;
  return {Outside(eye.at.column, key.column * side, (key.column + 1) * side) * eye.size.column_m,
          Outside(eye.at.row, key.row * side, (key.row + 1) * side) * eye.size.row_m};
}

double RangeOfLevel(int level, const LandEye& eye, double detail) {
  return detail * std::sqrt(eye.size.column_m * eye.size.row_m) * std::exp2(level);
}

}  // namespace

ChunkTree::ChunkTree(const LandTiles& tiles) : tiles_(tiles) {
  const LandLattice& lattice = tiles.lattice();
  int widest = 0;
  for (const LandTile& tile : tiles.tiles())
    widest = std::max({widest, tile.box.last_column - tile.box.first_column,
                       tile.box.last_row - tile.box.first_row});
  const int all = std::max(lattice.last_column, lattice.last_row);
  while (kChunkCells << top_ < std::min(2 * widest, all)) ++top_;
}

std::vector<ChunkKey> ChunkTree::Roots(const LandEye& eye) const {
  const double side = std::exp2(top_) * kChunkCells;
  const auto range = [&](double place, double step_m, int last_vertex) {
    const double reach = eye.sight_m / step_m;
    const double last = (last_vertex - 1) / kChunkCells;
    return std::pair{static_cast<int>(std::clamp(std::floor((place - reach) / side), 0.0, last)),
                     static_cast<int>(std::clamp(std::floor((place + reach) / side), 0.0, last))};
  };
  std::vector<ChunkKey> roots;
  if (tiles_.tiles().empty()) return roots;
  const auto [west, east] = range(eye.at.column, eye.size.column_m, tiles_.lattice().LastI(top_));
  const auto [north, south] = range(eye.at.row, eye.size.row_m, tiles_.lattice().LastJ(top_));
  for (int row = north; row <= south; ++row) {
    for (int column = west; column <= east; ++column) {
      const ChunkKey root{top_, column, row};
      if (Exists(root) && Distance(root, eye) <= std::max(eye.sight_m, eye.above_m))
        roots.push_back(root);
    }
  }
  return roots;
}

LatticeBox ChunkTree::BoxOf(const ChunkKey& key, int margin) const {
  const LandLattice& lattice = tiles_.lattice();
  const int i = kChunkCells * key.column, j = kChunkCells * key.row;
  return {lattice.ColumnOf(i - margin, key.level), lattice.RowOf(j - margin, key.level),
          lattice.ColumnOf(i + kChunkCells + margin, key.level),
          lattice.RowOf(j + kChunkCells + margin, key.level)};
}

bool ChunkTree::Exists(const ChunkKey& key) const {
  const LandLattice& lattice = tiles_.lattice();
  if (key.level < 0 || key.level > top_ || key.column < 0 || key.row < 0) return false;
  if (kChunkCells * key.column >= lattice.LastI(key.level) ||
      kChunkCells * key.row >= lattice.LastJ(key.level))
    return false;
  constexpr std::size_t kMostKnown = 100000;
  if (exists_.size() > kMostKnown) exists_.clear();
  const auto [known, is_new] = exists_.try_emplace(key, false);
  if (is_new) known->second = !tiles_.Touching(BoxOf(key, 0)).empty();
  return known->second;
}

double ChunkTree::Distance(const ChunkKey& key, const LandEye& eye) {
  const glm::dvec2 away = Away(key, eye);
  return std::hypot(away.x, away.y, eye.above_m);
}

double ChunkTree::Beside(const ChunkKey& key, const LandEye& eye) {
  const glm::dvec2 away = Away(key, eye);
  return std::hypot(away.x, away.y);
}

double ChunkTree::Diagonal(int level, const LandEye& eye) {
  return std::exp2(level) * kChunkCells * std::hypot(eye.size.column_m, eye.size.row_m);
}

LatticeBox ChunkTree::Reads(const ChunkKey& key) const { return BoxOf(key, 4); }

std::vector<ChunkKey> ChunkTree::Children(const ChunkKey& key) const {
  std::vector<ChunkKey> children;
  for (int quarter = 0; quarter < 4; ++quarter) {
    const ChunkKey child{key.level - 1, 2 * key.column + quarter % 2, 2 * key.row + quarter / 2};
    if (Exists(child)) children.push_back(child);
  }
  return children;
}

namespace {

class RangeDemand {
 public:
  RangeDemand(const ChunkTree& tree, const LandEye& eye, double detail,
              const std::function<bool(const ChunkKey&)>& is_there)
      : tree_(tree), eye_(eye), detail_(detail), is_there_(is_there) {
    for (int level = 0; level <= tree.top(); ++level)
      found_.reach_m.push_back(RangeOfLevel(level, eye, detail));
    found_.reach_m.back() = std::numeric_limits<double>::infinity();
  }

  LandDemand Find() {
    for (const ChunkKey& root : tree_.Roots(eye_)) {
      found_.wanted.push_back({root, ChunkTree::Distance(root, eye_)});
      if (is_there_(root)) Split(root);
    }
    return std::move(found_);
  }

 private:
  // Children are wanted only when their parent is loaded: coarse land comes first.
  void Split(const ChunkKey& parent) {
    if (parent.level == 0) return;
    const int level = parent.level - 1;
    const double distance = ChunkTree::Distance(parent, eye_);
    const double range = RangeOfLevel(level, eye_, detail_);
    if (distance >= kAhead * range) return;
    const double urgency = distance < range ? distance : 1e9 + distance;
    bool all_there = true;
    for (const ChunkKey& child : tree_.Children(parent)) {
      found_.wanted.push_back({child, urgency});
      if (is_there_(child)) {
        Split(child);
      } else {
        all_there = false;
      }
    }
    double& reach = found_.reach_m[static_cast<std::size_t>(level)];
    if (!all_there) reach = std::min(reach, distance);
  }

  const ChunkTree& tree_;
  const LandEye& eye_;
  double detail_;
  const std::function<bool(const ChunkKey&)>& is_there_;
  LandDemand found_;
};

class Drawing {
 public:
  Drawing(const ChunkTree& tree, const LandEye& eye, const std::vector<LevelRange>& ranges)
      : tree_(tree), eye_(eye), ranges_(ranges) {}

  std::vector<DrawnChunk> Find(const std::function<bool(const ChunkKey&)>& is_there) {
    for (const ChunkKey& root : tree_.Roots(eye_))
      if (is_there(root)) Visit(root);
    std::sort(drawn_.begin(), drawn_.end(),
              [](const DrawnChunk& a, const DrawnChunk& b) { return a.beside_m < b.beside_m; });
    return std::move(drawn_);
  }

 private:
  [[nodiscard]] bool IsSplit(const ChunkKey& key) const {
    if (key.level == 0) return false;
    return ChunkTree::Distance(key, eye_) < ranges_[static_cast<std::size_t>(key.level) - 1].end_m;
  }

  void Visit(const ChunkKey& key) {
    if (IsSplit(key)) {
      for (const ChunkKey& child : tree_.Children(key)) Visit(child);
    } else {
      drawn_.push_back({key, ChunkTree::Beside(key, eye_), CoarseSides(key)});
    }
  }

  // A neighbour of the same level is drawn if its parent is split.
  [[nodiscard]] unsigned CoarseSides(const ChunkKey& key) const {
    if (key.level == tree_.top()) return 0;
    const auto side = [&](int columns, int rows, unsigned bit) {
      const ChunkKey next = ChunkKey{key.level, key.column + columns, key.row + rows}.Parent();
      return next != key.Parent() && tree_.Exists(next) && !IsSplit(next) ? bit : 0U;
    };
    return side(0, -1, kNorthSide) | side(1, 0, kEastSide) | side(0, 1, kSouthSide) |
           side(-1, 0, kWestSide);
  }

  const ChunkTree& tree_;
  const LandEye& eye_;
  const std::vector<LevelRange>& ranges_;
  std::vector<DrawnChunk> drawn_;
};

}  // namespace

LandDemand DemandOf(const ChunkTree& tree, const LandEye& eye, double detail,
                    const std::function<bool(const ChunkKey&)>& is_there) {
  return RangeDemand(tree, eye, detail, is_there).Find();
}

std::vector<LevelRange> RangesOf(const std::vector<double>& reach_m, const LandEye& eye) {
  std::vector<LevelRange> ranges(reach_m.size());
  constexpr double kFar = 1e30;
  ranges.back() = {kFar, kFar};
  double most = std::numeric_limits<double>::infinity();  // bound for the next finer level's end
  for (std::size_t level = reach_m.size() - 1; level-- > 0;) {
    const double finer = std::max(std::min(reach_m[level], most), 0.0);
    const double diagonal = ChunkTree::Diagonal(static_cast<int>(level) + 1, eye);
    LevelRange& coarser = ranges[level + 1];
    if (level + 2 < reach_m.size() && finer > 0.0)
      coarser.start_m = std::max(coarser.start_m, finer + diagonal);
    ranges[level] = {0.6 * finer, finer};
    most = kLatestStart * finer - ChunkTree::Diagonal(static_cast<int>(level), eye);
  }
  return ranges;
}

std::vector<DrawnChunk> DrawnChunks(const ChunkTree& tree, const LandEye& eye,
                                    const std::vector<LevelRange>& ranges,
                                    const std::function<bool(const ChunkKey&)>& is_there) {
  return Drawing(tree, eye, ranges).Find(is_there);
}

}  // namespace alpenglow::renderer
