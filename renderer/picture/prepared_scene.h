// SPDX-License-Identifier: MIT
// The prepared scene behind SceneRenderer: its parts, and the steps that turn them into one
// picture; and the cache of sunlight or moonlight in the air over one ground, which all pictures of
// a moment share.
#pragma once

#include <array>
#include <deque>
#include <glm/vec3.hpp>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "renderer/effects/effect_choice.h"
#include "renderer/illumination/lighting.h"
#include "renderer/lamps/lamp_light.h"
#include "renderer/picture/ground_light.h"
#include "renderer/picture/picture_layers.h"
#include "renderer/picture/pixel_light.h"
#include "renderer/picture/render.h"
#include "renderer/picture/segment_air.h"
#include "renderer/surface/scene_geometry.h"
#include "renderer/surface/scene_ground.h"

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
  /// @param to_sun  as for TerrainSunlight.
  [[nodiscard]] Made At(const glm::dvec3& to_sun, double sun_radius_rad);

 private:
  struct Kept {
    glm::dvec3 to_sun;
    double sun_radius_rad;
    Made made;
  };

  const SceneGround& ground_;
  std::mutex asking_;
  std::deque<Kept> kept_;  // oldest first
};

class OccludedSkyPixels;

struct PreparedScene {
  PreparedScene(const Scene& of, Progress* progress)
      : PreparedScene(of, std::make_shared<SceneGround>(LoadGround(of, progress))) {}
  PreparedScene(const Scene& of, std::shared_ptr<const SceneGround> on)
      : PreparedScene(of, std::move(on), nullptr) {}
  /// @param other  a state on the same ground, to share its horizons and its light in the air; may
  ///     be null.
  PreparedScene(const Scene& of, std::shared_ptr<const SceneGround> on, const PreparedScene* other)
      : scene(of),
        shared_ground(std::move(on)),
        ground(*shared_ground),
        medium(OnOsculatingSphere(scene.medium, scene.place.latitude_rad)),
        colour(medium.wavelengths_nm),
        lamps(scene, ground, medium, colour),
        media(scene, ground, medium),
        geometry(ground, medium, scene.terrain.HasFineRelief()),
        smooth_geometry(ground, medium, false),
        horizons(other ? other->horizons : std::make_shared<HorizonsOnDemand>(ground, medium)),
        recent_sunlight(other ? other->recent_sunlight : std::make_shared<RecentSunlight>(ground)),
        recent_moonlight(other ? other->recent_moonlight
                               : std::make_shared<RecentSunlight>(ground)),
        material(scene.ground, ColourDrape::Of(scene, ground), medium.wavelengths_nm),
        models(medium, {ground, geometry, lamps, *horizons, material}),
        towns(SkyglowOf()) {}

  [[nodiscard]] FrameContext FrameAt(const CameraSample& camera_sample,
                                     const RenderSettings& settings) const;
  void LightMedia(FrameContext& frame) const;
  void LightTerrain(FrameContext& frame) const;
  /// Adds moonlight and the night sky where they can be visible.
  void LightNight(FrameContext& frame) const;
  [[nodiscard]] std::shared_ptr<const StarPixels> StarsIn(const FrameContext& frame,
                                                          const CameraSample& camera_sample) const;
  /// Returns the fraction of light from space that air, fog and a polariser let through at a place
  /// of the picture; no value where ground is in front.
  [[nodiscard]] std::optional<BandLight> LeftOfSpace(const FrameContext& frame, double x,
                                                     double y) const;
  [[nodiscard]] FrameContext Reduced(FrameContext frame, EffectSet effects) const;
  [[nodiscard]] Image Pixels(const FrameContext& frame,
                             const std::vector<PixelPlace>& places) const;
  [[nodiscard]] CountedPicture Picture(const FrameContext& frame) const;
  /// Adds the rows of a picture with a fixed number of rays per pixel.
  void AddRows(const FrameContext& frame, PixelWriter& writer) const;
  /// Adds the tiles of a picture whose pixels take as many rays as their noise requires.
  void AddTiles(const FrameContext& frame, PixelWriter& writer) const;
  void AddTile(const FrameContext& frame, double floor, int x0, int y0,
               const OccludedSkyPixels& open_sky, PixelWriter& writer) const;
  void Write(const FrameContext& frame, int x, int y, const PixelLight& pixel,
             PixelWriter& writer) const;
  /// Returns the luminance floor of the relative noise: darker pixels count as if they had this
  /// luminance (effect_choice.h) [cd/m^2].
  [[nodiscard]] double NoiseFloor(const FrameContext& frame) const;
  /// @param expected_m  expected length of the ray; 0: unknown.
  [[nodiscard]] Hit Trace(const CameraRay& ray, const FrameContext& frame,
                          double expected_m = 0.0) const {
    if (frame.bent && frame.bent->moves_ground) return OnRefractedRay(ray, frame, expected_m);
    return Relief(frame).Trace(ray.origin, ray.direction, frame.camera().PixelAngle());
  }
  [[nodiscard]] const SceneGeometry& Relief(const FrameContext& frame) const {
    return frame.Has(Effect::kRelief) ? geometry : smooth_geometry;
  }
  /// Returns the hit of a bent ray. Terrain appears within 0.1' of the solution of the ray equation.
  [[nodiscard]] Hit OnRefractedRay(const CameraRay& ray, const FrameContext& frame,
                                   double expected_m) const;
  /// Returns the largest lift [rad] of terrain and the horizon.
  [[nodiscard]] double MostLift(const FrameContext& frame, double eye_height_m) const;
  /// Returns the refraction if it moves something in the picture by more than half a pixel; else null.
  [[nodiscard]] std::shared_ptr<const RefractedViewRays> RefractedViewRaysOf(
      const FrameContext& frame, const CameraSample& camera_sample) const;
  [[nodiscard]] Shaded Shade(const Hit& hit, const SharedSegmentAir& through, const CameraRay& ray,
                             const FrameContext& frame, const LampTile& near,
                             std::array<double, 2> disk_sample) const;
  /// Computes Shade() without a polariser and without Shaded::polarised.
  [[nodiscard]] Shaded ShadedWithoutPolariser(const Hit& hit, const SharedSegmentAir& through,
                                              const CameraRay& ray, const FrameContext& frame,
                                              const LampTile& near,
                                              std::array<double, 2> disk_sample) const;
  /// Returns Q and U of the light of sun and moon that the ground sends towards the eye.
  [[nodiscard]] PolarisedLight PolarisedGround(const Hit& hit, const CameraRay& ray,
                                               const FrameContext& frame,
                                               std::array<double, 2> disk_sample) const;
  [[nodiscard]] BandLight SunDisk(const glm::dvec3& direction, const AirAlongRay& through,
                                  const FrameContext& frame) const;
  /// Adds the light of stars at the pixel, which rays do not meet.
  [[nodiscard]] static PixelSum WithStars(const FrameContext& frame, int x, int y, PixelSum rays);
  [[nodiscard]] BandLight MoonSeen(const glm::dvec3& direction, const AirAlongRay& through,
                                   const FrameContext& frame) const;
  [[nodiscard]] std::optional<BandLight> SkyglowOf() const;
  [[nodiscard]] GeodeticPosition EyeOf(const CameraSample& camera_sample) const;
  [[nodiscard]] SunPosition ApparentSun(
      const CameraSample& camera_sample) const;  // see SceneRenderer
  [[nodiscard]] CameraStand StandOf(const CameraSample& camera_sample) const;
  [[nodiscard]] Lighting LightingAt(const CameraSample& camera_sample,
                                    const CameraStand& stand) const;
  /// Adds the night sky and moonlight to `light` if the sun is dim enough.
  void AddNight(const CameraSample& camera_sample, const CameraStand& stand, double earth_sun_au,
                Lighting& light) const;
  /// Returns the illuminance of one light and its sky on a level plane [lux].
  [[nodiscard]] double IlluminanceBy(const DistantLight& source, const glm::dvec3& eye,
                                     const Lighting& light) const;
  [[nodiscard]] double SunIlluminance(const FrameContext& frame) const;
  /// See SceneRenderer.
  [[nodiscard]] double Illuminance(const glm::dvec3& eye, const Lighting& light) const;
  [[nodiscard]] LampPlan PlanLamps(const FrameContext& frame) const;

  [[nodiscard]] EffectSet Present(const FrameContext& frame) const;
  /// Returns this scene with another number of bands; null if its medium is not known on those bands.
  [[nodiscard]] std::unique_ptr<PreparedScene> OnOtherBands(int bands) const;
  /// Returns the scene without its fine spectrum; itself if it has no fine spectrum.
  [[nodiscard]] const PreparedScene& OnFewBands() const;
  [[nodiscard]] const PreparedScene& For(EffectSet effects) const {
    return effects.Has(Effect::kFineSpectrum) ? *this : OnFewBands();
  }

  Scene scene;
  std::shared_ptr<const SceneGround> shared_ground;
  const SceneGround& ground;
  Medium medium;
  BandColour colour;
  LampLight lamps;
  LocalMedia media;
  SceneGeometry geometry, smooth_geometry;
  std::shared_ptr<const HorizonsOnDemand> horizons;
  std::shared_ptr<RecentSunlight> recent_sunlight, recent_moonlight;
  GroundMaterial material;
  AirModels models;
  std::optional<BandLight> towns;  // light of towns in the night sky (Skyglow)
  mutable std::once_flag few_bands_asked;
  mutable std::unique_ptr<PreparedScene> few_bands;
};

}  // namespace alpenglow::renderer
