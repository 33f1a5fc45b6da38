// SPDX-License-Identifier: MIT
// The terrain around the eye: read, divided into levels of detail, lit and drawn. Everything except
// drawing runs on worker threads.
//
// Every frame, call Update, then Draw into a GBuffer. Near the eye the surface has the samples
// of the elevation model, as in MeshFromElevation; farther away it becomes coarser
// (level_ranges.h). Without land, nothing is drawn.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "atmosphere/base/async_value.h"
#include "renderer/terrain/level_ranges.h"
#include "renderer/terrain/loaded_heights.h"
#include "renderer/terrain/tile_cache.h"
#include "viewer/land/chunk_set.h"
#include "viewer/land/land_choice.h"
#include "viewer/land/land_pass.h"
#include "viewer/land/mesh_land.h"

namespace alpenglow::viewer {

/// Limits of the terrain that is drawn and kept in memory.
struct LandSize {
  static constexpr double kLeastDetail = 64.0, kMostDetail = 1024.0;
  /// Distance from the eye to the second level, in samples. The numbers of triangles and chunks
  /// grow as its square: 1,300 chunks at 96, over a square of 3601 samples. A view narrower than 60
  /// degrees has up to twice as much detail and a view from high above up to three times, together
  /// at most `most_growth` times: the number of visible triangles stays about the same. For
  /// pictures with several rays per pixel the detail is multiplied by the square root of their
  /// number. All this is limited by `most_chunks`.
  double detail = 96.0;
  double most_growth = 4.0;
  /// Largest number of chunks that are kept, unless kLeastDetail needs more (2,500 at most). In
  /// addition to the heights a chunk takes 51 kB, 13 in memory and 38 on the GPU, where buffers may
  /// be up to a quarter larger: 2.4 GB. There are two sets of chunks while a new set is made around
  /// an eye that has flown 100 km.
  int most_chunks = 48000;
  /// Size of the heights that are kept [bytes], see TileCache.
  std::size_t most_bytes = std::size_t{512} << 20;
};

/// Statistics of the last frame.
struct LandFigures {
  int chunks = 0, triangles = 0;  // drawn
  int kept_chunks = 0;
  std::size_t tile_bytes = 0, chunk_bytes = 0, card_bytes = 0;
};

/// Progress of loading.
struct LandProgress {
  double share = 1.0;  // 1: complete
  std::string text;    // empty if nothing is being loaded
};

/// The ground of the land that is loaded.
class LandGround {
 public:
  /// Keeps references to both; the mesh stands instead of tiles.
  LandGround(const TileCache& cache, const std::optional<MeshLand>& mesh)
      : cache_(cache), mesh_(mesh) {}

  /// Returns the height of the ground [m] under an eye at a place, equal to the surface drawn near
  /// the eye. Empty if there is no ground or it is not loaded. For a mesh with roofs this is the
  /// highest surface that is not above the place.
  [[nodiscard]] std::optional<double> HeightUnder(const Place& place) const;
  /// Returns the height of the highest surface at a place, independent of the place's own height.
  [[nodiscard]] std::optional<double> HighestAt(const Place& place) const;
  /// Returns whether the result of HeightUnder is final: all land at a place is loaded.
  [[nodiscard]] bool IsKnownAt(const Place& place) const;
  /// Returns whether any land covers a place, loaded or not. A mesh covers every place.
  [[nodiscard]] bool Reaches(const Place& place) const { return mesh_ || cache_.Reaches(place); }
  /// Returns LoadedHeights::SampledGrid or GridOverMesh of the heights loaded now, callable on any
  /// thread.
  [[nodiscard]] GroundSampler Sampler() const;
  /// Increases when heights have been loaded: then the Sampler may have changed.
  [[nodiscard]] int version() const { return version_ + (mesh_ && mesh_->IsRead() ? 1 : 0); }
  /// Counts a change of the heights in the cache.
  void CountChange() { ++version_; }

 private:
  const TileCache& cache_;
  const std::optional<MeshLand>& mesh_;
  int version_ = 0;
};

class Landscape {
 public:
  /// Reads only the headers of files. Throws InputError as LandTiles does, and if the detail is out
  /// of range. An OpenGL context must be current, here and in all calls.
  Landscape(const LandSource& source, const LandSize& size, const Ellipsoid& ellipsoid);
  ~Landscape();
  Landscape(const Landscape&) = delete;
  Landscape& operator=(const Landscape&) = delete;

  /// Collects finished work, requests what is missing, and begins to choose the chunks to draw.
  /// Never waits. Throws InputError if a file that was named explicitly turns out to be damaged.
  /// @param seconds  time since the last call, by which new levels and lights fade in.
  void Update(const Place& eye, const LandView& view, double seconds);
  /// Waits until everything that this eye needs is loaded and no longer changes.
  void WaitUntilReady(const Place& eye, const LandView& view);
  /// Starts to read the tiles around a place, before the first Update.
  void BeginReading(const Place& place);
  /// Waits until the ground at a place is known.
  void AwaitGround(const Place& place);
  /// Draws the chunks that the last Update chose, with its view, into the bound GBuffer or
  /// DepthPrepass, which is cleared first. The uniform block View must be bound to `view_binding`.
  /// @param narrower  another view, which that block has: only chunks that may be in it are drawn.
  void Draw(LandDrawn what, GLuint view_binding, const LandLook& look = {},
            const std::optional<ViewAxes>& narrower = {});
  /// Returns the programs that draw.
  [[nodiscard]] LandPass& pass() { return pass_; }

  /// Relights all vertices with this function on a worker thread. When the new light is complete,
  /// the old one fades into it. If called again meanwhile, the most recent light follows.
  void Relight(LightOfVertices light);
  /// Returns whether a new light is being computed or is fading in.
  [[nodiscard]] bool IsRelighting() const;

  /// Terrain horizons, and the sun that they are evaluated for: see HorizonTexture.
  void Use(const TerrainHorizon& horizon) { pass_.Use(horizon); }
  void Use(const MomentaryEdges& edges) { pass_.Use(edges); }
  [[nodiscard]] EdgesOfVertices edges() const;

  [[nodiscard]] const LandGround& ground() const { return ground_; }
  /// Returns whether worker threads are busy. The destructor waits for them.
  [[nodiscard]] bool IsWorking() const { return cache_.IsReading() || worker_.IsBusy(); }
  /// Returns whether the land around the eye of the last Update has its final detail and is lit, or
  /// there is no land under the eye.
  [[nodiscard]] bool HasCome() const;
  /// Changes the range of the finest level, see LandSize.
  void SetDetail(double detail, double most_growth) {
    size_.detail = detail;
    size_.most_growth = most_growth;
    cache_.SetDetail(detail);
  }
  [[nodiscard]] LandProgress Progress() const;
  /// Returns the warnings, each once: tiles that were left out, voids, vertical datums, statements
  /// in a mesh file that are not supported, and the fact that the range is procedural.
  [[nodiscard]] std::vector<std::string> PollNotes();
  [[nodiscard]] LandFigures Figures() const;
  /// Upper bound for the distance [m] from the eye to loaded land around it, in view or not.
  [[nodiscard]] double farthest_m() const;
  [[nodiscard]] const LandTiles& tiles() const { return *tiles_; }

 private:
  [[nodiscard]] LandEye EyeAt(const Place& eye) const;
  [[nodiscard]] LandAnchor AnchorAt(const Place& eye) const;
  [[nodiscard]] int ExpectedChunks(double detail) const;
  [[nodiscard]] std::unique_ptr<ChunkSet> NewSet() const;
  void MoveAnchor();
  void PollChunks();
  void FollowView(double seconds);
  void Request(const ChunkSet& set, std::vector<ChunkKey> make,
               std::vector<std::shared_ptr<const LandChunk>> relight);
  void RequestChunks();
  void RequestLight();
  [[nodiscard]] std::vector<ChunkKey> Missing(const ChunkSet& set) const;
  /// Begins the choice of the chunks to draw. Set and tree must not be used until Choice().
  void Choose(double seconds);
  [[nodiscard]] std::vector<SeenChunk> DrawnIn(const ViewAxes& narrower) const;
  /// Waits for the choice, and returns it.
  const LandChoice& Choice() const;
  void WaitForWork();
  [[nodiscard]] bool IsAllThere(std::size_t chunks_before) const;
  [[nodiscard]] LandBlock Block() const;

  std::shared_ptr<const LandTiles> tiles_;
  LandSize size_;
  double detail_;  // for the current view
  Ellipsoid ellipsoid_;
  ChunkTree tree_;
  TileCache cache_;
  Place eye_place_;
  LandEye eye_;
  LandView view_;
  bool over_ground_ = false;
  std::unique_ptr<ChunkSet> set_, next_set_;
  mutable LandChoice choice_;  // the newest that Choice() has returned
  LightFade fade_;
  long frame_ = 0;
  bool is_working_ = false;
  std::vector<std::string> notes_;
  LandPass pass_;
  std::optional<MeshLand> mesh_;  // instead of tiles
  LandGround ground_{cache_, mesh_};
  // Last members: their threads use those above.
  AsyncValue<ChunkOrder, MadeChunks> worker_;
  mutable AsyncValue<LandChoiceOrder, LandChoice> chooser_;
};

}  // namespace alpenglow::viewer
