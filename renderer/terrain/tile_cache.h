// SPDX-License-Identifier: MIT
// A cache of tiles that are read on a worker thread and dropped by distance, within a memory limit.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "atmosphere/base/async_value.h"
#include "renderer/terrain/level_ranges.h"
#include "renderer/terrain/loaded_heights.h"

namespace alpenglow::renderer {

class TileCache {
 public:
  /// @param most_bytes  limit for the heights that are kept. Beyond it distant tiles are kept
  ///   coarser than they would be drawn. The tile that is being read needs twelve bytes per sample
  ///   in addition.
  TileCache(std::shared_ptr<const LandTiles> tiles, const ChunkTree& tree, std::size_t most_bytes);

  void SetDetail(double detail) { detail_ = detail; }

  /// Collects tiles that were read, drops distant ones and requests near ones. Returns whether new
  /// heights have arrived. Throws InputError if a file that was named explicitly cannot be read.
  /// Unreadable files in a folder cause a note and have no ground.
  /// @param detail  as in DemandOf.
  bool Update(const LandEye& eye, double detail);

  [[nodiscard]] const std::shared_ptr<const LoadedHeights>& loaded() const { return loaded_; }
  /// Returns whether every tile that a chunk reads has the required detail, or will never be
  /// available.
  [[nodiscard]] bool CanMake(const ChunkKey& key) const;

  /// Returns whether a tile covers a place.
  [[nodiscard]] bool Reaches(const Place& place) const { return !TilesAround(place).empty(); }
  /// Returns whether every tile around a place has been read at some level, or cannot be read.
  [[nodiscard]] bool HasRead(const Place& place) const;

  /// Number of tiles that the eye needs, and number of those that are loaded.
  [[nodiscard]] int wanted() const { return wanted_; }
  [[nodiscard]] int there() const { return there_; }
  /// The file that is being read, "" if none is. For the built-in range it is "the built-in range".
  [[nodiscard]] const std::string& reading() const { return reading_; }
  [[nodiscard]] std::vector<std::string> PollNotes() { return std::exchange(notes_, {}); }
  /// Returns the size of the heights that are kept.
  [[nodiscard]] std::size_t bytes() const;
  [[nodiscard]] bool IsReading() const { return reader_.IsBusy(); }
  /// Waits until the current read has ended.
  void Wait() { reader_.Wait(); }

 private:
  struct Order {
    int tile, level;
  };
  struct Reading {
    int tile;
    std::shared_ptr<const HeightPyramid> heights;
    std::string note;
    std::string failure;  // empty if the tile was read
  };
  static constexpr int kNotWanted = 64;

  [[nodiscard]] std::vector<int> TilesAround(const Place& place) const;
  [[nodiscard]] double Distance(const LandTile& tile, const LandEye& eye) const;
  [[nodiscard]] int LevelWanted(const LandTile& tile, const LandEye& eye) const;
  void Want(const LandEye& eye);
  void KeepWithinBounds(const std::vector<std::size_t>& by_distance);
  bool PollOne();
  void Drop();
  void RequestNearest(const LandEye& eye);
  [[nodiscard]] bool IsThere(std::size_t tile) const;

  std::shared_ptr<const LandTiles> tiles_;
  const ChunkTree& tree_;
  double detail_ = 0.0;  // at the last update
  std::size_t most_bytes_;
  std::vector<std::shared_ptr<const HeightPyramid>> heights_;
  std::vector<char> has_failed_;
  std::vector<int> level_wanted_;
  std::shared_ptr<const LoadedHeights> loaded_;
  std::vector<std::string> notes_;
  std::string reading_;
  int wanted_ = 0, there_ = 0;
  AsyncValue<Order, Reading> reader_;  // last member: it uses the tiles
};

}  // namespace alpenglow::renderer
