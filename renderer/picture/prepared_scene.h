// SPDX-License-Identifier: MIT
// The scene behind SceneRenderer, prepared once for all pictures: ground, air, lamps, media; and
// the cache of sunlight or moonlight in the air over one ground, which all pictures of a moment
// share.
#pragma once

#include <deque>
#include <glm/vec3.hpp>
#include <map>
#include <memory>
#include <mutex>
#include <optional>

#include "atmosphere/astronomy/sky_bodies.h"
#include "atmosphere/colour/spectrum.h"
#include "lut/cli/messages.h"
#include "lut/multiple_scattering/solved_air.h"
#include "renderer/camera/camera_rays.h"
#include "renderer/effects/effects.h"
#include "renderer/illumination/aerial_perspective.h"
#include "renderer/illumination/lighting.h"
#include "renderer/illumination/terrain_irradiance.h"
#include "renderer/lamps/lamp_light.h"
#include "renderer/lit_clouds/cloud_layers.h"
#include "renderer/lit_ground/ground_light.h"
#include "renderer/media/local_media.h"
#include "renderer/picture/render.h"
#include "renderer/scene/scene.h"
#include "renderer/specular/specular_sphere.h"
#include "renderer/surface/scene_geometry.h"
#include "renderer/surface/scene_ground.h"
#include "renderer/surface/surface.h"
#include "renderer/surface/terrain_sunlight.h"

namespace alpenglow::renderer {

/// Keeps the last two results: a frame of a series is metered in a small picture while the frame
/// before it is developed, and rendered afterwards. Safe to call from many threads.
class RecentSunlight {
 public:
  struct Made {
    std::shared_ptr<const TerrainSunlight> sunlight;
    double made_in_s;  // CPU time, summed over threads
  };

  /// Refers to the ground.
  explicit RecentSunlight(const SceneGround& ground) : ground_(ground) {}
  /// @param to_light, radius_rad  as for TerrainSunlight.
  [[nodiscard]] Made At(const glm::dvec3& to_light, double radius_rad);

 private:
  struct Kept {
    glm::dvec3 to_light;
    double radius_rad;
    Made made;
  };

  const SceneGround& ground_;
  std::mutex asking_;
  std::deque<Kept> kept_;  // oldest first
};

/// Solved air over the ground of a scene. Refers to the parts of the ground.
struct AirOverGround {
  AirOverGround(const Medium& medium, const GroundParts& parts)
      : air(medium),
        aerial(air.single_scattering(), air.multiple_scattering()),
        ground_light(parts, air) {}
  AirOverGround(const AirOverGround&) = delete;
  AirOverGround& operator=(const AirOverGround&) = delete;

  SolvedAir air;
  AerialPerspective aerial;
  GroundLight ground_light;
};

/// The air of a scene by its effects. Safe to share between threads. Air that lacks a part is
/// solved on first use. The air in front of lamps always has all parts.
class AirByEffects {
 public:
  AirByEffects(const Medium& medium, const GroundParts& parts)
      : parts_(parts), whole_(medium, parts) {}

  [[nodiscard]] const AirOverGround& whole() const { return whole_; }
  /// Returns the air with only those of molecules, aerosol and ozone that are in `effects`.
  [[nodiscard]] const AirOverGround& With(EffectSet effects) const;

 private:
  GroundParts parts_;
  AirOverGround whole_;
  mutable std::mutex mutex_;
  mutable std::map<EffectSet, std::unique_ptr<AirOverGround>> partial_;
};

/// A scene ready for pictures of any time. Immutable, safe to share between threads. The parts
/// refer to each other.
class PreparedScene {
 public:
  /// Throws InputError as LoadGround does.
  /// @param progress  receives the steps of the preparation; may be null; not kept.
  PreparedScene(const Scene& scene, Progress* progress)
      : PreparedScene(scene, std::make_shared<SceneGround>(LoadGround(scene, progress))) {}
  /// Uses loaded ground, in the frame of the scene's place.
  PreparedScene(const Scene& scene, std::shared_ptr<const SceneGround> ground)
      : PreparedScene(scene, std::move(ground), nullptr, scene.place) {}
  PreparedScene(const PreparedScene&) = delete;
  PreparedScene& operator=(const PreparedScene&) = delete;

  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] const SceneGround& ground() const { return *ground_; }
  /// Returns what was noted on reading the terrain and what is draped over it; empty: nothing.
  [[nodiscard]] const std::string& terrain_message() const { return terrain_message_; }
  /// Returns the medium on the osculating sphere.
  [[nodiscard]] const Medium& medium() const { return medium_; }
  [[nodiscard]] const BandColour& colour() const { return colour_; }
  [[nodiscard]] const LampLight& lamps() const { return lamps_; }
  [[nodiscard]] const LocalMedia& media() const { return media_; }
  /// Returns the spheres of glass and mirrors, in the frame of the ground.
  [[nodiscard]] const std::vector<SpecularSphere>& spheres() const { return spheres_; }
  [[nodiscard]] CloudsByTime& clouds() const { return *clouds_; }
  [[nodiscard]] const SceneGeometry& geometry() const { return geometry_; }
  /// Returns the geometry with fine relief only if the effects include it.
  [[nodiscard]] const SceneGeometry& GeometryWith(EffectSet effects) const {
    return effects.Has(Effect::kRelief) ? geometry_ : smooth_geometry_;
  }
  [[nodiscard]] const AirByEffects& air() const { return air_; }
  /// Returns the light of towns in the night sky (Skyglow); empty if there is none.
  [[nodiscard]] const std::optional<Spectrum>& towns() const { return towns_; }
  /// Computes the horizons of the terrain unless they are known. Pictures compute them on demand.
  void PrepareHorizons() const { (void)horizons_->Get(); }
  [[nodiscard]] RecentSunlight& sunlight() const { return *sunlight_; }
  [[nodiscard]] RecentSunlight& moonlight() const { return *moonlight_; }

  /// Returns this scene with another number of bands; null if its medium is not known on those
  /// bands.
  [[nodiscard]] std::unique_ptr<PreparedScene> OnOtherBands(int bands) const;
  /// Returns the scene without its fine spectrum; itself if it has no fine spectrum.
  [[nodiscard]] const PreparedScene& OnFewBands() const;
  [[nodiscard]] const PreparedScene& For(EffectSet effects) const {
    return effects.Has(Effect::kFineSpectrum) ? *this : OnFewBands();
  }
  /// Returns the scene with the pattern of the ground that belongs to an eye (GroundPattern): itself,
  /// or a scene on the same ground, which is prepared on first use and kept.
  [[nodiscard]] const PreparedScene& WithPatternAt(const Place& eye) const;

 private:
  /// @param other  a scene on the same ground, to share its horizons and its light in the air; may
  ///     be null.
  /// @param pattern_eye  the eye to which the pattern of the ground belongs.
  PreparedScene(const Scene& scene, std::shared_ptr<const SceneGround> ground,
                const PreparedScene* other, const Place& pattern_eye);

  Scene scene_;
  std::shared_ptr<const SceneGround> ground_;
  Medium medium_;
  BandColour colour_;
  LampLight lamps_;
  LocalMedia media_;
  std::vector<SpecularSphere> spheres_;
  SceneGeometry geometry_, smooth_geometry_;
  std::shared_ptr<const HorizonsOnDemand> horizons_;
  std::shared_ptr<RecentSunlight> sunlight_, moonlight_;
  std::shared_ptr<CloudsByTime> clouds_;
  GroundMaterial material_;
  std::string terrain_message_;
  AirByEffects air_;
  std::optional<Spectrum> towns_;
  mutable std::once_flag few_bands_asked_;
  mutable std::unique_ptr<PreparedScene> few_bands_;
  Place pattern_origin_;
  mutable std::mutex patterns_mutex_;
  mutable std::vector<std::unique_ptr<PreparedScene>> other_patterns_;
};

}  // namespace alpenglow::renderer
