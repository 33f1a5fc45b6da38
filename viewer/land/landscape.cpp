// SPDX-License-Identifier: MIT
#include "viewer/land/landscape.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <limits>

#include "atmosphere/number/constants.h"
#include "atmosphere/text/error.h"
#include "lut/program/program.h"
#include "viewer/land/skyline.h"

namespace alpenglow {
namespace {

constexpr double kAnchorReach_m = 100e3;
constexpr double kReachTime_s = 0.7;  // that a level takes to come in

// The four sides of the view and what is before it, as planes through the eye; inside is positive.
class ViewPyramid {
 public:
  ViewPyramid(const EyeInAnchor& eye, const LandView& view) : at_(eye.at) {
    const double wide = glm::length(view.right), high = glm::length(view.up);
    const glm::dvec3 forward = eye.Turned(view.forward);
    const glm::dvec3 right = eye.Turned(view.right) / wide, up = eye.Turned(view.up) / high;
    planes_ = {wide * forward + right, wide * forward - right, high * forward + up,
               high * forward - up, forward};
  }
  // Whether any of a box may be inside.
  [[nodiscard]] bool Touches(const glm::dvec3& low, const glm::dvec3& high) const {
    return std::all_of(planes_.begin(), planes_.end(), [&](const glm::dvec3& plane) {
      const glm::dvec3 corner{plane.x > 0.0 ? high.x : low.x, plane.y > 0.0 ? high.y : low.y,
                              plane.z > 0.0 ? high.z : low.z};
      return glm::dot(plane, corner - at_) > 0.0;
    });
  }

 private:
  glm::dvec3 at_;
  std::array<glm::dvec3, 5> planes_;
};

// How far the horizon lies from a height over a sphere a little larger than the earth [m].
double HorizonDistance(double height_m) {
  constexpr double kRadius_m = 6.4e6;
  const double above = std::max(height_m, 0.0);
  return std::sqrt(above * (above + 2.0 * kRadius_m));
}

constexpr double kHighestGround_m = 9000.0;

}  // namespace

Landscape::Landscape(const LandSource& source, const LandSize& size, const Ellipsoid& ellipsoid)
    : tiles_(std::make_shared<const LandTiles>(source)),
      size_(size),
      detail_(size.detail),
      ellipsoid_(ellipsoid),
      tree_(*tiles_),
      cache_(tiles_, tree_, size.most_bytes),
      reach_m_(static_cast<std::size_t>(tree_.top()) + 1, 0.0),
      worker_(Work) {
  RequireInRange(size.detail, 64.0, 1024.0, "the detail of the land");
  if (source.mesh) {
    mesh_.emplace(source.mesh->file, LocalFrame(ellipsoid, source.mesh->place));
  } else if (source.files.empty() && source.range_centre) {
    notes_.emplace_back("the terrain is made up: no elevation model of the place was named");
  }
}

Landscape::~Landscape() = default;

// As many as take about 30 ms, so that what is asked for later need not wait for long.
Landscape::Made Landscape::Work(const Order& order) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point end = Clock::now() + std::chrono::milliseconds(30);
  Made made{{}, {}, order.light_number, order.for_next_anchor};
  const auto light_of = [&](const LandChunk& chunk) {
    return chunk.triangles.empty() ? std::vector<ChunkLight>{}
                                   : LightOfChunk(chunk, order.anchor.frame, order.light);
  };
  for (const ChunkKey& key : order.make) {
    if (Clock::now() > end) break;
    LandChunk chunk = MakeChunk(*order.heights, key, order.top, order.anchor);
    std::vector<ChunkLight> light = light_of(chunk);
    std::vector<ChunkVertex> vertices = std::exchange(chunk.vertices, {});  // for the card alone
    made.made.push_back({std::make_shared<const LandChunk>(std::move(chunk)), std::move(vertices),
                         std::move(light)});
  }
  for (const auto& chunk : order.relight) {
    if (Clock::now() > end) break;
    made.relit.push_back({chunk, {}, light_of(*chunk)});
  }
  return made;
}

LandEye Landscape::EyeAt(const GeodeticPosition& eye) const {
  const LandLattice& lattice = tiles_->lattice();
  LandEye at{lattice.At(eye.latitude_rad, eye.longitude_rad),
             SampleSizeAt(lattice, eye.latitude_rad), 0.0, 0.0};
  at.above_m = std::max(eye.height_m - ceiling_m_.value_or(0.0), 0.0);
  at.sight_m = HorizonDistance(eye.height_m) + HorizonDistance(kHighestGround_m);
  return at;
}

LandAnchor Landscape::AnchorAt(const GeodeticPosition& eye) const {
  const LandLattice& lattice = tiles_->lattice();
  const int column = std::clamp(static_cast<int>(eye_.at.column), 0, lattice.last_column);
  const int row = std::clamp(static_cast<int>(eye_.at.row), 0, lattice.last_row);
  return {LocalFrame(ellipsoid_, {eye.latitude_rad, eye.longitude_rad, 0.0}), column, row};
}

// Of each level a disk about the eye, at most all; and what is kept a while longer.
int Landscape::ExpectedChunks() const {
  const double radius = 1.25 * size_.detail / kChunkCells + 2.0;
  double chunks = 0.0;
  for (int level = 0; level <= tree_.top(); ++level) {
    const double all =
        std::ceil(static_cast<double>(tiles_->lattice().LastI(level)) / kChunkCells) *
        std::ceil(static_cast<double>(tiles_->lattice().LastJ(level)) / kChunkCells);
    chunks += std::min(all, 3.2 * radius * radius);
  }
  return static_cast<int>(1.25 * chunks) + 64;
}

// A new set grows beside the old one and takes its place when it has all that is wanted.
void Landscape::MoveAnchor() {
  if (!set_) set_ = std::make_unique<ChunkSet>(AnchorAt(eye_place_), ExpectedChunks());
  if (next_set_) {
    const bool has_all =
        std::all_of(demand_.wanted.begin(), demand_.wanted.end(), [&](const WantedChunk& wanted) {
          return !set_->chunks.contains(wanted.key) || next_set_->chunks.contains(wanted.key);
        });
    if (!has_all) return;
    set_ = std::move(next_set_);
    drawn_.clear();
    return;
  }
  GeodeticPosition foot = eye_place_;
  foot.height_m = 0.0;
  const double away = glm::length(set_->anchor.frame.EnuFromGeodetic(foot).xyz);
  if (away > kAnchorReach_m)
    next_set_ = std::make_unique<ChunkSet>(AnchorAt(eye_place_), ExpectedChunks());
}

void Landscape::Add(ChunkSet& set, const LitChunk& lit, int light_number) {
  Kept kept{lit.chunk, -1, frame_, light_number};
  if (!lit.chunk->triangles.empty()) kept.slot = set.buffers.Add(lit.vertices, lit.light);
  set.chunks[lit.chunk->key] = std::move(kept);
}

void Landscape::TakeChunks() {
  const std::optional<Made> made = worker_.Take();
  if (!made) return;
  is_working_ = false;
  ChunkSet* const set = made->for_next_anchor ? next_set_.get() : set_.get();
  if (set == nullptr) return;
  for (const LitChunk& lit : made->made)
    if (!set->chunks.contains(lit.chunk->key)) Add(*set, lit, made->light_number);
  for (const LitChunk& lit : made->relit) {
    const auto found = set->chunks.find(lit.chunk->key);
    if (found == set->chunks.end() || found->second.chunk != lit.chunk) continue;
    if (found->second.slot >= 0)
      set->buffers.SetLight(found->second.slot, Other(shown_), lit.light);
    found->second.light = made->light_number;
  }
}

// Gently, so that a zoom does not pop. From high above less land is near, and more of it can be
// drawn finer.
void Landscape::FollowView(double seconds) {
  constexpr double kTime_s = 0.5;
  const double usual = std::tan(kPi / 6.0);
  const double by_lens = std::clamp(std::sqrt(usual / glm::length(view_.right)), 1.0, 2.0);
  const double first_m = size_.detail * std::sqrt(eye_.size.column_m * eye_.size.row_m);
  const double by_height =
      std::clamp(1.0 + 0.35 * std::log2(std::max(eye_.above_m, 1.0) / first_m), 1.0, 3.0);
  const double wanted = size_.detail * std::min(by_lens * by_height, 4.0);
  detail_ = wanted + (detail_ - wanted) * std::exp(-seconds / kTime_s);
}

void Landscape::FindDemand(double seconds) {
  demand_ = DemandOf(tree_, eye_, detail_,
                     [&](const ChunkKey& key) { return set_->chunks.contains(key); });
  for (const WantedChunk& wanted : demand_.wanted) {
    const auto found = set_->chunks.find(wanted.key);
    if (found != set_->chunks.end()) found->second.last_wanted = frame_;
  }
  LetLevelsReach(seconds);
}

// A level that has come reaches out from the eye within a moment, from coarse to fine.
void Landscape::LetLevelsReach(double seconds) {
  for (std::size_t level = 0; level < reach_m_.size(); ++level) {
    const double full = detail_ * std::sqrt(eye_.size.column_m * eye_.size.row_m) *
                        std::exp2(static_cast<double>(level));
    const double grown = reach_m_[level] + full * seconds / kReachTime_s;
    reach_m_[level] = std::min(demand_.reach_m[level], grown);
  }
  ranges_ = RangesOf(reach_m_, eye_);
}

std::vector<ChunkKey> Landscape::Missing(const ChunkSet& set) const {
  constexpr std::size_t kMost = 48;  // so that taking them does not hold up a frame
  std::vector<WantedChunk> missing;
  for (const WantedChunk& wanted : demand_.wanted)
    if (!set.chunks.contains(wanted.key)) missing.push_back(wanted);
  std::sort(missing.begin(), missing.end(),
            [](const WantedChunk& a, const WantedChunk& b) { return a.urgency < b.urgency; });
  std::vector<ChunkKey> keys;
  for (const WantedChunk& wanted : missing) {
    if (keys.size() == kMost) break;
    if (cache_.CanMake(wanted.key)) keys.push_back(wanted.key);
  }
  return keys;
}

void Landscape::AskForChunks() {
  if (is_working_) return;
  for (const bool next : {false, true}) {
    const ChunkSet* const set = next ? next_set_.get() : set_.get();
    if (set == nullptr) continue;
    std::vector<ChunkKey> missing = Missing(*set);
    if (missing.empty()) continue;
    worker_.Ask({cache_.loaded(),
                 set->anchor,
                 std::move(missing),
                 {},
                 tree_.top(),
                 light_,
                 light_number_,
                 next});
    is_working_ = true;
    return;
  }
}

void Landscape::AskForLight() {
  if (is_working_ || !relighting_) return;
  Order order{cache_.loaded(), set_->anchor, {}, {}, tree_.top(), light_, light_number_, false};
  for (const auto& [key, kept] : set_->chunks)
    if (kept.light != light_number_) order.relight.push_back(kept.chunk);
  if (order.relight.empty()) return;
  worker_.Ask(std::move(order));
  is_working_ = true;
}

void Landscape::Relight(LightOfVertices light) {
  if (mesh_) return mesh_->Relight(std::move(light));
  light_asked_ = std::move(light);
}

bool Landscape::IsRelighting() const {
  return mesh_ ? mesh_->IsRelighting() : light_asked_ || relighting_ || fading_ < 1.0;
}

// New light begins when the one before is all there and shown.
void Landscape::FinishLight(double seconds) {
  fading_ = std::min(fading_ + seconds / std::max(relight_s_, 0.2), 1.0);
  if (relighting_) relight_s_ += seconds;
  const bool complete =
      std::all_of(set_->chunks.begin(), set_->chunks.end(),
                  [&](const auto& entry) { return entry.second.light == light_number_; });
  if (relighting_ && complete && fading_ == 1.0) {
    relighting_ = false;
    shown_ = Other(shown_);
    fading_ = 0.0;
  }
  // The side that is faded from must stay as it is until the fading ends.
  if (!relighting_ && light_asked_ && fading_ == 1.0) {
    light_ = *std::exchange(light_asked_, std::nullopt);
    ++light_number_;
    relighting_ = true;
    relight_s_ = 0.0;
  }
}

void Landscape::Evict(ChunkSet& set) const {
  const std::size_t most = demand_.wanted.size() + demand_.wanted.size() / 4 + 64;
  if (set.chunks.size() <= most) return;
  constexpr long kFrames = 60;
  for (auto entry = set.chunks.begin(); entry != set.chunks.end();) {
    if (entry->second.last_wanted + kFrames >= frame_) {
      ++entry;
      continue;
    }
    if (entry->second.slot >= 0) set.buffers.Remove(entry->second.slot);
    entry = set.chunks.erase(entry);
  }
}

// The ground about the eye is as high as any chunk near it, less its distance.
void Landscape::RaiseAbove(double seconds) {
  constexpr double kTime_s = 0.3;
  double highest = -1e9;
  for (const DrawnChunk& near : around_) {
    const auto found = set_->chunks.find(near.key);
    if (found == set_->chunks.end() || found->second.chunk->triangles.empty()) continue;
    const double beside =
        std::sqrt(std::max(near.distance_m * near.distance_m - eye_.above_m * eye_.above_m, 0.0));
    highest = std::max(highest, found->second.chunk->highest_m - beside);
  }
  if (highest < -1e8) return;
  const double share = ceiling_m_ ? 1.0 - std::exp(-seconds / kTime_s) : 1.0;
  // lerp() ends where it should; a sum goes on by a rounding for ever, and Settle with it.
  ceiling_m_ = std::lerp(ceiling_m_.value_or(highest), highest, share);
}

namespace {

// No vertex is missing.
bool IsFull(const LandChunk& chunk) { return chunk.triangles.size() == kChunkIndices; }

// Lines of the surface along every eighth row and column of a chunk.
void AddCrests(Skyline& skyline, const LandChunk& chunk, const EyeInAnchor& eye) {
  constexpr int kStride = kChunkCells / 2;
  const auto between = [&](int i, int j) {
    const auto v = static_cast<std::size_t>(j * kChunkSide + i);
    const glm::dvec3 own(chunk.own[v].position_m);
    if (chunk.coarse.empty()) return Skyline::Between{eye.From(own), eye.From(own)};
    const auto [first, second] = chunk.ends[v];
    const glm::dvec3 coarse = 0.5 * (glm::dvec3(chunk.coarse[first].position_m) +
                                     glm::dvec3(chunk.coarse[second].position_m));
    return Skyline::Between{eye.From(own), eye.From(coarse)};
  };
  for (int line = 0; line <= kChunkCells; line += kStride) {
    std::array<Skyline::Between, kChunkSide> row, column;
    for (int k = 0; k < kChunkSide; ++k) {
      row[static_cast<std::size_t>(k)] = between(k, line);
      column[static_cast<std::size_t>(k)] = between(line, k);
    }
    skyline.Add(row);
    skyline.Add(column);
  }
}

// A part of a chunk, as the skyline may hide it.
struct SeenPart {
  std::size_t chunk;  // which of those in view
  glm::dvec3 middle;  // in the eye's frame
  double radius_m, highest_m, nearest_m;
};

SeenPart PartOf(const ChunkBox& box, std::size_t chunk, const EyeInAnchor& eye) {
  const glm::dvec3 low(box.low), high(box.high);
  const glm::dvec3 middle = eye.From(0.5 * (low + high));
  const glm::dvec3 half = 0.5 * (high - low);
  // The box leans in the eye's frame: its highest corner counts.
  const glm::dvec3 rise = glm::abs(eye.up) * half;
  const double radius = std::hypot(half.x, half.y) + half.z * std::hypot(eye.up.x, eye.up.y);
  return {chunk, middle, radius, middle.z + rise.x + rise.y + rise.z,
          Skyline::NearestOf(middle, radius)};
}

// Whether each chunk has a part that no nearer land hides.
std::vector<char> NotHidden(const std::vector<const LandChunk*>& chunks, const EyeInAnchor& eye) {
  std::vector<SeenPart> parts;
  for (std::size_t chunk = 0; chunk < chunks.size(); ++chunk)
    for (const ChunkBox& box : chunks[chunk]->parts)
      if (box.low.x <= box.high.x) parts.push_back(PartOf(box, chunk, eye));
  std::sort(parts.begin(), parts.end(),
            [](const SeenPart& a, const SeenPart& b) { return a.nearest_m < b.nearest_m; });
  Skyline skyline;
  std::vector<char> is_seen(chunks.size(), 0);
  for (const SeenPart& part : parts) {
    if (is_seen[part.chunk] != 0) continue;
    if (skyline.Hides(part.middle, part.radius_m, part.highest_m)) continue;
    is_seen[part.chunk] = 1;
    if (IsFull(*chunks[part.chunk])) AddCrests(skyline, *chunks[part.chunk], eye);
  }
  return is_seen;
}

}  // namespace

void Landscape::Choose() {
  around_ = DrawnChunks(tree_, eye_, ranges_,
                        [&](const ChunkKey& key) { return set_->chunks.contains(key); });
  const EyeInAnchor eye(set_->anchor.frame, eye_place_);
  const ViewPyramid pyramid(eye, view_);
  const std::optional<double> ground = GroundUnder(eye_place_);
  over_ground_ = ground && eye_place_.height_m > *ground;
  std::vector<ChunkBuffers::Drawn> in_view;
  std::vector<const LandChunk*> chunks;
  for (const DrawnChunk& near : around_) {
    const auto found = set_->chunks.find(near.key);
    if (found == set_->chunks.end() || found->second.slot < 0) continue;
    const LandChunk& chunk = *found->second.chunk;
    if (!pyramid.Touches(chunk.low, chunk.high)) continue;
    in_view.push_back({found->second.slot, &chunk, near.coarse_sides});
    chunks.push_back(&chunk);
  }
  drawn_.clear();
  constexpr double kHigh_m = 5000.0;  // over all ground about: little hides little
  const bool may_hide = over_ground_ && eye_.above_m < kHigh_m;
  const std::vector<char> is_seen =
      may_hide ? NotHidden(chunks, eye) : std::vector<char>(chunks.size(), 1);
  for (std::size_t i = 0; i < in_view.size(); ++i)
    if (is_seen[i] != 0) drawn_.push_back(in_view[i]);
}

void Landscape::Update(const GeodeticPosition& eye, const LandView& view, double seconds) {
  ++frame_;
  eye_place_ = eye;
  view_ = view;
  if (mesh_) mesh_->Update(seconds);
  if (tiles_->tiles().empty()) return;
  eye_ = EyeAt(eye);
  FollowView(seconds);
  if (cache_.Update(eye_, detail_)) ++heights_version_;
  for (std::string& note : cache_.TakeNotes()) notes_.push_back(std::move(note));
  if (!set_) set_ = std::make_unique<ChunkSet>(AnchorAt(eye_place_), ExpectedChunks());
  TakeChunks();
  FindDemand(seconds);
  MoveAnchor();
  FinishLight(seconds);
  AskForChunks();
  AskForLight();
  Choose();
  RaiseAbove(seconds);
  Evict(*set_);
}

void Landscape::Settle(const GeodeticPosition& eye, const LandView& view) {
  constexpr double kLong_s = 1e3;
  // Far beside all land the ceiling and the chunks that it is taken from may take turns for ever.
  constexpr int kMostTurns = 20;
  int turns = 0;
  for (int still = 0; still < 3;) {
    ThrowIfInterrupted();
    const std::optional<double> ceiling = ceiling_m_;
    const std::size_t before = set_ ? set_->chunks.size() : 0;
    cache_.Wait();
    worker_.Wait();
    if (mesh_) mesh_->Wait();
    Update(eye, view, kLong_s);
    if (!set_) {
      still = mesh_ && (!mesh_->IsRead() || mesh_->IsRelighting()) ? 0 : still + 1;
      continue;
    }
    const bool all_there = set_->chunks.size() == before && !is_working_ &&
                           cache_.reading().empty() && !IsRelighting() && !next_set_;
    turns = all_there ? turns + 1 : 0;
    still = all_there && (ceiling == ceiling_m_ || turns > kMostTurns) ? still + 1 : 0;
  }
}

LandBlock Landscape::Block() const {
  LandBlock block = LandBlockOf(EyeInAnchor(set_->anchor.frame, eye_place_), view_, fading_);
  block.eye_sample =
      glm::vec4(glm::dvec4(eye_.at.column - set_->anchor.column, eye_.at.row - set_->anchor.row,
                           eye_.size.column_m, eye_.size.row_m));
  block.eye_above.x = static_cast<float>(eye_.above_m);
  for (std::size_t level = 0; level < ranges_.size(); ++level) {
    // Float's rounding must not leave a vertex on the line short of the end.
    const double end = 0.999 * ranges_[level].end_m;
    const double start = std::min(ranges_[level].start_m, 0.98 * end);
    block.turning[level] = end > 0.0 ? glm::vec4(glm::dvec4(start, 1.0 / (end - start), 0.0, 0.0))
                                     : glm::vec4(-1.0F, 1e9F, 0.0F, 0.0F);
  }
  return block;
}

void Landscape::Draw(GLuint view_binding) {
  LandPass::Clear();
  if (mesh_) mesh_->Draw(pass_, eye_place_, view_, view_binding);
  if (!set_ || drawn_.empty()) return;
  // Over the ground no slope that faces away is seen before one that faces the eye.
  pass_.Run(Block(), view_binding, over_ground_,
            [&] { set_->buffers.Draw(drawn_, Other(shown_)); });
}

std::optional<double> Landscape::GroundUnder(const GeodeticPosition& place) const {
  if (mesh_) return mesh_->GroundUnder(place);
  return cache_.loaded()->HeightUnder(place.latitude_rad, place.longitude_rad);
}

std::function<std::optional<ElevationGrid>(const GeodeticPosition&, double, int)>
Landscape::Sampler() const {
  if (mesh_) {
    return [mesh = &*mesh_](const GeodeticPosition& place, double half_width_m, int most_samples) {
      return mesh->SampledGrid(place, half_width_m, most_samples);
    };
  }
  return [loaded = cache_.loaded()](const GeodeticPosition& place, double half_width_m,
                                    int most_samples) {
    return loaded->SampledGrid(place, half_width_m, most_samples);
  };
}

LandProgress Landscape::Progress() const {
  if (mesh_ && !mesh_->IsRead())
    return {0.0,
            fmt::format("terrain: reading {}", tiles_->source().mesh->file.filename().string())};
  if (tiles_->tiles().empty() || !set_) return {};
  std::size_t there = 0;
  for (const WantedChunk& wanted : demand_.wanted)
    if (set_->chunks.contains(wanted.key)) ++there;
  const double tiles = static_cast<double>(cache_.there()) / std::max(cache_.wanted(), 1);
  const double chunks = static_cast<double>(there) /
                        static_cast<double>(std::max<std::size_t>(demand_.wanted.size(), 1));
  const double share = 0.5 * (tiles + chunks);
  if (!cache_.reading().empty())
    return {share, fmt::format("terrain: reading {} ({} of {})", cache_.reading(),
                               cache_.there() + 1, cache_.wanted())};
  // What no tile is kept fine enough for does not come.
  if (there == demand_.wanted.size() || !is_working_) return {};
  return {share, fmt::format("terrain: {} of {} pieces", there, demand_.wanted.size())};
}

std::vector<std::string> Landscape::TakeNotes() { return std::exchange(notes_, {}); }

LandFigures Landscape::Figures() const {
  LandFigures figures;
  figures.tile_bytes = cache_.bytes();
  if (mesh_) figures.card_bytes = mesh_->bytes();
  if (!set_) return figures;
  figures.chunks = static_cast<int>(drawn_.size());
  for (const auto& drawn : drawn_)
    figures.triangles += static_cast<int>(drawn.chunk->triangles.size() / 3);
  for (const ChunkSet* const set : {set_.get(), next_set_.get()}) {
    if (set == nullptr) continue;
    figures.kept_chunks += static_cast<int>(set->chunks.size());
    figures.card_bytes += set->buffers.bytes();
    for (const auto& [key, kept] : set->chunks) figures.chunk_bytes += BytesOf(*kept.chunk);
  }
  return figures;
}

}  // namespace alpenglow
