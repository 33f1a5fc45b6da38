// SPDX-License-Identifier: MIT
#include "viewer/land/chunk_maker.h"

#include <chrono>
#include <utility>

namespace alpenglow::viewer {
namespace {

std::vector<ChunkLight> LightOf(const LandChunk& chunk, const ChunkOrder& order) {
  if (chunk.triangles.empty()) return {};
  return LightOfChunk(chunk, order.anchor.frame, order.light);
}

LitChunk Made(const ChunkKey& key, const ChunkOrder& order) {
  LandChunk chunk = MakeChunk(*order.heights, key, order.top, order.anchor);
  std::vector<ChunkLight> light = LightOf(chunk, order);
  std::vector<ChunkVertex> vertices = std::exchange(chunk.vertices, {});  // for the card alone
  return {std::make_shared<const LandChunk>(std::move(chunk)), std::move(vertices),
          std::move(light)};
}

}  // namespace

MadeChunks MakeChunks(const ChunkOrder& order) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point end = Clock::now() + std::chrono::milliseconds(30);
  MadeChunks made{{}, {}, order.light_number, order.for_next_anchor};
  for (const ChunkKey& key : order.make) {
    if (Clock::now() > end) break;
    made.made.push_back(Made(key, order));
  }
  for (const auto& chunk : order.relight) {
    if (Clock::now() > end) break;
    made.relit.push_back({chunk, {}, LightOf(*chunk, order)});
  }
  return made;
}

}  // namespace alpenglow::viewer
