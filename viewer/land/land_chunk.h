// SPDX-License-Identifier: MIT
// A square of one level of detail as triangles, ready to turn into the next coarser level.
//
// A chunk is kChunkCells cells wide. Each vertex has two of everything: its own, and what the next
// coarser level has at its place: of a vertex that both levels share that level's own, else the
// mean of the two ends of the coarser edge that it lies on. A vertex of share m between them is
// mix(own, coarser, m); at m = 1 the chunk is the coarser level's surface, triangle for triangle
// (save that level 0 cuts its cells along the diagonal that fits better, all others along the
// falling one).
//
// Normals come from the next finer level's slopes; those of level 0 are its own.
//
// Strugar, F. (2009), Continuous distance-dependent level of detail for rendering heightmaps,
// Journal of Graphics, GPU, and Game Tools 14 (4), 57-74; here the coarser position is not a
// vertex that slides aside but a mean, which moves by less.
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

#include "atmosphere/sun/geodesy.h"
#include "viewer/land/loaded_heights.h"

namespace alpenglow::viewer {

inline constexpr int kChunkCells = 16;
inline constexpr int kChunkSide = kChunkCells + 1;  // vertices
inline constexpr int kChunkVertices = kChunkSide * kChunkSide;
inline constexpr int kChunkIndices = 6 * kChunkCells * kChunkCells;  // at most

/// Which chunk: vertices kChunkCells column .. kChunkCells (column + 1) of the level, and so south.
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

/// A vertex as light falls on it: metres and unit normal in the anchor's frame.
struct LandVertex {
  glm::vec3 position_m{0.0F};
  glm::vec3 normal{0.0F, 0.0F, 1.0F};
};

/// Light at a vertex.
struct VertexLight {
  /// Irradiance of the sky that the sun makes, and of the one that the moon makes, in four bands, over
  /// that of the open sky on the same slope (SkyTilt) under the same sun or moon.
  std::array<float, 4> sky{1.0F, 1.0F, 1.0F, 1.0F}, moon_sky{1.0F, 1.0F, 1.0F, 1.0F};
  /// Height of the centre of the disk that throws shadows over the edge of terrain that hides it, in
  /// radii of the disk, a share of the disk between -1 and 1.
  float disk_x = 4.0F;
};

struct LightOfVertices {
  /// The light of vertices in the frame of an anchor; called on another thread.
  std::function<std::vector<VertexLight>(const LocalFrame&, std::span<const LandVertex>)> at;
  /// Towards what throws the shadows in it; nothing: nothing moves.
  std::optional<Vector<Ecef>> to_disk = std::nullopt;
};

/// Geometry of a vertex as land.vert.glsl reads it.
struct ChunkVertex {
  std::array<float, 3> position_m, coarse_position_m;  // in the anchor's frame
  std::array<float, 2> sample;                         // column and row from the anchor's
  std::array<std::int16_t, 4> normal;                  // times 32767; the last: the level
  std::array<std::int16_t, 4> coarse_normal;           // shorter than 32767 where it is a mean
};
static_assert(sizeof(ChunkVertex) == 48);

/// Light of a vertex as land.vert.glsl reads it: half floats.
struct ChunkLight {
  std::array<std::uint16_t, 4> sky, coarse_sky, moon_sky, coarse_moon_sky;
  std::array<std::uint16_t, 2> disk_x;  // own, coarser
};
static_assert(sizeof(ChunkLight) == 36);

/// What a vertex becomes: two vertices of the next coarser level (the same twice where it is one of
/// them), as indices into LandChunk::coarse.
struct CoarseEnds {
  std::uint8_t first, second;
};

/// Where vertices stand that a graphics card sees in single precision.
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
  std::vector<LandVertex> own, coarse;   // the same for light, and the coarser level's
  std::vector<CoarseEnds> ends;          // one a vertex
  std::vector<std::uint16_t> triangles;  // counter-clockwise seen from outside
  bool is_whole = false;                 // no cell is missing: triangles are WholeTriangles()
  glm::dvec3 low{0.0}, high{0.0};        // box around both surfaces, in the anchor's frame
  double highest_m = 0.0;                // over the ellipsoid
  /// Boxes around parts of kChunkPart x kChunkPart cells, row by row; an empty one has low > high.
  std::array<ChunkBox, kChunkParts> parts;
};

/// @param top  the coarsest level: its vertices stay where they are.
[[nodiscard]] LandChunk MakeChunk(const LoadedHeights& heights, const ChunkKey& key, int top,
                                  const LandAnchor& anchor);

/// What a chunk takes in memory.
[[nodiscard]] std::size_t BytesOf(const LandChunk& chunk);

/// One a vertex. Where no light is made yet: as under the open sky.
[[nodiscard]] std::vector<ChunkLight> LightOfChunk(const LandChunk& chunk, const LocalFrame& frame,
                                                   const std::optional<LightOfVertices>& light);

/// Triangles of a whole chunk of a level other than 0.
[[nodiscard]] const std::vector<std::uint16_t>& WholeTriangles();

/// Sides of a chunk, to be added.
enum ChunkSideBit : unsigned { kNorthSide = 1, kEastSide = 2, kSouthSide = 4, kWestSide = 8 };

/// The triangles without those vertices of these sides that the next coarser level does not have.
/// @param ends  LandChunk::ends; empty for a whole chunk.
[[nodiscard]] std::vector<std::uint16_t> WithCoarseSides(std::span<const std::uint16_t> triangles,
                                                         std::span<const CoarseEnds> ends,
                                                         unsigned sides);

}  // namespace alpenglow::viewer
