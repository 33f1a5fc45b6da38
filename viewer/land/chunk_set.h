// SPDX-License-Identifier: MIT
// Terrain chunks in memory and on the GPU: their buffers, their lighting and the set that is kept.
//
// ChunkBuffers holds one vertex buffer, two light buffers (the old and the new light) and one index
// buffer. LightFade cross-fades from the old light of the vertices to a new one that a worker
// thread computes. MakeChunks builds and lights chunks on that thread. ChunkSet holds all chunks
// that share one anchor.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "renderer/terrain/land_chunk.h"
#include "renderer/terrain/level_ranges.h"
#include "renderer/terrain/loaded_heights.h"
#include "renderer/terrain/seen_chunks.h"
#include "viewer/gl/gl_context.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// Selects one of the two light buffers of a vertex.
enum class LightSide { kFirst, kSecond };
[[nodiscard]] constexpr LightSide Other(LightSide side) {
  return side == LightSide::kFirst ? LightSide::kSecond : LightSide::kFirst;
}

/// Vertex, light and index buffers for many chunks, one slot per chunk.
class ChunkBuffers {
 public:
  /// @param slots  expected number of chunks. If more are needed, larger buffers are allocated and
  ///   all data is copied.
  explicit ChunkBuffers(int slots);

  /// Stores a chunk in a free slot, with this light on both sides, and returns the slot.
  [[nodiscard]] int Add(std::span<const ChunkVertex> vertices, std::span<const ChunkLight> light);
  void SetLight(int slot, LightSide side, std::span<const ChunkLight> light);
  void Remove(int slot) { free_.push_back(slot); }

  /// Draws the chunks in this order with the program in use. The light fades from side `from` to
  /// the other side.
  void Draw(std::span<const SeenChunk> chunks, LightSide from);

  /// Returns the size [bytes] of all slots, used or not, and of the triangles of whole chunks.
  [[nodiscard]] std::size_t bytes() const;

 private:
  void Grow(int slots);
  void DescribeVertices(LightSide from);
  void SetSides(int slot, const LandChunk& chunk, unsigned sides);

  int slots_ = 0;
  std::vector<int> free_;
  struct CutTriangles {
    unsigned sides = ~0U;  // coarse sides of the slot's triangles; ~0: none yet
    int count = 0;         // number of indices
  };
  std::vector<CutTriangles> cut_;      // one per slot
  std::array<int, 16> whole_count_{};  // number of indices of whole chunks, by coarse sides
  GlBuffer vertices_, first_light_, second_light_, triangles_;
  GlVertexArray layout_;
};

/// Directions to the sun or moon for which the shadow edges of the vertices were computed: for the
/// light that fades out (`from`) and the light that fades in (`to`). Empty if a light has none.
struct EdgesOfVertices {
  std::optional<Vector<Ecef>> from, to;
};

/// Sequence of lights of the vertices. A light starts to be computed when the previous one is
/// complete and fully shown. The first light is shown without a fade.
class LightFade {
 public:
  /// Requests a light to follow the current one. A newer request replaces a pending one.
  void Request(LightOfVertices light) { requested_ = std::move(light); }
  /// Returns whether any light has been completed.
  [[nodiscard]] bool HasShown() const { return lights_shown_ > 0; }
  [[nodiscard]] bool IsChanging() const { return requested_ || is_filling_ || share_ < 1.0; }

  /// Light for newly made vertices (empty before the first request), and its number.
  [[nodiscard]] const std::optional<LightOfVertices>& light() const { return light_; }
  [[nodiscard]] int number() const { return number_; }
  /// Returns whether the hidden side is being filled with light().
  [[nodiscard]] bool IsFilling() const { return is_filling_; }

  /// The picture blends from side `from` to the other side with weight share(). Side `from` is the
  /// one that the next light fills.
  [[nodiscard]] LightSide from() const { return from_; }
  [[nodiscard]] double share() const { return lights_shown_ > 1 ? share_ : 1.0; }
  [[nodiscard]] EdgesOfVertices edges() const {
    return {share() < 1.0 ? to_disk_[Index(from_)] : std::nullopt, to_disk_[Index(Other(from_))]};
  }

  /// Advances the fade by a time.
  /// @param is_complete  whether all vertices have the new light.
  void Advance(double seconds, bool is_complete) {
    share_ = std::min(share_ + seconds / std::max(filled_in_s_, 0.2), 1.0);
    if (is_filling_) filled_in_s_ += seconds;
    if (is_filling_ && is_complete && share_ == 1.0) {
      is_filling_ = false;
      from_ = Other(from_);
      share_ = 0.0;
      ++lights_shown_;
    }
    // Side `from` must not change until the fade ends.
    if (!is_filling_ && requested_ && share_ == 1.0) Begin();
  }

 private:
  [[nodiscard]] static constexpr std::size_t Index(LightSide side) {
    return static_cast<std::size_t>(side);
  }
  void Begin() {
    light_ = std::exchange(requested_, std::nullopt);
    ++number_;
    is_filling_ = true;
    filled_in_s_ = 0.0;
    to_disk_[Index(from_)] = light_->to_disk;
  }

  std::optional<LightOfVertices> light_, requested_;
  std::array<std::optional<Vector<Ecef>>, 2> to_disk_;  // by side
  int number_ = 0;
  bool is_filling_ = false;
  int lights_shown_ = 0;
  LightSide from_ = LightSide::kSecond;
  double share_ = 1.0;        // weight of the other side
  double filled_in_s_ = 0.0;  // time to fill the most recent light
};

/// Chunks to be made or relit, the most urgent first.
struct ChunkOrder {
  std::shared_ptr<const LoadedHeights> heights;
  LandAnchor anchor;
  std::vector<ChunkKey> make;
  std::vector<std::shared_ptr<const LandChunk>> relight;
  int top = 0;                           // the coarsest level
  std::optional<LightOfVertices> light;  // empty before the first light
  int light_number = 0;
  bool for_next_anchor = false;
};

struct LitChunk {
  std::shared_ptr<const LandChunk> chunk;
  std::vector<ChunkVertex> vertices;  // empty if only the light is new
  std::vector<ChunkLight> light;
};

/// The part of a ChunkOrder that was carried out.
struct MadeChunks {
  std::vector<LitChunk> made, relit;
  int light_number;
  bool for_next_anchor;
};

/// Makes chunks for about 30 ms, then returns, so that later requests do not wait long.
[[nodiscard]] MadeChunks MakeChunks(const ChunkOrder& order);

class ChunkSet {
 public:
  struct Kept {
    std::shared_ptr<const LandChunk> chunk;
    int slot = -1;         // on the GPU; -1: nothing to draw
    long last_wanted = 0;  // frame number
    int light = 0;         // number of the light on the side that is being filled
  };

  /// @param slots  expected number of chunks.
  ChunkSet(const LandAnchor& anchor, int slots) : anchor_(anchor), buffers_(slots) {}

  [[nodiscard]] const LandAnchor& anchor() const { return anchor_; }
  [[nodiscard]] std::size_t size() const { return chunks_.size(); }
  [[nodiscard]] bool Has(const ChunkKey& key) const { return chunks_.contains(key); }
  /// Returns null if the chunk is not in the set.
  [[nodiscard]] const Kept* Find(const ChunkKey& key) const;
  /// IsLitBy returns whether all chunks have this light, NotLitBy the chunks that do not have it.
  [[nodiscard]] bool IsLitBy(int light_number) const;
  [[nodiscard]] std::vector<std::shared_ptr<const LandChunk>> NotLitBy(int light_number) const;

  /// Adds chunks that were made. Chunks that are already in the set stay unchanged.
  void Add(const std::vector<LitChunk>& made, int light_number, long frame);
  /// Stores new light on a side. Chunks that were removed meanwhile are skipped.
  void Relight(const std::vector<LitChunk>& relit, LightSide side, int light_number);
  void RecordWanted(const std::vector<WantedChunk>& wanted, long frame);
  /// If there are more than `most` chunks, removes those that no recent frame has wanted.
  void Evict(std::size_t most, long frame);
  /// Draws chunks, see ChunkBuffers::Draw.
  void Draw(std::span<const SeenChunk> chunks, LightSide from) { buffers_.Draw(chunks, from); }

  [[nodiscard]] std::size_t bytes() const;
  [[nodiscard]] std::size_t card_bytes() const { return buffers_.bytes(); }

 private:
  LandAnchor anchor_;
  ChunkBuffers buffers_;
  std::unordered_map<ChunkKey, Kept, ChunkKeyHash> chunks_;
};

}  // namespace alpenglow::viewer
