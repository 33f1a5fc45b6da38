// SPDX-License-Identifier: MIT
#include "renderer/terrain/level_ranges.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace alpenglow::renderer {
namespace {

constexpr double kAhead = 1.25;       // chunks are requested before they are needed
constexpr double kLatestStart = 0.9;  // of a level's morph range, as a fraction of its end

LatticeArea AreaOf(const ChunkKey& key) {
  const double side = std::exp2(key.level) * kChunkCells;
  return {key.column * side, key.row * side, (key.column + 1) * side, (key.row + 1) * side};
}

// Returns the number of chunks along an axis.
int ChunksAlong(int last_vertex) { return (last_vertex + kChunkCells - 1) / kChunkCells; }

double RangeOfLevel(int level, const LandEye& eye, double detail) {
  return detail * std::sqrt(eye.size.column_m * eye.size.row_m) * std::exp2(level);
}

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
      const ChunkKey next = tree_.Neighbour(key, columns, rows).Parent();
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

LandEye::LandEye(const LandLattice& lattice, const Place& place, double height_above_m,
                 double farthest_m)
    : at{lattice.At(place.latitude_rad(), place.longitude_rad()).column,
         (lattice.north_rad - place.latitude_rad()) / lattice.step_lat_rad},
      size(SampleSizeAt(lattice, place.latitude_rad())),
      above_m(height_above_m),
      sight_m(farthest_m),
      latitude_rad(place.latitude_rad()),
      sin_latitude(std::sin(place.latitude_rad())),
      cos_latitude(std::cos(place.latitude_rad())),
      step_lon_rad(lattice.step_lon_rad),
      step_lat_rad(lattice.step_lat_rad) {
  const double southern_rad = lattice.north_rad - lattice.last_row * lattice.step_lat_rad;
  nearest_equator_rad = std::max({southern_rad, -lattice.north_rad, 0.0});
}

double LandEye::ChordTo(const LatticePlace& place) const {
  return ChordToRow(place.row, std::sin(0.5 * (place.column - at.column) * step_lon_rad));
}

double LandEye::ChordToRow(double row, double across) const {
  const double south = std::sin(0.5 * (row - at.row) * step_lat_rad);
  return radius_m() * std::sqrt(shared::ChordSquare(across, south, sin_latitude, cos_latitude));
}

double LandEye::ChordTo(const LatticeArea& area) const {
  const double turn = 2.0 * std::numbers::pi / step_lon_rad;  // columns
  const double from_first = at.column - area.first_column;
  const bool is_on_meridians =
      from_first - turn * std::floor(from_first / turn) <= area.last_column - area.first_column;
  const auto beside = [&](double column) {
    return std::abs(std::remainder(column - at.column, turn));
  };
  const double columns =
      is_on_meridians ? 0.0 : std::min(beside(area.first_column), beside(area.last_column));
  const double x = std::sin(0.5 * columns * step_lon_rad);
  const auto chord = [&](double row) { return ChordToRow(row, x); };
  const auto row_of = [&](double latitude) {
    return at.row + (latitude_rad - latitude) / step_lat_rad;
  };
  constexpr double kPole_rad = 0.5 * std::numbers::pi;
  const double first = std::max(area.first_row, row_of(kPole_rad));
  const double last = std::min(area.last_row, row_of(-kPole_rad));
  // The nearest point of a meridian's great circle.
  const double nearest_rad = std::atan2(sin_latitude, cos_latitude * (1.0 - 2.0 * x * x));
  const double row = row_of(nearest_rad);
  return row > first && row < last ? chord(row) : std::min(chord(first), chord(last));
}

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
  std::vector<ChunkKey> roots;
  if (tiles_.tiles().empty()) return roots;
  const double side = std::exp2(top_) * kChunkCells;
  const double reach_rows = std::max(eye.sight_m, eye.above_m) / eye.size.row_m;
  const int columns = ChunksAlong(tiles_.lattice().LastI(top_));
  const double last_row = ChunksAlong(tiles_.lattice().LastJ(top_)) - 1.0;
  const auto row_at = [&](double row) {
    return static_cast<int>(std::clamp(std::floor(row / side), 0.0, last_row));
  };
  for (int row = row_at(eye.at.row - reach_rows); row <= row_at(eye.at.row + reach_rows); ++row) {
    for (int column = 0; column < columns; ++column) {
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
  return eye.DistanceOver(Beside(key, eye));
}

double ChunkTree::Beside(const ChunkKey& key, const LandEye& eye) {
  return eye.ChordTo(AreaOf(key));
}

double ChunkTree::Diagonal(int level, const LandEye& eye, double within_m) {
  const double samples = std::exp2(level) * kChunkCells;
  const double angle_rad = within_m / eye.radius_m() + samples * eye.step_lat_rad;
  const double widest_rad =
      std::max(std::abs(eye.latitude_rad) - angle_rad, eye.nearest_equator_rad);
  return samples *
         std::hypot(eye.radius_m() * std::cos(widest_rad) * eye.step_lon_rad, eye.size.row_m);
}

ChunkKey ChunkTree::Neighbour(const ChunkKey& key, int columns, int rows) const {
  ChunkKey next{key.level, key.column + columns, key.row + rows};
  if (!tiles_.lattice().ClosesAroundTheEarth()) return next;
  const int all = ChunksAlong(tiles_.lattice().LastI(key.level));
  next.column = (next.column + all) % all;
  return next;
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
    const double diagonal = ChunkTree::Diagonal(static_cast<int>(level) + 1, eye, finer);
    LevelRange& coarser = ranges[level + 1];
    if (level + 2 < reach_m.size() && finer > 0.0)
      coarser.start_m = std::max(coarser.start_m, finer + diagonal);
    ranges[level] = {0.6 * finer, finer};
    most = kLatestStart * finer - ChunkTree::Diagonal(static_cast<int>(level), eye, finer);
  }
  return ranges;
}

std::vector<DrawnChunk> DrawnChunks(const ChunkTree& tree, const LandEye& eye,
                                    const std::vector<LevelRange>& ranges,
                                    const std::function<bool(const ChunkKey&)>& is_there) {
  return Drawing(tree, eye, ranges).Find(is_there);
}

}  // namespace alpenglow::renderer
