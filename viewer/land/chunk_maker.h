// SPDX-License-Identifier: MIT
// Making and lighting chunks, beside drawing.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "viewer/land/land_chunk.h"
#include "viewer/land/loaded_heights.h"

namespace alpenglow::viewer {

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

}  // namespace alpenglow::viewer
