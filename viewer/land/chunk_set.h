// SPDX-License-Identifier: MIT
// The chunks that are there, in memory and on the graphics card: all of one anchor.
#pragma once

#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "viewer/land/chunk_buffers.h"
#include "viewer/land/chunk_maker.h"
#include "viewer/land/level_ranges.h"

namespace alpenglow::viewer {

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
