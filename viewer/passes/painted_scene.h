// SPDX-License-Identifier: MIT
// A scene prepared for drawing: its medium, terrain, terrain lighting, volumetric shadows and media.
// Each part is computed on worker threads and follows the moving eye and sun.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "atmosphere/astronomy/sun.h"
#include "renderer/illumination/sky_irradiance_gradient.h"
#include "renderer/lit_ground/ground_follower.h"
#include "renderer/scene/scene.h"
#include "renderer/surface/scene_ground.h"
#include "renderer/surface/surface.h"
#include "viewer/air/air_follower.h"
#include "viewer/clouds/cloud_follower.h"
#include "viewer/ground/ground_block.h"
#include "viewer/ground/open_sky_follower.h"
#include "viewer/land/landscape.h"
#include "viewer/media/scene_media.h"
#include "viewer/passes/auto_quality.h"
#include "viewer/passes/frame_sky.h"
#include "viewer/passes/painted_view.h"
#include "viewer/shade/shafts.h"

namespace alpenglow::viewer {

/// The solved medium of a scene, prepared before the PaintedScene: a draft for an early first frame,
/// or a full solution that scenes share. Null: PaintedScene solves it at full accuracy.
using FirstAir = std::shared_ptr<const TabulatedAir>;
/// Returns a draft solution. Throws for a medium as the constructor of PaintedScene does.
[[nodiscard]] FirstAir DraftOfAir(const Scene& scene);
[[nodiscard]] inline bool IsDraft(const FirstAir& air) {
  return air && air->air.solution() == AirSolution::kDraft;
}

/// The parts of a scene that do not change during a flight.
struct FixedScene {
  /// @param has_land  whether the scene has land anywhere.
  FixedScene(const Scene& scene, bool has_land);

  Place place;
  Ellipsoid ellipsoid;
  SceneGround lamp_ground;  // on which lamps and media are placed
  SceneDrape drape;
  GroundMaterial material;
  LandKind land_kind;
};

/// All parts of a scene that are needed to draw it. Must be used on the thread whose OpenGL context
/// is current at construction.
class PaintedScene {
 public:
  /// If the medium is a draft, it is solved at full accuracy on a worker thread, and land is read
  /// on another. Throws InputError for a medium with more than four wavelengths and for explicitly
  /// named land that cannot be read.
  PaintedScene(const Scene& scene, const LandSource& land, const PaintedView& first,
               const PaintSizes& sizes, FirstAir first_air);

  void Use(const PaintSizes& sizes);
  /// Changes the medium, the land or the clouds. A new medium is shown when it is solved, and new clouds
  /// fade in when they are made. The previous land, its lighting and its shadows disappear immediately;
  /// the new land is of the same kind.
  template <typename Part>
  void Replace(const Part& part) {
    Take(part);
  }

  /// Shows no land until the land around the eye is loaded.
  void AwaitLand() { awaits_land_ = true; }
  /// Returns whether land is not shown yet, at the start and after a change of place. Only sky is
  /// drawn then.
  [[nodiscard]] bool AwaitsLand() const { return awaits_land_; }

  /// Collects finished work and requests missing parts. It does not wait, except for the first
  /// light of media in new air or under a moon.
  /// @param lights   as seen from the eye.
  /// @param seconds  time since the last call.
  void Update(const PaintedView& view, const FrameSky& sky, double seconds);
  /// Waits until everything that the view needs is complete.
  /// @param samples  number of rays per pixel to be drawn.
  void WaitUntilReady(const PaintedView& view, const LightsOfSky& lights, int samples);

  [[nodiscard]] const PaintSizes& sizes() const { return sizes_; }
  [[nodiscard]] const FixedScene& fixed() const { return fixed_; }
  /// The medium lit by the sun.
  [[nodiscard]] const AirFollower& air() const { return air_; }
  /// The textures of the medium lit by a source, which must be one of the lights.
  [[nodiscard]] const AirTextures& air_textures(LightSource source) const {
    return source == LightSource::kMoon && moon_air_ ? moon_air_->textures() : air_.textures();
  }
  [[nodiscard]] const Landscape& land() const { return *land_; }
  [[nodiscard]] Landscape& land() { return *land_; }
  [[nodiscard]] const GroundFollower& ground() const { return ground_; }
  /// Directional variation of the unoccluded sky's irradiance under a source, which must be one of
  /// the lights, at the instant of the last Update or WaitUntilReady.
  [[nodiscard]] const SkyIrradianceGradient& UnoccludedSkyIrradiance(LightSource source) const {
    return open_skies_[IndexOf(source)].light();
  }
  [[nodiscard]] const GroundTextures& ground_textures() const { return ground_textures_; }
  /// Returns the tables of the surroundings, for the light of the sky on each pixel (at a quality
  /// with PaintSizes::sky_by_pixel) and for what the ground mirrors; null if nothing needs them, or
  /// until they are ready.
  [[nodiscard]] const SkyByPixel* sky_by_pixel(LightSource source) const {
    return sky_by_pixel_.Has(source) ? &sky_by_pixel_ : nullptr;
  }
  [[nodiscard]] const ShadeFollower& shade() const { return shade_; }
  /// Returns whether all shadow edges on land belong to this source.
  [[nodiscard]] bool HasEdgesOf(LightSource source) const {
    return source == casts_ && (momentary_edges_ == 1.0 ? land_->pass().HasHorizon() : has_edges_);
  }
  [[nodiscard]] const SceneMedia& media() const { return media_; }
  [[nodiscard]] const CloudFollower& clouds() const { return clouds_; }

 private:
  void Take(const Medium& medium) { air_.Replace(medium); }
  void Take(const LandSource& land);
  void Take(const std::vector<SceneCloud>& clouds) {
    clouds_.Use(clouds, land_->ground().HeightUnder(clouds_.place()).value_or(0.0));
  }
  /// Followers either do their work in the background (Update) or complete it (WaitUntilReady).
  enum class Pace { kFollow, kWait };
  void KeepUpAir(const PaintedView& view, const LightsOfSky& lights, Pace pace, double seconds);
  void KeepUpOpenSkies(const LightsOfSky& lights, Pace pace);
  [[nodiscard]] bool HasEdgesNear(const Vector<Ecef>& to_light) const;
  void KeepUpEdges(const PaintedView& view, const DistantLight& key, double seconds);
  void KeepUpMedia(const PaintedView& view, const LightsOfSky& lights, Pace pace);
  void UpdateHeights();
  void UpdateLight();
  void TakeSkyByPixel();

  FixedScene fixed_;
  PaintSizes sizes_;
  Place sunlit_place_;                          // of the last eye for which the sun was a light
  DistantLight sun_;                            // as it was then
  AirFollower air_;                             // of that eye under that sun
  std::shared_ptr<const SolvedAir> known_air_;  // the medium in ground_textures_
  std::shared_ptr<const SolvedAir> air_here_;   // known_air_ on the sphere of the eye
  std::array<OpenSkyFollower, kLightSources> open_skies_;
  std::optional<AirFollower> moon_air_;           // once the moon is a light
  std::shared_ptr<const SolvedAir> moon_air_of_;  // the medium of moon_air_
  std::unique_ptr<Landscape> land_;
  std::vector<std::unique_ptr<Landscape>> leaving_;  // until their threads have ended
  GroundFollower ground_;
  GroundTextures ground_textures_;
  SkyByPixel sky_by_pixel_;
  ShadeFollower shade_;
  SceneMedia media_;
  CloudFollower clouds_;
  LightSource casts_ = LightSource::kSun;  // the shadow-casting light
  bool has_edges_ = false;                 // whether vertices have shadow edges for casts_
  double momentary_edges_ = 0.0;           // MomentaryEdges::share
  int heights_version_ = -1;
  bool awaits_land_;
};

/// Returns whether the light of the sky on land is computed for each pixel. The second light may
/// lack its tables while they are computed: its block is then zero, and so is its light from the
/// sky, which is faint beside that of the first. The land would otherwise change twice where it is
/// lit by the first light.
[[nodiscard]] bool HasSkyByPixel(const PaintedScene& scene, const LightsOfSky& lights);

}  // namespace alpenglow::viewer
