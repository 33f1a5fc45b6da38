// SPDX-License-Identifier: MIT
// The data that all pixels of one picture share: camera, distant lights with their shadows and
// their light on terrain and in media, lamps, night sky, stars and refraction.
#pragma once

#include <memory>
#include <vector>

#include "renderer/camera/camera_rays.h"
#include "renderer/effects/effects.h"
#include "renderer/illumination/lighting.h"
#include "renderer/illumination/night_light.h"
#include "renderer/lamps/lamp_light.h"
#include "renderer/lit_clouds/lit_clouds.h"
#include "renderer/media/media_light.h"
#include "renderer/path_tracing/scene_path_tracer.h"
#include "renderer/picture/limb_view.h"
#include "renderer/picture/prepared_scene.h"
#include "renderer/picture/refracted_view_rays.h"
#include "renderer/picture/render.h"
#include "renderer/picture/scene_lighting.h"
#include "renderer/picture/small_disk.h"
#include "renderer/picture/sphere_light.h"
#include "renderer/picture/star_pixels.h"
#include "renderer/surface/scene_geometry.h"
#include "renderer/surface/terrain_sunlight.h"

namespace alpenglow::renderer {

/// A distant light of a picture, with its shadows and its light in media.
struct FrameLight {
  Lighting light;                                  // with this light as its sun
  Spectrum by_sun;                                 // irradiance relative to the sun's
  std::shared_ptr<const TerrainSunlight> shadows;  // in the air
  std::shared_ptr<const MediaLight> media;         // null: no bodies, and only lamps light layers
  std::shared_ptr<const LitClouds> clouds = nullptr;       // null: none
  std::shared_ptr<const ScenePathTracer> paths = nullptr;  // null: the fast method
  std::shared_ptr<const Caustics> caustics = nullptr;      // of spheres; null: none

  /// Returns the shadow of clouds; null: none.
  [[nodiscard]] const CloudShadow* cloud_shadow() const {
    return clouds && light.effects.Has(Effect::kCloudShadows) ? &clouds->shadow() : nullptr;
  }
  [[nodiscard]] GroundSources ground_sources() const { return {light, media.get(), clouds.get()}; }
};

/// Lights of the sky besides the scattered light of sun and moon; null: not visible.
struct SkyLights {
  std::shared_ptr<const NightLight> night;
  std::shared_ptr<const StarPixels> stars;
  /// The disks if they are less than a pixel wide; else rays meet them.
  std::shared_ptr<const SmallDisk> small_sun, small_moon;
};

/// Immutable, safe to share between threads. Copies share the parts that take long to prepare.
/// Refers to the scene.
class FrameContext {
 public:
  /// Prepares a picture. Reports the steps to the progress of the settings. Throws InputError for
  /// an eye at an impossible place.
  FrameContext(const PreparedScene& scene, const CameraSample& camera_sample,
               const RenderSettings& settings);

  /// Returns this picture with fewer effects.
  [[nodiscard]] FrameContext Reduced(EffectSet effects) const;
  /// Returns this picture with other numbers of samples and nodes; all other settings are equal.
  [[nodiscard]] FrameContext Sampled(const RenderSettings& settings) const;

  [[nodiscard]] const PreparedScene& scene() const { return *scene_; }
  /// Returns the geometry with fine relief, unless the effects lack it.
  [[nodiscard]] const SceneGeometry& geometry() const {
    return scene_->GeometryWith(settings_.effects);
  }
  [[nodiscard]] const AirOverGround& over_ground() const { return *over_ground_; }
  [[nodiscard]] const RenderSettings& settings() const { return settings_; }
  [[nodiscard]] bool Has(Effect effect) const { return settings_.effects.Has(effect); }

  [[nodiscard]] const MovingCamera& moving() const { return moving_; }
  /// Returns the camera in the middle of its motion.
  [[nodiscard]] const CameraRays& camera() const { return moving_.middle(); }
  [[nodiscard]] const PixelFilter& filter() const { return filter_; }
  /// Returns whether a polariser or a layer needs Stokes parameters.
  [[nodiscard]] bool IsPolarised() const { return is_polarised_; }

  /// Returns the lights: the sun, and the moon if it lights anything.
  [[nodiscard]] const std::vector<FrameLight>& lights() const { return lights_; }
  /// Returns the lighting by the sun, with the visible disk of the moon.
  [[nodiscard]] const Lighting& light() const { return lights_.front().light; }
  /// Returns the media in the light of the sun; null if there are none that it lights.
  [[nodiscard]] const MediaLight* media() const { return lights_.front().media.get(); }
  [[nodiscard]] const LampLight& lamps() const { return *lamps_; }
  [[nodiscard]] const LampPlan& plan() const { return *plan_; }
  [[nodiscard]] const SkyLights& sky_lights() const { return sky_lights_; }
  [[nodiscard]] const LimbView& limb() const { return limb_; }
  /// Returns null if refraction moves nothing.
  [[nodiscard]] const RefractedViewRays* bent() const { return refracted_.get(); }

  /// Returns the time that the preparation of an effect took [s].
  [[nodiscard]] double PreparationSeconds(Effect effect) const;

 private:
  void LightNight();
  void LightMedia();
  void LightClouds();
  [[nodiscard]] std::shared_ptr<const SolvedClouds> CloudsIn(const DistantLight& light) const;
  /// Follows the light of spheres onto the ground and into media.
  void LightSpheres();
  /// Computes the terrain's illumination by all lights.
  void LightTerrain();
  /// Prepares the paths of all lights, if the settings have paths.
  void AddPaths();
  void AddStars(const Observer& observer);
  void AddSmallDisks();

  const PreparedScene* scene_;
  RenderSettings settings_;
  UtcTime instant_;
  const AirOverGround* over_ground_;
  MovingCamera moving_;
  PixelFilter filter_;
  LimbView limb_;
  bool is_polarised_ = false;
  std::vector<FrameLight> lights_;
  std::shared_ptr<const LampLight> lamps_;
  std::shared_ptr<const LampPlan> plan_;
  SkyLights sky_lights_;
  std::shared_ptr<const RefractedViewRays> refracted_;
  double shadows_s_ = 0.0, plan_s_ = 0.0, slopes_s_ = 0.0;
};

}  // namespace alpenglow::renderer
