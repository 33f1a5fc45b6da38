// SPDX-License-Identifier: MIT
// A chunk: a square of one level of detail as triangles that can morph into the next coarser level.
//
// A chunk is kChunkCells cells wide. Each vertex has two positions, normals and lights: its own,
// and those of the next coarser level at the same place. If both levels share the vertex, the
// second is the coarser level's vertex, otherwise the mean of the two ends of the coarser edge on
// which it lies. With morph weight m a vertex is mix(own, coarser, m). At m = 1 the chunk is the
// surface of the coarser level, triangle for triangle (except that level 0 cuts its cells along the
// diagonal that fits better, all other levels along the falling one).
//
// Normals come from the slopes of the next finer level. Level 0 uses its own.
//
// Strugar, F. (2009), Continuous distance-dependent level of detail for rendering heightmaps,
// Journal of Graphics, GPU, and Game Tools 14 (4), 57-74. In that paper the coarser position is a
// vertex that slides aside. Here it is a mean, which moves by less.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "atmosphere/time_place/geodesy.h"
#include "renderer/layer.h"
#include "renderer/terrain/loaded_heights.h"

namespace alpenglow::renderer {

inline constexpr int kChunkCells = 16;
inline constexpr int kChunkSide = kChunkCells + 1;  // vertices
inline constexpr int kChunkVertices = kChunkSide * kChunkSide;
inline constexpr int kChunkIndices = 6 * kChunkCells * kChunkCells;  // at most

/// Identifies a chunk: vertices kChunkCells column .. kChunkCells (column + 1) of the level from
/// west to east, and likewise for rows from north to south.
struct ChunkKey {
  int level = 0, column = 0, row = 0;
  auto operator<=>(const ChunkKey&) const = default;
  [[nodiscard]] ChunkKey Parent() const { return {level + 1, column >> 1, row >> 1}; }
};
struct ChunkKeyHash {
  std::size_t operator()(const ChunkKey& key) const {
    const auto row = static_cast<std::uint32_t>(key.row);
    return (static_cast<std::size_t>(key.level) << 58) ^
           (static_cast<std::size_t>(static_cast<std::uint32_t>(key.column)) << 29) ^ row;
  }
};

/// A vertex to be lit: position [m] and unit normal in the anchor's frame.
struct LandVertex {
  glm::vec3 position_m{0.0F};
  glm::vec3 normal{0.0F, 0.0F, 1.0F};
};

/// Light at a vertex.
struct VertexLight {
  /// Irradiance of the sky lit by the sun and of the sky lit by the moon, in four bands, divided by
  /// the irradiance of the unoccluded sky on the same slope (SkyIrradianceGradient) under the same
  /// sun or moon.
  std::array<float, 4> sky{1.0F, 1.0F, 1.0F, 1.0F}, moon_sky{1.0F, 1.0F, 1.0F, 1.0F};
  /// Elevation of the centre of the shadow-casting disk (sun or moon) above the terrain edge that
  /// hides it, in radii of the disk. Part of the disk is visible between -1 and 1.
  float disk_x = 4.0F;
};

struct LightOfVertices {
  /// Computes the light of vertices in the frame of an anchor. Called on another thread.
  std::function<std::vector<VertexLight>(const LocalFrame&, std::span<const LandVertex>)> at;
  /// Direction to the disk that casts the shadows in this light. Empty: the shadows do not move.
  std::optional<Vector<Ecef>> to_disk = std::nullopt;
};

/// Geometry of a vertex, in the layout of land/land.vert.glsl.
struct ChunkVertex {
  std::array<float, 3> position_m, coarse_position_m;  // in the anchor's frame
  std::array<float, 2> sample;                         // column and row relative to the anchor's
  std::array<std::int16_t, 4> normal;                  // times 32767; the fourth is the level
  std::array<std::int16_t, 4> coarse_normal;           // shorter than 32767 if it is a mean
};
static_assert(sizeof(ChunkVertex) == 48);

/// Light of a vertex as half floats, in the layout of land/land.vert.glsl.
struct ChunkLight {
  std::array<std::uint16_t, 4> sky, coarse_sky, moon_sky, coarse_moon_sky;
  std::array<std::uint16_t, 2> disk_x;  // own, coarser
};
static_assert(sizeof(ChunkLight) == 36);

/// Returns the shares of a VertexLight as half floats. With the sun 66 degrees down, its sky has
/// less than 1e-23 of sunlight, and some shares exceed the largest half float, 65504. They become
/// 65504, because infinity times that sky would be infinite.
[[nodiscard]] std::array<std::uint16_t, 4> PackedShares(const std::array<float, 4>& values);

/// The two vertices of the next coarser level whose mean a vertex morphs into, as indices into
/// LandChunk::coarse. Both are equal if the vertex is one of that level.
struct CoarseEnds {
  std::uint8_t first, second;
};

/// Local frame of vertex positions. It keeps them small enough for single precision on the GPU.
struct LandAnchor {
  LocalFrame frame;
  int column = 0, row = 0;  // a sample near the frame's origin
};

/// A box in the anchor's frame.
struct ChunkBox {
  glm::vec3 low{std::numeric_limits<float>::infinity()};
  glm::vec3 high{-std::numeric_limits<float>::infinity()};
};
inline constexpr int kChunkPart = 4;
inline constexpr std::size_t kChunkParts = 16;

struct LandChunk {
  ChunkKey key;
  std::vector<ChunkVertex> vertices;     // kChunkVertices, row by row from the north-west
  std::vector<LandVertex> own, coarse;   // vertices for lighting: own, and of the coarser level
  std::vector<CoarseEnds> ends;          // one per vertex
  std::vector<std::uint16_t> triangles;  // counter-clockwise seen from outside
  bool is_whole = false;                 // no cell is missing: triangles are WholeTriangles()
  glm::dvec3 low{0.0}, high{0.0};        // box around both surfaces, in the anchor's frame
  double highest_m = 0.0;                // over the ellipsoid
  /// Boxes around parts of kChunkPart x kChunkPart cells, row by row. An empty box has low > high.
  std::array<ChunkBox, kChunkParts> parts;
};

/// Builds the geometry of a chunk.
/// @param top  the coarsest level. Its vertices do not morph.
[[nodiscard]] LandChunk MakeChunk(const LoadedHeights& heights, const ChunkKey& key, int top,
                                  const LandAnchor& anchor);

/// Returns the size of a chunk in memory [bytes].
[[nodiscard]] std::size_t BytesOf(const LandChunk& chunk);

/// Returns the light of each vertex. Without `light` this is the light under the unoccluded sky.
[[nodiscard]] std::vector<ChunkLight> LightOfChunk(const LandChunk& chunk, const LocalFrame& frame,
                                                   const std::optional<LightOfVertices>& light);

/// Returns the triangles of a whole chunk of a level other than 0.
[[nodiscard]] const std::vector<std::uint16_t>& WholeTriangles();

/// Bits for the sides of a chunk; they can be combined.
enum ChunkSideBit : unsigned { kNorthSide = 1, kEastSide = 2, kSouthSide = 4, kWestSide = 8 };

/// Returns the triangles after removing the vertices of these sides that the next coarser level
/// does not have.
/// @param ends  LandChunk::ends; empty for a whole chunk.
[[nodiscard]] std::vector<std::uint16_t> WithCoarseSides(std::span<const std::uint16_t> triangles,
                                                         std::span<const CoarseEnds> ends,
                                                         unsigned sides);

}  // namespace alpenglow::renderer
