// SPDX-License-Identifier: MIT
// Chunks on the graphics card: one buffer of vertices, two of their light, one of triangles.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "viewer/gl/gl_objects.h"
#include "viewer/land/land_chunk.h"

namespace alpenglow::viewer {

/// Which of the two lights of a vertex.
enum class LightSide { kFirst, kSecond };
[[nodiscard]] constexpr LightSide Other(LightSide side) {
  return side == LightSide::kFirst ? LightSide::kSecond : LightSide::kFirst;
}

/// Chunks in slots.
class ChunkBuffers {
 public:
  /// @param slots  that are expected; more are made when they are needed, which copies all.
  explicit ChunkBuffers(int slots);

  /// Puts a chunk into a free slot, its light on both sides.
  [[nodiscard]] int Add(std::span<const ChunkVertex> vertices, std::span<const ChunkLight> light);
  void SetLight(int slot, LightSide side, std::span<const ChunkLight> light);
  void Remove(int slot) { free_.push_back(slot); }

  /// A slot's chunk without the odd vertices of some sides.
  struct Drawn {
    int slot;
    const LandChunk* chunk;
    unsigned coarse_sides;
  };
  /// Draws the chunks in this order, with the program in use. The light goes from `from` to the
  /// other side.
  void Draw(std::span<const Drawn> chunks, LightSide from);

  /// Of all slots, taken or not, and of triangles of whole chunks.
  [[nodiscard]] std::size_t bytes() const;

 private:
  void Grow(int slots);
  void DescribeVertices(LightSide from);
  void SetSides(int slot, const LandChunk& chunk, unsigned sides);

  int slots_ = 0;
  std::vector<int> free_;
  struct CutTriangles {
    unsigned sides = ~0U;  // that the triangles of a slot were made for; none yet
    int count = 0;         // of their indices
  };
  std::vector<CutTriangles> cut_;      // one a slot
  std::array<int, 16> whole_count_{};  // indices of whole chunks, by coarse sides
  GlBuffer vertices_, first_light_, second_light_, triangles_;
  GlVertexArray layout_;
};

}  // namespace alpenglow::viewer
