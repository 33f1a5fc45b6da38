// SPDX-License-Identifier: MIT
// Which chunks are drawn, and how far each has turned into the next coarser level.
//
// One distance rules both: d^2 = (columns from the eye)^2 + (rows from the eye)^2 + h^2 [m], h the
// eye's height over all ground about. Chunks of level k + 1 nearer than end(k) are replaced by
// their four of level k. Vertices of level k are their own up to start(k) and the coarser level's
// from end(k) on. No cracks, and nothing pops:
//   - where level k meets a chunk of level k + 1, that chunk is beyond end(k), so the finer
//     side's vertices are the coarser level's;
//   - start(k + 1) >= end(k) + the diagonal of a chunk of level k + 1, so the coarser side's are
//     still their own.
// end(k) is never beyond the nearest chunk that is wanted and not there yet, so both hold while
// land is still being loaded.
#pragma once

#include <functional>
#include <unordered_map>
#include <vector>

#include "viewer/land/land_chunk.h"

namespace alpenglow::viewer {

/// The eye among the samples.
struct LandEye {
  LatticePlace at;
  SampleSize size;       // of a step there
  double above_m = 0.0;  // h
  double sight_m = 0.0;  // how far any ground may be seen
};

struct LevelRange {
  double start_m = 0.0, end_m = 0.0;  // end 0: the level is not drawn
};

/// Levels of a lattice and its chunks, as numbers alone.
class ChunkTree {
 public:
  explicit ChunkTree(const LandTiles& tiles);

  /// The coarsest level: its chunks are about as wide as two tiles, or one holds all land.
  [[nodiscard]] int top() const { return top_; }
  /// The chunks of the coarsest level in sight, which stand for themselves.
  [[nodiscard]] std::vector<ChunkKey> Roots(const LandEye& eye) const;
  /// Whether any tile touches the chunk.
  [[nodiscard]] bool Exists(const ChunkKey& key) const;
  /// d of a chunk's nearest point [m].
  [[nodiscard]] static double Distance(const ChunkKey& key, const LandEye& eye);
  /// The same without h: how far beside the eye.
  [[nodiscard]] static double Beside(const ChunkKey& key, const LandEye& eye);
  /// Of a chunk of this level, aslant [m].
  [[nodiscard]] static double Diagonal(int level, const LandEye& eye);
  /// The samples that making a chunk reads: its own and those around, of its level and the next.
  [[nodiscard]] LatticeBox Reads(const ChunkKey& key) const;
  /// The four finer ones, as far as they exist.
  [[nodiscard]] std::vector<ChunkKey> Children(const ChunkKey& key) const;

 private:
  [[nodiscard]] LatticeBox BoxOf(const ChunkKey& key, int margin) const;

  const LandTiles& tiles_;
  int top_ = 0;
  mutable std::unordered_map<ChunkKey, bool, ChunkKeyHash> exists_;
};

/// A chunk that should be there, and how soon: smaller is sooner.
struct WantedChunk {
  ChunkKey key;
  double urgency;
};

/// What is wanted for the eye, and how far each level may reach with what is there.
struct LandDemand {
  std::vector<WantedChunk> wanted;  // there or not
  std::vector<double> reach_m;      // one a level: nothing is missing nearer than that
};

/// @param detail    range of level 0 in samples.
/// @param is_there  whether a chunk can be drawn.
[[nodiscard]] LandDemand DemandOf(const ChunkTree& tree, const LandEye& eye, double detail,
                                  const std::function<bool(const ChunkKey&)>& is_there);

/// The ranges that follow from how far levels may reach [m], at most their own range.
/// @param reach_m  one a level.
[[nodiscard]] std::vector<LevelRange> RangesOf(const std::vector<double>& reach_m,
                                               const LandEye& eye);

/// A chunk that is drawn, and its sides where a coarser one is drawn.
struct DrawnChunk {
  ChunkKey key;
  double beside_m;
  unsigned coarse_sides;
};

/// All around the eye, in view or not, from near to far.
/// @param is_there  whether a chunk of the coarsest level can be drawn.
[[nodiscard]] std::vector<DrawnChunk> DrawnChunks(
    const ChunkTree& tree, const LandEye& eye, const std::vector<LevelRange>& ranges,
    const std::function<bool(const ChunkKey&)>& is_there);

}  // namespace alpenglow::viewer
