// SPDX-License-Identifier: MIT
// The chunks of a landscape: asked for, taken over, moved to another anchor.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "viewer/land/landscape.h"

namespace alpenglow::viewer {
namespace {

constexpr double kAnchorReach_m = 100e3;

}  // namespace

LandAnchor Landscape::AnchorAt(const GeodeticPosition& eye) const {
  const LandLattice& lattice = tiles_->lattice();
  const int column = std::clamp(static_cast<int>(eye_.at.column), 0, lattice.last_column);
  const int row = std::clamp(static_cast<int>(eye_.at.row), 0, lattice.last_row);
  return {LocalFrame(ellipsoid_, {eye.latitude_rad, eye.longitude_rad, 0.0}), column, row};
}

// Of each level a disk about the eye, at most all; and what is kept a while longer.
int Landscape::ExpectedChunks(double detail) const {
  const double radius = 1.25 * detail / kChunkCells + 2.0;
  double chunks = 0.0;
  for (int level = 0; level <= tree_.top(); ++level) {
    const double all =
        std::ceil(static_cast<double>(tiles_->lattice().LastI(level)) / kChunkCells) *
        std::ceil(static_cast<double>(tiles_->lattice().LastJ(level)) / kChunkCells);
    chunks += std::min(all, 3.2 * radius * radius);
  }
  return static_cast<int>(1.25 * chunks) + 64;
}

std::unique_ptr<ChunkSet> Landscape::NewSet() const {
  return std::make_unique<ChunkSet>(AnchorAt(eye_place_),
                                    std::min(ExpectedChunks(size_.detail), size_.most_chunks));
}

// A new set grows beside the old one and takes its place when it has all that is wanted.
void Landscape::MoveAnchor() {
  if (next_set_) {
    const bool has_all =
        std::all_of(demand_.wanted.begin(), demand_.wanted.end(), [&](const WantedChunk& wanted) {
          return !set_->Has(wanted.key) || next_set_->Has(wanted.key);
        });
    if (!has_all) return;
    set_ = std::move(next_set_);
    drawn_.clear();
    return;
  }
  GeodeticPosition foot = eye_place_;
  foot.height_m = 0.0;
  const double away = glm::length(set_->anchor().frame.EnuFromGeodetic(foot).xyz);
  if (away > kAnchorReach_m) next_set_ = NewSet();
}

void Landscape::TakeChunks() {
  const std::optional<MadeChunks> made = worker_.Take();
  if (!made) return;
  is_working_ = false;
  ChunkSet* const set = made->for_next_anchor ? next_set_.get() : set_.get();
  if (set == nullptr) return;
  set->Add(made->made, made->light_number, frame_);
  set->Relight(made->relit, fade_.from(), made->light_number);
}

std::vector<ChunkKey> Landscape::Missing(const ChunkSet& set) const {
  constexpr std::size_t kMost = 48;  // so that taking them does not hold up a frame
  std::vector<WantedChunk> missing;
  for (const WantedChunk& wanted : demand_.wanted)
    if (!set.Has(wanted.key)) missing.push_back(wanted);
  std::sort(missing.begin(), missing.end(),
            [](const WantedChunk& a, const WantedChunk& b) { return a.urgency < b.urgency; });
  std::vector<ChunkKey> keys;
  for (const WantedChunk& wanted : missing) {
    if (keys.size() == kMost) break;
    if (cache_.CanMake(wanted.key)) keys.push_back(wanted.key);
  }
  return keys;
}

void Landscape::Ask(const ChunkSet& set, std::vector<ChunkKey> make,
                    std::vector<std::shared_ptr<const LandChunk>> relight) {
  if (make.empty() && relight.empty()) return;
  worker_.Ask({cache_.loaded(), set.anchor(), std::move(make), std::move(relight), tree_.top(),
               fade_.light(), fade_.number(), &set == next_set_.get()});
  is_working_ = true;
}

void Landscape::AskForChunks() {
  for (const ChunkSet* const set : {set_.get(), next_set_.get()})
    if (!is_working_ && set != nullptr) Ask(*set, Missing(*set), {});
}

void Landscape::AskForLight() {
  if (!is_working_ && fade_.IsFilling()) Ask(*set_, {}, set_->NotLitBy(fade_.number()));
}

}  // namespace alpenglow::viewer
