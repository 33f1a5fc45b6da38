// SPDX-License-Identifier: MIT
// What is asked of a landscape: heights, how far loading is, figures.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "viewer/land/landscape.h"

namespace alpenglow::viewer {

std::optional<double> Landscape::GroundUnder(const GeodeticPosition& place) const {
  if (mesh_) return mesh_->GroundUnder(place);
  return cache_.loaded()->HeightUnder(place.latitude_rad, place.longitude_rad);
}

std::optional<double> Landscape::HighestGround(const GeodeticPosition& place) const {
  return mesh_ ? mesh_->HighestGround(place) : GroundUnder(place);
}

bool Landscape::KnowsGround(const GeodeticPosition& place) const {
  return mesh_ ? mesh_->IsRead() : cache_.HasRead(place);
}

bool Landscape::HasCome() const {
  constexpr double kAbout_m = 3000.0;
  if (mesh_) return mesh_->IsRead();
  if (tiles_->tiles().empty()) return true;
  if (!set_ || !KnowsGround(eye_place_)) return false;
  if (!GroundUnder(eye_place_)) return true;
  if (!fade_.HasShown()) return false;
  const std::vector<ChunkKey> roots = tree_.Roots(eye_);
  const bool has_roots = std::all_of(roots.begin(), roots.end(), [&](const ChunkKey& root) {
    return set_->Has(root) || ChunkTree::Distance(root, eye_) > kAbout_m;
  });
  double full_m = detail_ * std::sqrt(eye_.size.column_m * eye_.size.row_m);
  for (const double reach_m : reach_m_) {
    if (reach_m < std::min(0.99 * full_m, kAbout_m)) return false;
    full_m *= 2.0;
  }
  return has_roots;
}

GroundSampler Landscape::Sampler() const {
  if (mesh_) return mesh_->Sampler();
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
    if (set_->Has(wanted.key)) ++there;
  const double tiles = static_cast<double>(cache_.there()) / std::max(cache_.wanted(), 1);
  const double chunks = static_cast<double>(there) /
                        static_cast<double>(std::max<std::size_t>(demand_.wanted.size(), 1));
  const double share = 0.5 * (tiles + chunks);
  if (!cache_.reading().empty() && tiles_->source().files.empty())
    return {share, "terrain: making the mountains of this place"};
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
    figures.kept_chunks += static_cast<int>(set->size());
    figures.card_bytes += set->card_bytes();
    figures.chunk_bytes += set->bytes();
  }
  return figures;
}

}  // namespace alpenglow::viewer
