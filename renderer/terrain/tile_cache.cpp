// SPDX-License-Identifier: MIT
#include "renderer/terrain/tile_cache.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "atmosphere/base/error.h"

namespace alpenglow::renderer {

TileCache::TileCache(std::shared_ptr<const LandTiles> tiles, const ChunkTree& tree,
                     std::size_t most_bytes)
    : tiles_(std::move(tiles)),
      tree_(tree),
      most_bytes_(most_bytes),
      heights_(tiles_->tiles().size()),
      has_failed_(tiles_->tiles().size(), 0),
      level_wanted_(tiles_->tiles().size(), kNotWanted),
      loaded_(std::make_shared<const LoadedHeights>(tiles_, heights_)),
      notes_(tiles_->notes()),
      reader_([all = tiles_](const Order& order) -> Reading {
        try {
          ReadTile read = ReadLandTile(*all, order.tile, order.level);
          return {order.tile, std::move(read.heights), std::move(read.note), ""};
        } catch (const InputError& error) {
          if (!all->tiles()[static_cast<std::size_t>(order.tile)].is_from_folder) throw;
          return {order.tile, nullptr, "", error.what()};
        }
      }) {}

double TileCache::Distance(const LandTile& tile, const LandEye& eye) const {
  const LatticeBox& box = tile.box;
  return eye.DistanceOver(eye.ChordTo(
      LatticeArea{static_cast<double>(box.first_column), static_cast<double>(box.first_row),
                  static_cast<double>(box.last_column), static_cast<double>(box.last_row)}));
}

// Returns the finest level of a tile that the chunks in reach need, see DemandOf.
int TileCache::LevelWanted(const LandTile& tile, const LandEye& eye) const {
  const double distance = Distance(tile, eye);
  const double sample_m = std::sqrt(eye.size.column_m * eye.size.row_m);
  for (int level = 0; level < tree_.top(); ++level) {
    const double range = 1.3 * detail_ * sample_m * std::exp2(level);
    const double reach = range + 1.5 * ChunkTree::Diagonal(level + 1, eye, range);
    if (distance <= reach) return std::max(level - 1, tile.level);  // normals need one level finer
  }
  const double sight = std::max(eye.sight_m, eye.above_m);
  const bool in_sight = distance <= sight + 1.5 * ChunkTree::Diagonal(tree_.top(), eye, sight);
  return in_sight ? std::max(tree_.top() - 1, tile.level) : kNotWanted;
}

void TileCache::Want(const LandEye& eye) {
  std::vector<double> distance(tiles_->tiles().size());
  for (std::size_t tile = 0; tile < distance.size(); ++tile) {
    distance[tile] = Distance(tiles_->tiles()[tile], eye);
    level_wanted_[tile] =
        has_failed_[tile] != 0 ? kNotWanted : LevelWanted(tiles_->tiles()[tile], eye);
  }
  std::vector<std::size_t> by_distance(distance.size());
  std::iota(by_distance.begin(), by_distance.end(), std::size_t{0});
  std::sort(by_distance.begin(), by_distance.end(),
            [&](std::size_t a, std::size_t b) { return distance[a] < distance[b]; });
  KeepWithinBounds(by_distance);
}

// Coarsens tiles from the farthest inwards, each by one level per pass.
void TileCache::KeepWithinBounds(const std::vector<std::size_t>& by_distance) {
  std::size_t sum = 0;
  const auto bytes = [&](std::size_t tile) {
    return level_wanted_[tile] == kNotWanted
               ? std::size_t{0}
               : HeightPyramid::BytesOf(tiles_->tiles()[tile].box, level_wanted_[tile]);
  };
  for (const std::size_t tile : by_distance) sum += bytes(tile);
  for (int pass = 0; pass < kNotWanted && sum > most_bytes_; ++pass) {
    for (auto tile = by_distance.rbegin(); tile != by_distance.rend() && sum > most_bytes_;
         ++tile) {
      if (level_wanted_[*tile] >= tree_.top() - 1) continue;
      sum -= bytes(*tile);
      ++level_wanted_[*tile];
      sum += bytes(*tile);
    }
  }
}

bool TileCache::PollOne() {
  std::optional<Reading> reading = reader_.Poll();
  if (!reading) return false;
  reading_.clear();
  const auto tile = static_cast<std::size_t>(reading->tile);
  heights_[tile] = reading->heights;
  if (!reading->note.empty()) notes_.push_back(reading->note);
  if (!reading->failure.empty()) {
    notes_.push_back("left out: " + reading->failure);
    has_failed_[tile] = 1;
    level_wanted_[tile] = kNotWanted;
  }
  return true;
}

bool TileCache::IsThere(std::size_t tile) const {
  return heights_[tile] && heights_[tile]->finest() <= level_wanted_[tile];
}

// One level more than wanted is kept, so that an eye near the boundary does not cause repeated
// reads.
void TileCache::Drop() {
  for (std::size_t tile = 0; tile < heights_.size(); ++tile) {
    if (!heights_[tile]) continue;
    if (level_wanted_[tile] == kNotWanted) {
      heights_[tile].reset();
    } else if (heights_[tile]->finest() < level_wanted_[tile] - 1 ||
               (heights_[tile]->finest() < level_wanted_[tile] && bytes() > most_bytes_)) {
      heights_[tile] =
          std::make_shared<const HeightPyramid>(heights_[tile]->From(level_wanted_[tile]));
    }
  }
}

void TileCache::RequestNearest(const LandEye& eye) {
  wanted_ = 0;
  there_ = 0;
  std::optional<std::size_t> nearest;
  double least = 0.0;
  for (std::size_t tile = 0; tile < heights_.size(); ++tile) {
    if (level_wanted_[tile] == kNotWanted) continue;
    ++wanted_;
    if (IsThere(tile)) {
      ++there_;
      continue;
    }
    // Tiles without any heights have priority over tiles that need more detail.
    const double distance = Distance(tiles_->tiles()[tile], eye) + (heights_[tile] ? 1e7 : 0.0);
    if (!nearest || distance < least) {
      nearest = tile;
      least = distance;
    }
  }
  if (!nearest || !reading_.empty()) return;
  const std::filesystem::path& file = tiles_->tiles()[*nearest].file;
  reading_ = file.empty() ? "the built-in range" : file.filename().string();
  reader_.Request({static_cast<int>(*nearest), level_wanted_[*nearest]});
}

bool TileCache::Update(const LandEye& eye, double detail) {
  detail_ = detail;
  if (tiles_->tiles().empty()) return false;
  Want(eye);
  const bool has_come = PollOne();
  Drop();
  RequestNearest(eye);
  if (heights_ != loaded_->heights())
    loaded_ = std::make_shared<const LoadedHeights>(tiles_, heights_);
  return has_come;
}

bool TileCache::CanMake(const ChunkKey& key) const {
  const std::vector<int> touching = tiles_->Touching(tree_.Reads(key));
  return std::all_of(touching.begin(), touching.end(), [&](int index) {
    const auto tile = static_cast<std::size_t>(index);
    const int finest = std::max(key.level - 1, tiles_->tiles()[tile].level);
    return has_failed_[tile] != 0 || (heights_[tile] && heights_[tile]->finest() <= finest);
  });
}

std::vector<int> TileCache::TilesAround(const Place& place) const {
  if (tiles_->tiles().empty()) return {};  // the lattice has no steps
  const LatticePlace at = tiles_->lattice().At(place.latitude_rad(), place.longitude_rad());
  const int column = static_cast<int>(std::floor(at.column));
  const int row = static_cast<int>(std::floor(at.row));
  // These are the samples that LoadedHeights::HeightUnder reads.
  return tiles_->Touching({column - 1, row - 1, column + 2, row + 2});
}

bool TileCache::HasRead(const Place& place) const {
  const std::vector<int> around = TilesAround(place);
  return std::all_of(around.begin(), around.end(), [&](int index) {
    const auto tile = static_cast<std::size_t>(index);
    return heights_[tile] || has_failed_[tile] != 0;
  });
}

std::size_t TileCache::bytes() const {
  std::size_t sum = 0;
  for (const auto& pyramid : heights_)
    if (pyramid) sum += pyramid->bytes();
  return sum;
}

}  // namespace alpenglow::renderer
