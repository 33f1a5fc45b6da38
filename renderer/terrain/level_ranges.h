// SPDX-License-Identifier: MIT
// Selection of the chunks to draw, and of the ranges over which levels morph into the next coarser
// one.
//
// One distance controls both: d^2 = c^2 + h^2, where c is the chord of a sphere from the place
// under the eye [m], which has no seam at poles and meridians, and h is the height of the eye above
// all nearby ground. Chunks of level k + 1 nearer than end(k) are replaced by their four children
// of level k. Vertices of level k have their own position up to start(k) and that of the coarser
// level from end(k) on. There are no cracks and no popping:
//   - where level k meets a chunk of level k + 1, that chunk is beyond end(k), so the vertices on
//     the finer side have the positions of the coarser level;
//   - start(k + 1) >= end(k) + the diagonal of a chunk of level k + 1, so the vertices on the
//     coarser side still have their own positions.
//
// end(k) is never beyond the nearest chunk that is wanted but not loaded yet, so both conditions
// hold during loading.
//
// This header also provides the function of the shared text land_chord.glsl in C++.
#pragma once

#include <cmath>
#include <functional>
#include <unordered_map>
#include <vector>

#include "atmosphere/shared_glsl/shared_math.h"
#include "renderer/terrain/land_chunk.h"

namespace alpenglow::shared {
// clang-format off
#include "atmosphere/shared_glsl/shared_begin.h"
#include "renderer/terrain/land_chord.glsl"
#include "atmosphere/shared_glsl/shared_end.h"
// clang-format on
}  // namespace alpenglow::shared

namespace alpenglow::renderer {

/// A rectangle of the lattice between samples.
struct LatticeArea {
  double first_column, first_row, last_column, last_row;
};

/// The eye's position on the lattice.
struct LandEye {
  LatticePlace at;       // rows are equidistant, also beside a pole
  SampleSize size;       // of one step at the eye
  double above_m = 0.0;  // h
  double sight_m = 0.0;  // largest distance of visible ground
  double latitude_rad = 0.0;
  double sin_latitude = 0.0, cos_latitude = 1.0;  // of latitude_rad
  double step_lon_rad = 0.0, step_lat_rad = 0.0;  // of the lattice
  double nearest_equator_rad = 0.0;               // least distance of the lattice from the equator

  LandEye() = default;
  LandEye(const LandLattice& lattice, const Place& place, double height_above_m, double farthest_m);

  /// Radius of the sphere on which distances are measured [m].
  [[nodiscard]] double radius_m() const { return size.row_m / step_lat_rad; }
  /// Returns the chord c from the place under the eye to a place on the lattice [m].
  [[nodiscard]] double ChordTo(const LatticePlace& place) const;
  /// Returns the chord to the nearest point of an area [m].
  [[nodiscard]] double ChordTo(const LatticeArea& area) const;
  /// Returns d for a chord.
  [[nodiscard]] double DistanceOver(double chord_m) const { return std::hypot(chord_m, above_m); }

 private:
  /// Returns the chord to a place on a row.
  /// @param across  sine of half the angle between its meridian and the eye's.
  [[nodiscard]] double ChordToRow(double row, double across) const;
};

struct LevelRange {
  double start_m = 0.0, end_m = 0.0;  // end 0: the level is not drawn
};

/// The quadtree of chunks over a lattice. It holds no geometry.
class ChunkTree {
 public:
  explicit ChunkTree(const LandTiles& tiles);

  /// The coarsest level. Its chunks are about as wide as two tiles, or one chunk covers all land.
  [[nodiscard]] int top() const { return top_; }
  /// Returns the visible chunks of the coarsest level, which are the roots of the tree.
  [[nodiscard]] std::vector<ChunkKey> Roots(const LandEye& eye) const;
  /// Returns whether any tile touches the chunk.
  [[nodiscard]] bool Exists(const ChunkKey& key) const;
  /// Returns the distance d to the nearest point of a chunk [m].
  [[nodiscard]] static double Distance(const ChunkKey& key, const LandEye& eye);
  /// Returns the horizontal distance (d without h) to the nearest point of a chunk [m].
  [[nodiscard]] static double Beside(const ChunkKey& key, const LandEye& eye);
  /// Returns the largest diagonal of a chunk of this level that begins within a distance of the eye
  /// [m].
  [[nodiscard]] static double Diagonal(int level, const LandEye& eye, double within_m);
  /// Returns the chunk some columns and rows away, also across the first column of a lattice that
  /// closes around the earth. It need not exist.
  [[nodiscard]] ChunkKey Neighbour(const ChunkKey& key, int columns, int rows) const;
  /// Returns the samples that building a chunk reads: its own and those around it, of its level and
  /// the next one.
  [[nodiscard]] LatticeBox Reads(const ChunkKey& key) const;
  /// Returns the up to four finer chunks that exist.
  [[nodiscard]] std::vector<ChunkKey> Children(const ChunkKey& key) const;

 private:
  [[nodiscard]] LatticeBox BoxOf(const ChunkKey& key, int margin) const;

  const LandTiles& tiles_;
  int top_ = 0;
  mutable std::unordered_map<ChunkKey, bool, ChunkKeyHash> exists_;
};

/// A chunk that should be loaded, and its priority: smaller is more urgent.
struct WantedChunk {
  ChunkKey key;
  double urgency;
};

/// The chunks that the eye needs, and the range that each level can reach with the loaded ones.
struct LandDemand {
  std::vector<WantedChunk> wanted;  // loaded or not
  std::vector<double> reach_m;      // one per level: no chunk is missing nearer than this
};

/// Finds the chunks that the eye needs.
/// @param detail    range of level 0 in samples.
/// @param is_there  whether a chunk can be drawn.
[[nodiscard]] LandDemand DemandOf(const ChunkTree& tree, const LandEye& eye, double detail,
                                  const std::function<bool(const ChunkKey&)>& is_there);

/// Returns the range of each level, from the distance that it can reach [m].
/// @param reach_m  one per level, at most the level's own range.
[[nodiscard]] std::vector<LevelRange> RangesOf(const std::vector<double>& reach_m,
                                               const LandEye& eye);

/// A chunk to draw, and its sides that touch a coarser chunk.
struct DrawnChunk {
  ChunkKey key;
  double beside_m;
  unsigned coarse_sides;
};

/// Returns all chunks around the eye, in view or not, from near to far.
/// @param is_there  whether a chunk of the coarsest level can be drawn.
[[nodiscard]] std::vector<DrawnChunk> DrawnChunks(
    const ChunkTree& tree, const LandEye& eye, const std::vector<LevelRange>& ranges,
    const std::function<bool(const ChunkKey&)>& is_there);

}  // namespace alpenglow::renderer
