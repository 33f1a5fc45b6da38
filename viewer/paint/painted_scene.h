// SPDX-License-Identifier: MIT
// A scene as it is painted: its air, its land, the light on that, the shade in the air and the fog,
// each made beside drawing and kept up with an eye that moves and a sun that does.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "atmosphere/ray/single_scattering.h"
#include "atmosphere/sun/sun.h"
#include "renderer/ground/scene_ground.h"
#include "renderer/ground/surface.h"
#include "renderer/scene/scene.h"
#include "viewer/air/air_follower.h"
#include "viewer/ground/ground_block.h"
#include "viewer/ground/ground_follower.h"
#include "viewer/ground/sky_by_pixel.h"
#include "viewer/ground/sky_on_ground.h"
#include "viewer/lamps/fog.h"
#include "viewer/land/landscape.h"
#include "viewer/paint/auto_quality.h"
#include "viewer/paint/key_light.h"
#include "viewer/paint/painted_view.h"
#include "viewer/shade/shafts.h"

namespace alpenglow::viewer {

/// To be used on the thread of the context that is current when it is made.
/// The air of a scene, as it is solved before there is a scene. Null: it is solved with it, in full.
using FirstAir = std::shared_ptr<const SolvedAir>;
/// A draft. Throws what PaintedScene does for a medium.
[[nodiscard]] FirstAir DraftOfAir(const Scene& scene);

class PaintedScene {
 public:
  /// A draft of the air is solved anew beside drawing; land is read beside drawing. Throws
  /// InputError for a medium of more than four wavelengths and for land that is named and cannot be read.
  PaintedScene(const Scene& scene, const LandSource& land, const PaintedView& first,
               const PaintSizes& sizes, FirstAir first_air);

  void Use(const PaintSizes& sizes);
  /// Other air; shown when it is solved.
  void Replace(const Medium& medium) { air_.Replace(medium); }

  /// Other land of the same kind: what there was is gone at once, and its light and shade.
  void Replace(const LandSource& land);

  /// Shows no land until what is about the eye has come.
  void AwaitLand() { awaits_land_ = true; }
  /// Whether land is still to come, at the start and after a change of place: then there is nothing
  /// but sky.
  [[nodiscard]] bool AwaitsLand() const { return awaits_land_; }

  /// Takes over what has become ready and asks for what is missing. Never waits, but for the first
  /// fog in other air or under a moon.
  /// @param lights   seen from the eye.
  /// @param seconds  since the last call.
  void Update(const PaintedView& view, const LightsOfSky& lights, double seconds);
  /// Waits until all is there that the view needs.
  /// @param samples  rays a pixel that will be painted.
  void Settle(const PaintedView& view, const LightsOfSky& lights, int samples);

  [[nodiscard]] const PaintSizes& sizes() const { return sizes_; }
  [[nodiscard]] const GeodeticPosition& place() const { return scene_.place; }
  [[nodiscard]] const Ellipsoid& ellipsoid() const { return ellipsoid_; }
  /// What lamps and fog stand on.
  [[nodiscard]] const SceneGround& lamp_ground() const { return lamp_ground_; }
  [[nodiscard]] const SceneDrape& drape() const { return drape_; }
  [[nodiscard]] const GroundMaterial& material() const { return material_; }
  /// As the sun lights it.
  [[nodiscard]] const AirFollower& air() const { return air_; }
  /// As a source does that counts.
  [[nodiscard]] const AirTextures& air_textures(LightSource source) const {
    return source == LightSource::kMoon && moon_air_ ? moon_air_->textures() : air_.textures();
  }
  [[nodiscard]] const Landscape& land() const { return *land_; }
  [[nodiscard]] Landscape& land() { return *land_; }
  /// Whether there is any, somewhere.
  [[nodiscard]] LandKind land_kind() const { return {has_land_, scene_.terrain.HasFineRelief()}; }
  [[nodiscard]] const GroundFollower& ground() const { return ground_; }
  /// How the open sky of a source that counts lights slopes, at the moment that was updated or settled
  /// last.
  [[nodiscard]] const SkyTilt& OpenSky(LightSource source) const {
    return open_skies_[IndexOf(source)].value().light;
  }
  [[nodiscard]] const GroundTextures& ground_textures() const { return ground_textures_; }
  /// Null: vertices have the sky's light of this source, by the quality or until the tables are there.
  [[nodiscard]] const SkyByPixel* sky_by_pixel(LightSource source) const {
    return sizes_.sky_by_pixel && sky_by_pixel_.Has(source) ? &sky_by_pixel_ : nullptr;
  }
  [[nodiscard]] const ShadeFollower& shade() const { return shade_; }
  /// Whether terrain keeps light of the key from the air, and that is painted.
  [[nodiscard]] bool HasShade(const PaintedView& view, const KeyLight& key) const {
    return !awaits_land_ && sizes_.has_shafts && shade_.shade().Shades() &&
           shade_.IsOf(view.eye.place, key.disk);
  }
  /// Whether the edges of terrain that land is painted with are all those before this source.
  [[nodiscard]] bool HasEdgesOf(LightSource source) const {
    return source == casts_ && (momentary_edges_ == 1.0 ? land_->HasHorizon() : has_edges_);
  }
  /// As a source lights it. Null: none.
  [[nodiscard]] const SceneFog* fog(LightSource source = LightSource::kSun) const {
    if (source == LightSource::kMoon && moon_fog_) return &*moon_fog_;
    return fog_ ? &*fog_ : nullptr;
  }
  /// Nothing without fog.
  [[nodiscard]] std::optional<PhaseKind> fog_phase() const;

 private:
  /// Followers keep up (Update) or wait until they have (Settle).
  enum class Pace { kFollow, kSettle };
  void KeepUpAir(const PaintedView& view, const LightsOfSky& lights, Pace pace, double seconds);
  /// The open sky's light on slopes, and what it was made for.
  struct OpenSkyOf {
    std::shared_ptr<const SolvedAir> air;
    double altitude_m, elevation_rad;
    SkyTilt light;
  };
  void KeepUpOpenSkies(const LightsOfSky& lights, Pace pace);
  [[nodiscard]] bool HasEdgesNear(const Vector<Ecef>& to_light) const;
  void KeepUpEdges(const PaintedView& view, const KeyLight& key, double seconds);
  void KeepUpFog(const PaintedView& view, const LightsOfSky& lights, Pace pace);
  void TakeHeights();
  void TakeLight();
  void TakeSkyByPixel();

  Scene scene_;
  Ellipsoid ellipsoid_;
  PaintSizes sizes_;
  bool has_land_;
  SceneGround lamp_ground_;
  SceneDrape drape_;
  GroundMaterial material_;
  AirView sun_view_;                                // the last one that the sun counted in
  AirFollower air_;                                 // of that
  std::shared_ptr<const SolvedAir> known_air_;      // that ground_textures_ have
  std::optional<AirIntegrator<float>> integrator_;  // of that
  std::array<std::optional<OpenSkyOf>, kLightSources> open_skies_;
  std::optional<AirFollower> moon_air_;           // once it counts
  std::shared_ptr<const SolvedAir> moon_air_of_;  // that it was made for
  std::unique_ptr<Landscape> land_;
  std::vector<std::unique_ptr<Landscape>> leaving_;  // until their threads have ended
  GroundFollower ground_;
  GroundTextures ground_textures_;
  SkyByPixel sky_by_pixel_;
  ShadeFollower shade_;
  std::optional<SceneFog> fog_, moon_fog_;
  LightSource casts_ = LightSource::kSun;  // what throws shadows
  bool has_edges_ = false;                 // whether vertices have their edges of shade before it
  double momentary_edges_ = 0.0;           // MomentaryEdges::share
  int heights_version_ = -1;
  bool awaits_land_;
};

}  // namespace alpenglow::viewer
