// SPDX-License-Identifier: MIT
#include "viewer/land/chunk_set.h"

#include <algorithm>

namespace alpenglow::viewer {

const ChunkSet::Kept* ChunkSet::Find(const ChunkKey& key) const {
  const auto found = chunks_.find(key);
  return found == chunks_.end() ? nullptr : &found->second;
}

bool ChunkSet::IsLitBy(int light_number) const {
  return std::all_of(chunks_.begin(), chunks_.end(),
                     [&](const auto& entry) { return entry.second.light == light_number; });
}

std::vector<std::shared_ptr<const LandChunk>> ChunkSet::NotLitBy(int light_number) const {
  std::vector<std::shared_ptr<const LandChunk>> others;
  for (const auto& [key, kept] : chunks_)
    if (kept.light != light_number) others.push_back(kept.chunk);
  return others;
}

void ChunkSet::Add(const std::vector<LitChunk>& made, int light_number, long frame) {
  for (const LitChunk& lit : made) {
    if (Has(lit.chunk->key)) continue;
    Kept kept{lit.chunk, -1, frame, light_number};
    if (!lit.chunk->triangles.empty()) kept.slot = buffers_.Add(lit.vertices, lit.light);
    chunks_[lit.chunk->key] = std::move(kept);
  }
}

void ChunkSet::Relight(const std::vector<LitChunk>& relit, LightSide side, int light_number) {
  for (const LitChunk& lit : relit) {
    const auto found = chunks_.find(lit.chunk->key);
    if (found == chunks_.end() || found->second.chunk != lit.chunk) continue;
    if (found->second.slot >= 0) buffers_.SetLight(found->second.slot, side, lit.light);
    found->second.light = light_number;
  }
}

void ChunkSet::NoteWanted(const std::vector<WantedChunk>& wanted, long frame) {
  for (const WantedChunk& chunk : wanted) {
    const auto found = chunks_.find(chunk.key);
    if (found != chunks_.end()) found->second.last_wanted = frame;
  }
}

void ChunkSet::Evict(std::size_t most, long frame) {
  if (chunks_.size() <= most) return;
  constexpr long kFrames = 60;
  for (auto entry = chunks_.begin(); entry != chunks_.end();) {
    if (entry->second.last_wanted + kFrames >= frame) {
      ++entry;
      continue;
    }
    if (entry->second.slot >= 0) buffers_.Remove(entry->second.slot);
    entry = chunks_.erase(entry);
  }
}

std::size_t ChunkSet::bytes() const {
  std::size_t sum = 0;
  for (const auto& [key, kept] : chunks_) sum += BytesOf(*kept.chunk);
  return sum;
}

}  // namespace alpenglow::viewer
