// SPDX-License-Identifier: MIT
// The data that all pixels of one picture share: camera, distant lights with their shadows and
// their light on terrain and in media, lamps, night sky, stars and refraction.
//
// RefractedViewRays holds the refracted rays of a picture: whether refraction moves anything
// visible, and where refracted rays meet the ground.
//
// LimbView describes the air at the limb of the planet, seen from above. There the light of the sky
// can change by a factor e within a fraction of a pixel.
#pragma once

#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "atmosphere/refraction/refracted_view.h"
#include "renderer/camera/camera_rays.h"
#include "renderer/effects/effects.h"
#include "renderer/illumination/lighting.h"
#include "renderer/illumination/night_light.h"
#include "renderer/lamps/lamp_light.h"
#include "renderer/media/media_light.h"
#include "renderer/picture/prepared_scene.h"
#include "renderer/picture/render.h"
#include "renderer/picture/sky_pixels.h"
#include "renderer/surface/scene_geometry.h"

namespace alpenglow::renderer {

class FrameContext;

/// Straight rays past the planet and down to it, from one eye. Immutable.
class LimbView {
 public:
  LimbView(const SceneGeometry& geometry, const Medium& medium, const CameraRays& camera,
           const PixelFilter& filter);

  [[nodiscard]] const glm::dvec3& up() const { return up_; }
  [[nodiscard]] double radius_m() const { return radius_m_; }
  [[nodiscard]] double altitude_m() const { return altitude_m_; }
  /// Returns the air that bends rays.
  [[nodiscard]] const BendingAir& bending_air() const { return bending_air_; }

  /// Returns whether the density of the air at the lowest point ahead changes by more than 15 %
  /// within a pixel. There the light of the sky differs within a pixel, and pixels are sampled;
  /// elsewhere the sky in the middle of a pixel stands for the whole.
  [[nodiscard]] bool IsSteepAt(const glm::dvec3& direction) const;
  /// Returns the cosine between the vertical and a ray where it meets the planet; 0 if it does not.
  /// @param mu  sine of the ray's elevation at the eye.
  [[nodiscard]] double GroundCosine(double mu) const;
  [[nodiscard]] double GroundCosine(const glm::dvec3& direction) const {
    return GroundCosine(glm::dot(direction, up_));
  }

 private:
  glm::dvec3 up_;
  BendingAir bending_air_;
  double radius_m_, altitude_m_, top_m_;
  double pixel_rad_, filter_rad_;  // width of a pixel; radius of its filter
  double molecules_m_, haze_m_;    // scale heights
  double hazy_below_m_;            // altitude below which haze matters
};

/// Effect of refraction on the sun, on terrain and on the horizon of a sea without terrain.
struct RefractedViewRays {
  RefractedView view;
  glm::dvec3 up;               // at the eye, unit
  glm::dvec3 to_sun, to_moon;  // unit, without refraction
  bool moves_ground = false;  // moves the farthest terrain or the horizon by more than half a pixel
  std::shared_ptr<const RefractedFan> fan =
      nullptr;  // rays to terrain; null: terrain does not move

  [[nodiscard]] double ElevationOf(const glm::dvec3& direction) const;
  /// Returns the direction, unit, from which light of a band arrives that is seen in `direction`.
  [[nodiscard]] glm::dvec3 TrueDirection(const glm::dvec3& direction, std::size_t band) const;
};

/// Returns the refraction if it moves something in the picture by more than half a pixel; else
/// null.
[[nodiscard]] std::shared_ptr<const RefractedViewRays> RefractedViewRaysOf(
    const FrameContext& frame, const Observer& observer);

/// Returns the hit of a bent ray, for a frame with RefractedViewRays. Terrain appears within 0.1'
/// of the solution of the ray equation.
/// @param expected_m  expected length of the ray; 0: unknown.
[[nodiscard]] Hit OnRefractedRay(const FrameContext& frame, const CameraRay& ray,
                                 double expected_m);

/// A distant light of a picture, with its shadows and its light in media.
struct FrameLight {
  Lighting light;                                  // with this light as its sun
  BandLight by_sun;                                // irradiance relative to the sun's
  std::shared_ptr<const TerrainSunlight> shadows;  // in the air
  std::shared_ptr<const MediaLight> media;         // null: no bodies, and only lamps light layers

  [[nodiscard]] GroundSources ground_sources() const { return {light, media.get()}; }
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
  /// Computes the terrain's illumination by all lights.
  void LightTerrain();
  void AddStars(const Observer& observer);
  void AddSmallDisks();

  const PreparedScene* scene_;
  RenderSettings settings_;
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
