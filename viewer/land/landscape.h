// SPDX-License-Identifier: MIT
// The land around the eye: read, cut into levels of detail, lit and drawn, all but the drawing on
// threads beside it.
//
// Every frame: Update, then Draw into a SurfaceMap. Near the eye stand the model's own samples, as
// in MeshFromElevation; the farther, the coarser (level_ranges.h). Without land it draws nothing.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "viewer/job/latest_job.h"
#include "viewer/land/chunk_set.h"
#include "viewer/land/land_pass.h"
#include "viewer/land/level_ranges.h"
#include "viewer/land/loaded_heights.h"
#include "viewer/land/mesh_land.h"
#include "viewer/land/tile_cache.h"

namespace alpenglow::viewer {

/// How much land is drawn and kept.
struct LandSize {
  static constexpr double kLeastDetail = 64.0, kMostDetail = 1024.0;
  /// Samples from the eye to where the second level begins. Triangles and chunks grow as its
  /// square: 1,300 chunks at 96, over a square of 3601 samples. A view narrower than 60 degrees has
  /// up to twice as much detail and one from high above up to three times, together `most_growth`
  /// times: as many triangles are seen. Pictures of several rays a pixel have the root of their number
  /// times as much. All this as far as `most_chunks` go.
  double detail = 96.0;
  double most_growth = 4.0;
  /// Of chunks that are kept, unless kLeastDetail takes more (2,500 at most). Beside heights they
  /// take 51 kB each, 13 in memory and 38 on the card, whose buffers have room for up to a quarter
  /// more: 2.4 GB. There are two sets of them for as long as it takes to make another about an eye
  /// that has flown 100 km.
  int most_chunks = 48000;
  /// Of heights that are kept [bytes], see TileCache.
  std::size_t most_bytes = std::size_t{512} << 20;
};

/// Figures of the last frame.
struct LandFigures {
  int chunks = 0, triangles = 0;  // drawn
  int kept_chunks = 0;
  std::size_t tile_bytes = 0, chunk_bytes = 0, card_bytes = 0;
};

/// How far loading is.
struct LandProgress {
  double share = 1.0;  // 1: all there
  std::string text;    // empty: nothing is being loaded
};

class Landscape {
 public:
  /// Reads headers of files, nothing else; throws InputError as LandTiles does, and for a detail
  /// out of range. An OpenGL context must be current, here and in all calls.
  Landscape(const LandSource& source, const LandSize& size, const Ellipsoid& ellipsoid);
  ~Landscape();
  Landscape(const Landscape&) = delete;
  Landscape& operator=(const Landscape&) = delete;

  /// Takes what has become ready, asks for what is missing, chooses what is drawn. Never waits.
  /// Throws InputError when a file that was named by itself turns out damaged.
  /// @param seconds  since the last call: what has come fades in.
  void Update(const GeodeticPosition& eye, const LandView& view, double seconds);
  /// Waits until all that is wanted for this eye is there and as it will stay.
  void Settle(const GeodeticPosition& eye, const LandView& view);
  /// Begins to read what lies around a place, before the first Update.
  void BeginReading(const GeodeticPosition& place);
  /// Waits until KnowsGround of a place.
  void AwaitGround(const GeodeticPosition& place);
  /// Draws what the last Update chose into the bound SurfaceMap, over what is in it. The uniform
  /// block View must be bound to `view_binding`.
  void Draw(GLuint view_binding);
  /// The same chunks once more, into the bound LandOutline: the view that was drawn last.
  void DrawOutline(GLuint view_binding);

  /// Lights all vertices anew by this function, beside drawing; the old light fades into the new
  /// when that is complete. Asked again meanwhile, it goes on with the newest after that.
  void Relight(LightOfVertices light);
  /// Whether new light is on its way or fading in.
  [[nodiscard]] bool IsRelighting() const;

  /// What stands before suns, and for which of them: see HorizonTexture.
  void Use(const TerrainHorizon& horizon) { pass_.Use(horizon); }
  void Use(const MomentaryEdges& edges) { pass_.Use(edges); }
  [[nodiscard]] bool HasHorizon() const { return pass_.HasHorizon(); }
  [[nodiscard]] EdgesOfVertices edges() const;

  /// Height of the ground [m] that an eye at a place is over, the same as is drawn near the eye;
  /// nothing where there is none or it is not loaded. Of a mesh with roofs it is the highest surface
  /// that is not above the place.
  [[nodiscard]] std::optional<double> GroundUnder(const GeodeticPosition& place) const;
  /// The highest there, whatever the height of the place.
  [[nodiscard]] std::optional<double> HighestGround(const GeodeticPosition& place) const;
  /// Whether GroundUnder has said its last word: all land that a place has is loaded.
  [[nodiscard]] bool KnowsGround(const GeodeticPosition& place) const;
  /// Whether any land reaches a place, loaded or not. A mesh reaches every place.
  [[nodiscard]] bool Reaches(const GeodeticPosition& place) const {
    return mesh_ || cache_.Reaches(place);
  }
  /// Whether threads beside drawing are at work, for which the destructor would wait.
  [[nodiscard]] bool IsWorking() const { return cache_.IsReading() || worker_.Busy(); }
  /// Whether the land about the eye of the last Update is there as fine as it will be, and lit; or
  /// the eye is beside all land.
  [[nodiscard]] bool HasCome() const;
  /// LoadedHeights::SampledGrid or GridOverMesh of what is loaded now, for any thread.
  [[nodiscard]] GroundSampler Sampler() const;
  /// Another range of the finest level, see LandSize.
  void SetDetail(double detail, double most_growth) {
    size_.detail = detail;
    size_.most_growth = most_growth;
    cache_.SetDetail(detail);
  }
  /// Counts up when heights have come: the Sampler may have changed.
  [[nodiscard]] int heights_version() const {
    return heights_version_ + (mesh_ && mesh_->IsRead() ? 1 : 0);
  }

  [[nodiscard]] LandProgress Progress() const;
  /// The warnings, each once: tiles left out, voids, vertical datums, statements of a mesh's file that
  /// are not read, and that the range is made up.
  [[nodiscard]] std::vector<std::string> TakeNotes();
  [[nodiscard]] LandFigures Figures() const;
  /// No land that is loaded about the eye, in view or not, is farther from it [m].
  [[nodiscard]] double farthest_m() const { return farthest_m_; }
  [[nodiscard]] const LandTiles& tiles() const { return *tiles_; }

 private:
  [[nodiscard]] LandEye EyeAt(const GeodeticPosition& eye) const;
  [[nodiscard]] LandAnchor AnchorAt(const GeodeticPosition& eye) const;
  [[nodiscard]] int ExpectedChunks(double detail) const;
  [[nodiscard]] std::unique_ptr<ChunkSet> NewSet() const;
  void MoveAnchor();
  void TakeChunks();
  void FollowView(double seconds);
  void FindDemand(double seconds);
  void LetLevelsReach(double seconds);
  void Ask(const ChunkSet& set, std::vector<ChunkKey> make,
           std::vector<std::shared_ptr<const LandChunk>> relight);
  void AskForChunks();
  void AskForLight();
  [[nodiscard]] std::vector<ChunkKey> Missing(const ChunkSet& set) const;
  /// All that a frame does but for choosing what of it is in view.
  void Advance(const GeodeticPosition& eye, const LandView& view, double seconds);
  void FindAround();
  void ChooseDrawn();
  void RaiseAbove(double seconds);
  void WaitForWork();
  [[nodiscard]] bool IsAllThere(std::size_t chunks_before) const;
  [[nodiscard]] LandBlock Block() const;
  void DrawAll(LandDrawn what, GLuint view_binding);

  std::shared_ptr<const LandTiles> tiles_;
  LandSize size_;
  double detail_;  // for the view
  Ellipsoid ellipsoid_;
  ChunkTree tree_;
  TileCache cache_;
  GeodeticPosition eye_place_;
  LandEye eye_;
  LandView view_;
  bool over_ground_ = false;
  std::optional<double> ceiling_m_;  // of the ground about the eye, over the ellipsoid
  std::unique_ptr<ChunkSet> set_, next_set_;
  LandDemand demand_;
  std::vector<double> reach_m_;
  std::vector<LevelRange> ranges_;
  std::vector<DrawnChunk> around_;          // in view or not
  std::vector<ChunkBuffers::Drawn> drawn_;  // in view
  double farthest_m_ = 0.0;
  LightFade fade_;
  long frame_ = 0;
  int heights_version_ = 0;
  bool is_working_ = false;
  std::vector<std::string> notes_;
  LandPass pass_;
  std::optional<MeshLand> mesh_;              // instead of tiles
  LatestJob<ChunkOrder, MadeChunks> worker_;  // last: it uses all above
};

}  // namespace alpenglow::viewer
