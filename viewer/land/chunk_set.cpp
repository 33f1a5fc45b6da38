// SPDX-License-Identifier: MIT
#include "viewer/land/chunk_set.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <utility>

#include "viewer/land/land_pass.h"

namespace alpenglow::viewer {
namespace {

constexpr GLsizeiptr kVertexBytes = kChunkVertices * sizeof(ChunkVertex);
constexpr GLsizeiptr kLightBytes = kChunkVertices * sizeof(ChunkLight);
constexpr GLsizeiptr kTriangleBytes = kChunkIndices * sizeof(std::uint16_t);
constexpr GLsizeiptr kWholeBytes = 16 * kTriangleBytes;

// Reallocates a buffer to a larger size and copies its contents.
void Upscale(GlBuffer& buffer, GLsizeiptr before, GLsizeiptr after) {
  GlBuffer larger;
  glBindBuffer(GL_COPY_WRITE_BUFFER, larger.id());
  glBufferData(GL_COPY_WRITE_BUFFER, after, nullptr, GL_DYNAMIC_DRAW);
  if (before > 0) {
    glBindBuffer(GL_COPY_READ_BUFFER, buffer.id());
    glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, 0, before);
  }
  buffer = std::move(larger);
}

template <typename Row>
void Put(const GlBuffer& buffer, GLintptr offset, std::span<const Row> rows) {
  glBindBuffer(GL_COPY_WRITE_BUFFER, buffer.id());
  glBufferSubData(GL_COPY_WRITE_BUFFER, offset, static_cast<GLsizeiptr>(rows.size_bytes()),
                  rows.data());
}

void Attribute(GLuint location, GLint count, GLenum type, GLsizei stride, std::size_t offset) {
  glEnableVertexAttribArray(location);
  glVertexAttribPointer(location, count, type, GL_FALSE, stride,
                        reinterpret_cast<const void*>(offset));
}

void DescribeLight(const GlBuffer& buffer, GLuint first_location) {
  glBindBuffer(GL_ARRAY_BUFFER, buffer.id());
  constexpr GLsizei kStride = sizeof(ChunkLight);
  Attribute(first_location, 4, GL_HALF_FLOAT, kStride, offsetof(ChunkLight, sky));
  Attribute(first_location + 1, 4, GL_HALF_FLOAT, kStride, offsetof(ChunkLight, coarse_sky));
  Attribute(first_location + 2, 4, GL_HALF_FLOAT, kStride, offsetof(ChunkLight, moon_sky));
  Attribute(first_location + 3, 4, GL_HALF_FLOAT, kStride, offsetof(ChunkLight, coarse_moon_sky));
  Attribute(first_location + 4, 2, GL_HALF_FLOAT, kStride, offsetof(ChunkLight, disk_x));
}

std::vector<ChunkLight> LightOf(const LandChunk& chunk, const ChunkOrder& order) {
  if (chunk.triangles.empty()) return {};
  return LightOfChunk(chunk, order.anchor.frame, order.light);
}

LitChunk Made(const ChunkKey& key, const ChunkOrder& order) {
  LandChunk chunk = MakeChunk(*order.heights, key, order.top, order.anchor);
  std::vector<ChunkLight> light = LightOf(chunk, order);
  std::vector<ChunkVertex> vertices = std::exchange(chunk.vertices, {});  // needed on the GPU only
  return {std::make_shared<const LandChunk>(std::move(chunk)), std::move(vertices),
          std::move(light)};
}

}  // namespace

ChunkBuffers::ChunkBuffers(int slots) {
  Upscale(triangles_, 0, kWholeBytes);
  for (unsigned sides = 0; sides < whole_count_.size(); ++sides) {
    const std::vector<std::uint16_t> triangles = WithCoarseSides(WholeTriangles(), {}, sides);
    whole_count_[sides] = static_cast<int>(triangles.size());
    Put(triangles_, sides * kTriangleBytes, std::span<const std::uint16_t>(triangles));
  }
  Grow(slots);
}

void ChunkBuffers::Grow(int slots) {
  Upscale(vertices_, slots_ * kVertexBytes, slots * kVertexBytes);
  Upscale(first_light_, slots_ * kLightBytes, slots * kLightBytes);
  Upscale(second_light_, slots_ * kLightBytes, slots * kLightBytes);
  Upscale(triangles_, kWholeBytes + slots_ * kTriangleBytes, kWholeBytes + slots * kTriangleBytes);
  for (int slot = slots; slot-- > slots_;) free_.push_back(slot);
  cut_.resize(static_cast<std::size_t>(slots));
  slots_ = slots;
}

void ChunkBuffers::SetSides(int slot, const LandChunk& chunk, unsigned sides) {
  CutTriangles& cut = cut_[static_cast<std::size_t>(slot)];
  if (cut.sides == sides) return;
  const std::vector<std::uint16_t> triangles =
      sides == 0 ? chunk.triangles : WithCoarseSides(chunk.triangles, chunk.ends, sides);
  Put(triangles_, kWholeBytes + slot * kTriangleBytes, std::span<const std::uint16_t>(triangles));
  cut = {sides, static_cast<int>(triangles.size())};
}

int ChunkBuffers::Add(std::span<const ChunkVertex> vertices, std::span<const ChunkLight> light) {
  if (free_.empty()) Grow(slots_ + slots_ / 4 + 64);
  const int slot = free_.back();
  free_.pop_back();
  Put(vertices_, slot * kVertexBytes, vertices);
  SetLight(slot, LightSide::kFirst, light);
  SetLight(slot, LightSide::kSecond, light);
  cut_[static_cast<std::size_t>(slot)] = {};
  return slot;
}

void ChunkBuffers::SetLight(int slot, LightSide side, std::span<const ChunkLight> light) {
  Put(side == LightSide::kFirst ? first_light_ : second_light_, slot * kLightBytes, light);
}

void ChunkBuffers::DescribeVertices(LightSide from) {
  constexpr GLsizei kStride = sizeof(ChunkVertex);
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.id());
  Attribute(0, 3, GL_FLOAT, kStride, offsetof(ChunkVertex, position_m));
  Attribute(1, 3, GL_FLOAT, kStride, offsetof(ChunkVertex, coarse_position_m));
  Attribute(2, 2, GL_FLOAT, kStride, offsetof(ChunkVertex, sample));
  Attribute(3, 4, GL_SHORT, kStride, offsetof(ChunkVertex, normal));
  Attribute(4, 4, GL_SHORT, kStride, offsetof(ChunkVertex, coarse_normal));
  const bool from_first = from == LightSide::kFirst;
  DescribeLight(from_first ? first_light_ : second_light_, LandPass::kOldLight);
  DescribeLight(from_first ? second_light_ : first_light_, LandPass::kNewLight);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, triangles_.id());
}

void ChunkBuffers::Draw(std::span<const SeenChunk> chunks, LightSide from) {
  std::vector<GLsizei> counts;
  std::vector<const void*> offsets;
  std::vector<GLint> first_vertices;
  for (const auto& [slot, chunk, sides] : chunks) {
    GLsizeiptr offset = sides * kTriangleBytes;
    int count = whole_count_[sides];
    if (!chunk->is_whole) {
      SetSides(slot, *chunk, sides);
      count = cut_[static_cast<std::size_t>(slot)].count;
      offset = kWholeBytes + slot * kTriangleBytes;
    }
    counts.push_back(count);
    offsets.push_back(reinterpret_cast<const void*>(offset));
    first_vertices.push_back(slot * kChunkVertices);
  }
  glBindVertexArray(layout_.id());
  DescribeVertices(from);
  glMultiDrawElementsBaseVertex(GL_TRIANGLES, counts.data(), GL_UNSIGNED_SHORT, offsets.data(),
                                static_cast<GLsizei>(counts.size()), first_vertices.data());
}

std::size_t ChunkBuffers::bytes() const {
  return static_cast<std::size_t>(kWholeBytes +
                                  slots_ * (kVertexBytes + 2 * kLightBytes + kTriangleBytes));
}

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

void ChunkSet::RecordWanted(const std::vector<WantedChunk>& wanted, long frame) {
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
