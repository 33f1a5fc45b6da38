// SPDX-License-Identifier: MIT
// Selection, morphing, loading and drawing of the terrain chunks around the eye.
#include "viewer/land/landscape.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "lut/cli/program.h"

namespace alpenglow::viewer {
namespace {

constexpr double kAnchorReach_m = 100e3;

}  // namespace

Landscape::Landscape(const LandSource& source, const LandSize& size, const Ellipsoid& ellipsoid)
    : tiles_(std::make_shared<const LandTiles>(source)),
      size_(size),
      detail_(size.detail),
      ellipsoid_(ellipsoid),
      tree_(*tiles_),
      cache_(tiles_, tree_, size.most_bytes),
      worker_(MakeChunks),
      chooser_(ChooseLand) {
  RequireInRange(size.detail, LandSize::kLeastDetail, LandSize::kMostDetail,
                 "the detail of the land");
  if (source.mesh) {
    mesh_.emplace(*source.mesh, ellipsoid);
  } else if (source.files.empty() && source.range_centre) {
    notes_.emplace_back("the terrain is made up: no elevation model of the place was named");
  }
}

Landscape::~Landscape() = default;

const LandChoice& Landscape::Choice() const {
  chooser_.Wait();
  if (std::optional<LandChoice> made = chooser_.Poll()) choice_ = std::move(*made);
  return choice_;
}

LandEye Landscape::EyeAt(const Place& eye) const {
  return {tiles_->lattice(), eye, std::max(eye.height_m - Choice().ceiling_m.value_or(0.0), 0.0),
          SightFrom(eye.height_m)};
}

// Adapts the detail gradually, so that a zoom does not pop. From high above less land is near, so
// more detail is affordable.
void Landscape::FollowView(double seconds) {
  constexpr double kTime_s = 0.5;
  const double usual = std::tan(kPi / 6.0);
  const double by_lens = std::clamp(std::sqrt(usual / glm::length(view_.axes.right)), 1.0, 2.0);
  const double first_m = size_.detail * std::sqrt(eye_.size.column_m * eye_.size.row_m);
  const double by_height =
      std::clamp(1.0 + 0.35 * std::log2(std::max(eye_.above_m, 1.0) / first_m), 1.0, 3.0);
  double wanted =
      size_.detail * std::min(by_lens * by_height, size_.most_growth) * std::sqrt(view_.rays);
  while (wanted > LandSize::kLeastDetail && ExpectedChunks(wanted) > size_.most_chunks)
    wanted = std::max(0.95 * wanted, LandSize::kLeastDetail);
  detail_ = wanted + (detail_ - wanted) * std::exp(-seconds / kTime_s);
}

void Landscape::Relight(LightOfVertices light) {
  if (mesh_) return mesh_->Relight(std::move(light));
  fade_.Request(std::move(light));
}

EdgesOfVertices Landscape::edges() const { return mesh_ ? mesh_->edges() : fade_.edges(); }

bool Landscape::IsRelighting() const { return mesh_ ? mesh_->IsRelighting() : fade_.IsChanging(); }

void Landscape::Choose(double seconds) {
  const std::optional<double> ground = ground_.HeightUnder(eye_place_);
  over_ground_ = ground && eye_place_.height_m > *ground;
  chooser_.Request({&tree_, set_.get(), ellipsoid_, eye_place_, eye_, view_, detail_, over_ground_,
                    choice_.reach_m, choice_.ceiling_m, seconds});
}

double Landscape::farthest_m() const {
  if (set_) return Choice().farthest_m;
  return mesh_ ? SightFrom(eye_place_.height_m) : 0.0;
}

void Landscape::BeginReading(const Place& place) {
  if (!tiles_->tiles().empty() && cache_.Update(EyeAt(place), detail_)) ground_.CountChange();
}

void Landscape::AwaitGround(const Place& place) {
  if (mesh_) {
    mesh_->Wait();
    mesh_->Update(0.0);
  }
  while (!ground_.IsKnownAt(place)) {
    ThrowIfInterrupted();
    BeginReading(place);
    cache_.Wait();
    BeginReading(place);
  }
}

void Landscape::Update(const Place& eye, const LandView& view, double seconds) {
  ++frame_;
  eye_place_ = eye;
  view_ = view;
  if (mesh_) {
    mesh_->Update(seconds);
    for (std::string& note : mesh_->PollNotes()) notes_.push_back(std::move(note));
  }
  if (tiles_->tiles().empty()) return;
  eye_ = EyeAt(eye);
  FollowView(seconds);
  if (cache_.Update(eye_, detail_)) ground_.CountChange();
  for (std::string& note : cache_.PollNotes()) notes_.push_back(std::move(note));
  if (!set_) set_ = NewSet();
  PollChunks();
  set_->RecordWanted(choice_.demand.wanted, frame_);
  MoveAnchor();
  fade_.Advance(seconds, set_->IsLitBy(fade_.number()));
  RequestChunks();
  RequestLight();
  set_->Evict(choice_.demand.wanted.size() + choice_.demand.wanted.size() / 4 + 64, frame_);
  Choose(seconds);
}

void Landscape::WaitForWork() {
  cache_.Wait();
  worker_.Wait();
  if (mesh_) mesh_->Wait();
}

bool Landscape::IsAllThere(std::size_t chunks_before) const {
  if (mesh_) return mesh_->IsRead() && !mesh_->IsRelighting();
  if (!set_) return true;  // there is no land
  return set_->size() == chunks_before && !is_working_ && cache_.reading().empty() &&
         !fade_.IsChanging() && !next_set_;
}

// Once everything is loaded, each ceiling follows from the previous one, so the sequence of
// ceilings becomes periodic. It need not converge: coarse land may be higher than the fine land
// that replaces it, so that the two ceilings alternate. The lowest ceiling of the cycle is then
// kept.
void Landscape::WaitUntilReady(const Place& eye, const LandView& view) {
  constexpr double kLong_s = 1e3;
  std::vector<std::optional<double>> ceilings;
  for (int still = 0; still < 3;) {
    ThrowIfInterrupted();
    const std::size_t chunks = set_ ? set_->size() : 0;
    ceilings.push_back(Choice().ceiling_m);
    WaitForWork();
    Update(eye, view, kLong_s);
    const auto round = std::find(ceilings.begin(), ceilings.end(), Choice().ceiling_m);
    if (!IsAllThere(chunks)) {
      still = 0;
      ceilings.clear();
    } else if (round != ceilings.end()) {
      still += ceilings.back() == *std::min_element(round, ceilings.end()) ? 1 : 0;
    }
  }
}

LandBlock Landscape::Block() const {
  LandBlock block = LandBlockOf(set_->anchor().frame, eye_place_, fade_.share());
  const LandLattice& lattice = tiles_->lattice();
  block.eye_sample =
      glm::vec4(glm::dvec4(eye_.at.column - set_->anchor().column, eye_.at.row - set_->anchor().row,
                           eye_.step_lon_rad, eye_.step_lat_rad));
  block.globe = glm::vec4(glm::dvec4(std::sin(eye_.latitude_rad), std::cos(eye_.latitude_rad),
                                     eye_.radius_m(),
                                     lattice.ClosesAroundTheEarth() ? lattice.last_column : 0.0));
  block.eye_above.x = static_cast<float>(eye_.above_m);
  const std::vector<LevelRange>& ranges = Choice().ranges;
  for (std::size_t level = 0; level < ranges.size(); ++level) {
    // Rounding to float must not leave a vertex at the end of the range with a weight below 1.
    const double end = 0.999 * ranges[level].end_m;
    const double start = std::min(ranges[level].start_m, 0.98 * end);
    block.turning[level] = end > 0.0 ? glm::vec4(glm::dvec4(start, 1.0 / (end - start), 0.0, 0.0))
                                     : glm::vec4(-1.0F, 1e9F, 0.0F, 0.0F);
  }
  return block;
}

std::vector<SeenChunk> Landscape::DrawnIn(const ViewAxes& narrower) const {
  LandView view = view_;
  view.axes = narrower;
  const FrameTransform eye(set_->anchor().frame, LocalFrame(ellipsoid_, eye_place_));
  return InView(Choice().drawn, eye, view);
}

void Landscape::Draw(LandDrawn what, GLuint view_binding, const LandLook& look,
                     const std::optional<ViewAxes>& narrower) {
  LandPass::Clear(what);
  if (mesh_) mesh_->Draw(pass_, what, look, eye_place_, view_binding);
  if (!set_) return;
  const std::vector<SeenChunk> fewer = narrower ? DrawnIn(*narrower) : std::vector<SeenChunk>{};
  const std::vector<SeenChunk>& drawn = narrower ? fewer : Choice().drawn;
  if (drawn.empty()) return;
  pass_.Use(fade_.edges());
  // Seen from above the ground, back faces are always hidden, so they can be culled.
  pass_.Run(what, look, Block(), set_->anchor().frame, view_binding, over_ground_,
            [&] { set_->Draw(drawn, fade_.from()); });
}

std::optional<double> LandGround::HeightUnder(const Place& place) const {
  if (mesh_) return mesh_->GroundUnder(place);
  return cache_.loaded()->HeightUnder(place.latitude_rad(), place.longitude_rad());
}

std::optional<double> LandGround::HighestAt(const Place& place) const {
  return mesh_ ? mesh_->HighestGround(place) : HeightUnder(place);
}

bool LandGround::IsKnownAt(const Place& place) const {
  return mesh_ ? mesh_->IsRead() : cache_.HasRead(place);
}

bool Landscape::HasCome() const {
  constexpr double kAbout_m = 3000.0;
  if (mesh_) return mesh_->IsRead();
  if (tiles_->tiles().empty()) return true;
  if (!set_ || !ground_.IsKnownAt(eye_place_)) return false;
  if (!ground_.HeightUnder(eye_place_)) return true;
  if (!fade_.HasShown()) return false;
  const LandChoice& choice = Choice();  // afterwards no other thread uses the tree
  const std::vector<ChunkKey> roots = tree_.Roots(eye_);
  const bool has_roots = std::all_of(roots.begin(), roots.end(), [&](const ChunkKey& root) {
    return set_->Has(root) || ChunkTree::Distance(root, eye_) > kAbout_m;
  });
  double full_m = detail_ * std::sqrt(eye_.size.column_m * eye_.size.row_m);
  for (const double reach_m : choice.reach_m) {
    if (reach_m < std::min(0.99 * full_m, kAbout_m)) return false;
    full_m *= 2.0;
  }
  return has_roots;
}

GroundSampler LandGround::Sampler() const {
  if (mesh_) return mesh_->Sampler();
  return [loaded = cache_.loaded()](const Place& place, double half_width_m, int most_samples) {
    return loaded->SampledGrid(place, half_width_m, most_samples);
  };
}

LandProgress Landscape::Progress() const {
  if (mesh_ && !mesh_->IsRead())
    return {0.0,
            fmt::format("terrain: reading {}", tiles_->source().mesh->file.filename().string())};
  if (tiles_->tiles().empty() || !set_) return {};
  std::size_t there = 0;
  for (const WantedChunk& wanted : choice_.demand.wanted)
    if (set_->Has(wanted.key)) ++there;
  const double tiles = static_cast<double>(cache_.there()) / std::max(cache_.wanted(), 1);
  const double chunks = static_cast<double>(there) /
                        static_cast<double>(std::max<std::size_t>(choice_.demand.wanted.size(), 1));
  const double share = 0.5 * (tiles + chunks);
  if (!cache_.reading().empty() && tiles_->source().files.empty())
    return {share, "terrain: making the mountains of this place"};
  if (!cache_.reading().empty())
    return {share, fmt::format("terrain: reading {} ({} of {})", cache_.reading(),
                               cache_.there() + 1, cache_.wanted())};
  // Chunks for which no tile is kept fine enough never arrive, so they do not count as loading.
  if (there == choice_.demand.wanted.size() || !is_working_) return {};
  return {share, fmt::format("terrain: {} of {} pieces", there, choice_.demand.wanted.size())};
}

std::vector<std::string> Landscape::PollNotes() { return std::exchange(notes_, {}); }

LandFigures Landscape::Figures() const {
  LandFigures figures;
  figures.tile_bytes = cache_.bytes();
  if (mesh_) figures.card_bytes = mesh_->bytes();
  if (!set_) return figures;
  figures.chunks = static_cast<int>(Choice().drawn.size());
  for (const auto& drawn : choice_.drawn)
    figures.triangles += static_cast<int>(drawn.chunk->triangles.size() / 3);
  for (const ChunkSet* const set : {set_.get(), next_set_.get()}) {
    if (set == nullptr) continue;
    figures.kept_chunks += static_cast<int>(set->size());
    figures.card_bytes += set->card_bytes();
    figures.chunk_bytes += set->bytes();
  }
  return figures;
}

LandAnchor Landscape::AnchorAt(const Place& eye) const {
  const LandLattice& lattice = tiles_->lattice();
  const int column = std::clamp(static_cast<int>(eye_.at.column), 0, lattice.last_column);
  const int row = std::clamp(static_cast<int>(eye_.at.row), 0, lattice.last_row);
  return {LocalFrame(ellipsoid_, {eye.latitude_deg, eye.longitude_deg, 0.0}), column, row};
}

// Estimates the number of chunks: for each level a disk around the eye, at most the whole level,
// and chunks that are kept for some time after their last use.
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

// Builds a new set next to the old one. The new set replaces it when it has all wanted chunks.
void Landscape::MoveAnchor() {
  if (next_set_) {
    const bool has_all = std::all_of(choice_.demand.wanted.begin(), choice_.demand.wanted.end(),
                                     [&](const WantedChunk& wanted) {
                                       return !set_->Has(wanted.key) || next_set_->Has(wanted.key);
                                     });
    if (!has_all) return;
    set_ = std::move(next_set_);
    choice_.drawn.clear();
    return;
  }
  Place foot = eye_place_;
  foot.height_m = 0.0;
  const double away = glm::length(set_->anchor().frame.EnuFromGeodetic(foot).xyz);
  if (away > kAnchorReach_m) next_set_ = NewSet();
}

void Landscape::PollChunks() {
  const std::optional<MadeChunks> made = worker_.Poll();
  if (!made) return;
  is_working_ = false;
  ChunkSet* const set = made->for_next_anchor ? next_set_.get() : set_.get();
  if (set == nullptr) return;
  set->Add(made->made, made->light_number, frame_);
  set->Relight(made->relit, fade_.from(), made->light_number);
}

std::vector<ChunkKey> Landscape::Missing(const ChunkSet& set) const {
  constexpr std::size_t kMost = 48;  // limits the time that a frame spends on uploading
  std::vector<WantedChunk> missing;
  for (const WantedChunk& wanted : choice_.demand.wanted)
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

void Landscape::Request(const ChunkSet& set, std::vector<ChunkKey> make,
                        std::vector<std::shared_ptr<const LandChunk>> relight) {
  if (make.empty() && relight.empty()) return;
  if (fade_.HasShown()) worker_.GiveWay();
  worker_.Request({cache_.loaded(), set.anchor(), std::move(make), std::move(relight), tree_.top(),
                   fade_.light(), fade_.number(), &set == next_set_.get()});
  is_working_ = true;
}

void Landscape::RequestChunks() {
  for (const ChunkSet* const set : {set_.get(), next_set_.get()})
    if (!is_working_ && set != nullptr) Request(*set, Missing(*set), {});
}

void Landscape::RequestLight() {
  if (!is_working_ && fade_.IsFilling()) Request(*set_, {}, set_->NotLitBy(fade_.number()));
}

}  // namespace alpenglow::viewer
