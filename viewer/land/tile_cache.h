// SPDX-License-Identifier: MIT
// Tiles read and dropped by position, beside drawing, within a bound of memory.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "viewer/job/latest_job.h"
#include "viewer/land/level_ranges.h"
#include "viewer/land/loaded_heights.h"

namespace alpenglow::viewer {

class TileCache {
 public:
  /// @param most_bytes  of heights that are kept. Beyond it far tiles are kept coarser than they
  ///   would be drawn. The tile that is being read comes on top: twelve bytes a sample of it.
  TileCache(std::shared_ptr<const LandTiles> tiles, const ChunkTree& tree, std::size_t most_bytes);

  void SetDetail(double detail) { detail_ = detail; }

  /// Takes what has been read, drops what is far, asks for what is near. Returns whether heights
  /// have come. Throws InputError when a file that was named by itself cannot be read; what cannot
  /// be read in a folder is noted and is no ground.
  /// @param detail  as in DemandOf.
  bool Update(const LandEye& eye, double detail);

  [[nodiscard]] const std::shared_ptr<const LoadedHeights>& loaded() const { return loaded_; }
  /// Whether all tiles that a chunk reads are there as fine as it needs them, or never will be.
  [[nodiscard]] bool CanMake(const ChunkKey& key) const;

  /// Whether a tile reaches a place.
  [[nodiscard]] bool Reaches(const GeodeticPosition& place) const {
    return !TilesAround(place).empty();
  }
  /// Whether all tiles around a place have been read, however fine, or cannot be.
  [[nodiscard]] bool HasRead(const GeodeticPosition& place) const;

  /// Tiles wanted for the eye, and how many of them are there.
  [[nodiscard]] int wanted() const { return wanted_; }
  [[nodiscard]] int there() const { return there_; }
  /// The file that is being read, "" when none is; the built-in range is "the built-in range".
  [[nodiscard]] const std::string& reading() const { return reading_; }
  [[nodiscard]] std::vector<std::string> TakeNotes() { return std::exchange(notes_, {}); }
  /// Of heights that are kept.
  [[nodiscard]] std::size_t bytes() const;
  [[nodiscard]] bool IsReading() const { return reader_.Busy(); }
  /// Waits until nothing is being read.
  void Wait() { reader_.Wait(); }

 private:
  struct Order {
    int tile, level;
  };
  struct Reading {
    int tile;
    std::shared_ptr<const HeightPyramid> heights;
    std::string note;
    std::string failure;  // empty: read
  };
  static constexpr int kNotWanted = 64;

  [[nodiscard]] std::vector<int> TilesAround(const GeodeticPosition& place) const;
  [[nodiscard]] double Distance(const LandTile& tile, const LandEye& eye) const;
  [[nodiscard]] int LevelWanted(const LandTile& tile, const LandEye& eye) const;
  void Want(const LandEye& eye);
  void KeepWithinBounds(const std::vector<std::size_t>& by_distance);
  bool TakeOne();
  void Drop();
  void AskForNearest(const LandEye& eye);
  [[nodiscard]] bool IsThere(std::size_t tile) const;

  std::shared_ptr<const LandTiles> tiles_;
  const ChunkTree& tree_;
  double detail_ = 0.0;  // of the last update
  std::size_t most_bytes_;
  std::vector<std::shared_ptr<const HeightPyramid>> heights_;
  std::vector<char> has_failed_;
  std::vector<int> level_wanted_;
  std::shared_ptr<const LoadedHeights> loaded_;
  std::vector<std::string> notes_;
  std::string reading_;
  int wanted_ = 0, there_ = 0;
  LatestJob<Order, Reading> reader_;  // last: it uses the tiles
};

}  // namespace alpenglow::viewer
