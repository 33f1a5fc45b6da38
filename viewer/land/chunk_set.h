// SPDX-License-Identifier: MIT
// Chunks on the graphics card: one buffer of vertices, two of their light, one of triangles.
//
// Light of vertices that is made beside drawing and fades into what is shown.
//
// Making and lighting chunks, beside drawing.
//
// The chunks that are there, in memory and on the graphics card: all of one anchor.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "viewer/gl/gl_objects.h"
#include "viewer/land/land_chunk.h"
#include "viewer/land/level_ranges.h"
#include "viewer/land/loaded_heights.h"

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

/// Directions towards the disks before which vertices have their edges of shade, of the light that fades and
/// of the one that is shown; nothing without such light.
struct EdgesOfVertices {
  std::optional<Vector<Ecef>> from, to;
};

/// One light after another: the next begins when the one before is all there and shown. The first is
/// shown at once.
class LightFade {
 public:
  /// To follow; asked again meanwhile, the newest follows.
  void Ask(LightOfVertices light) { asked_ = std::move(light); }
  /// Whether any light has been all there.
  [[nodiscard]] bool HasShown() const { return lights_shown_ > 0; }
  [[nodiscard]] bool IsChanging() const { return asked_ || is_filling_ || share_ < 1.0; }

  /// The light of vertices that are made now, and its number; empty before the first.
  [[nodiscard]] const std::optional<LightOfVertices>& light() const { return light_; }
  [[nodiscard]] int number() const { return number_; }
  /// Whether the side that is not shown is being filled with it.
  [[nodiscard]] bool IsFilling() const { return is_filling_; }

  /// What is shown goes from `from` to the other side by a share; `from` is the one to be filled.
  [[nodiscard]] LightSide from() const { return from_; }
  [[nodiscard]] double share() const { return lights_shown_ > 1 ? share_ : 1.0; }
  [[nodiscard]] EdgesOfVertices edges() const {
    return {share() < 1.0 ? to_disk_[Index(from_)] : std::nullopt, to_disk_[Index(Other(from_))]};
  }

  /// @param is_complete  whether all vertices have the light.
  void Advance(double seconds, bool is_complete) {
    share_ = std::min(share_ + seconds / std::max(filled_in_s_, 0.2), 1.0);
    if (is_filling_) filled_in_s_ += seconds;
    if (is_filling_ && is_complete && share_ == 1.0) {
      is_filling_ = false;
      from_ = Other(from_);
      share_ = 0.0;
      ++lights_shown_;
    }
    // The side that is faded from must stay as it is until the fading ends.
    if (!is_filling_ && asked_ && share_ == 1.0) Begin();
  }

 private:
  [[nodiscard]] static constexpr std::size_t Index(LightSide side) {
    return static_cast<std::size_t>(side);
  }
  void Begin() {
    light_ = std::exchange(asked_, std::nullopt);
    ++number_;
    is_filling_ = true;
    filled_in_s_ = 0.0;
    to_disk_[Index(from_)] = light_->to_disk;
  }

  std::optional<LightOfVertices> light_, asked_;
  std::array<std::optional<Vector<Ecef>>, 2> to_disk_;  // of the sides
  int number_ = 0;
  bool is_filling_ = false;
  int lights_shown_ = 0;
  LightSide from_ = LightSide::kSecond;
  double share_ = 1.0;        // of the way to the other side
  double filled_in_s_ = 0.0;  // the last one
};

/// Chunks that are to be made or lit anew, the most urgent first.
struct ChunkOrder {
  std::shared_ptr<const LoadedHeights> heights;
  LandAnchor anchor;
  std::vector<ChunkKey> make;
  std::vector<std::shared_ptr<const LandChunk>> relight;
  int top = 0;                           // the coarsest level
  std::optional<LightOfVertices> light;  // nothing before the first
  int light_number = 0;
  bool for_next_anchor = false;
};

struct LitChunk {
  std::shared_ptr<const LandChunk> chunk;
  std::vector<ChunkVertex> vertices;  // empty where only the light is new
  std::vector<ChunkLight> light;
};

/// As far as an order was carried out.
struct MadeChunks {
  std::vector<LitChunk> made, relit;
  int light_number;
  bool for_next_anchor;
};

/// As many as take about 30 ms, so that what is asked for later need not wait for long.
[[nodiscard]] MadeChunks MakeChunks(const ChunkOrder& order);

class ChunkSet {
 public:
  struct Kept {
    std::shared_ptr<const LandChunk> chunk;
    int slot = -1;         // on the card; -1: nothing to draw
    long last_wanted = 0;  // the frame
    int light = 0;         // number of the light on the side that is being filled
  };

  /// @param slots  chunks that are expected.
  ChunkSet(const LandAnchor& anchor, int slots) : anchor_(anchor), buffers_(slots) {}

  [[nodiscard]] const LandAnchor& anchor() const { return anchor_; }
  [[nodiscard]] std::size_t size() const { return chunks_.size(); }
  [[nodiscard]] bool Has(const ChunkKey& key) const { return chunks_.contains(key); }
  /// Null: it is not there.
  [[nodiscard]] const Kept* Find(const ChunkKey& key) const;
  /// Whether all have this light, and those that have not.
  [[nodiscard]] bool IsLitBy(int light_number) const;
  [[nodiscard]] std::vector<std::shared_ptr<const LandChunk>> NotLitBy(int light_number) const;

  /// Takes over what has been made; what is there already stays as it is.
  void Add(const std::vector<LitChunk>& made, int light_number, long frame);
  /// Puts new light on a side, but for chunks that have gone meanwhile.
  void Relight(const std::vector<LitChunk>& relit, LightSide side, int light_number);
  void NoteWanted(const std::vector<WantedChunk>& wanted, long frame);
  /// Where there are more than `most`, drops those that no frame of late has wanted.
  void Evict(std::size_t most, long frame);
  /// See ChunkBuffers.
  void Draw(std::span<const ChunkBuffers::Drawn> chunks, LightSide from) {
    buffers_.Draw(chunks, from);
  }

  [[nodiscard]] std::size_t bytes() const;
  [[nodiscard]] std::size_t card_bytes() const { return buffers_.bytes(); }

 private:
  LandAnchor anchor_;
  ChunkBuffers buffers_;
  std::unordered_map<ChunkKey, Kept, ChunkKeyHash> chunks_;
};

}  // namespace alpenglow::viewer
