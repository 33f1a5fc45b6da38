// SPDX-License-Identifier: MIT
// Light of sun or moon in the air over one ground, made once for all pictures of one moment.
//
// What a SceneRenderer is made of: its parts, and what becomes of them in one picture.
#pragma once

#include <array>
#include <deque>
#include <glm/vec3.hpp>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "renderer/effect/effect_choice.h"
#include "renderer/ground/scene_geometry.h"
#include "renderer/ground/scene_ground.h"
#include "renderer/lamp/lamp_light.h"
#include "renderer/light/lighting.h"
#include "renderer/picture/ground_light.h"
#include "renderer/picture/picture_layers.h"
#include "renderer/picture/pixel_light.h"
#include "renderer/picture/render.h"
#include "renderer/picture/shared_air.h"

namespace alpenglow::renderer {

/// Keeps the last two that it has made: a frame of a series is metered small while the frame before
/// it is developed, and drawn then. Safe to ask from many threads.
class RecentSunlight {
 public:
  struct Made {
    std::shared_ptr<const TerrainSunlight> sunlight;
    double made_in_s;  // of all threads together
  };

  /// Refers to the ground.
  explicit RecentSunlight(const SceneGround& ground) : ground_(ground) {}
  /// @param to_sun  as TerrainSunlight takes it.
  [[nodiscard]] Made At(const glm::dvec3& to_sun, double sun_radius_rad);

 private:
  struct Kept {
    glm::dvec3 to_sun;
    double sun_radius_rad;
    Made made;
  };

  const SceneGround& ground_;
  std::mutex asking_;
  std::deque<Kept> kept_;  // the oldest first
};

class OpenSkyPixels;

struct SceneState {
  SceneState(const Scene& of, Progress* progress)
      : SceneState(of, std::make_shared<SceneGround>(LoadGround(of, progress))) {}
  SceneState(const Scene& of, std::shared_ptr<const SceneGround> on)
      : SceneState(of, std::move(on), nullptr) {}
  /// @param other  on the same ground, whose horizons and light in the air this one shares; or null.
  SceneState(const Scene& of, std::shared_ptr<const SceneGround> on, const SceneState* other)
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
        towns(TownsOf()) {}

  [[nodiscard]] PictureFrame FrameAt(const Shot& shot, const RenderSettings& settings) const;
  void LightMedia(PictureFrame& frame) const;
  void LightTerrain(PictureFrame& frame) const;
  /// Moonlight, the sky of the night, stars: what of them could show.
  void LightNight(PictureFrame& frame) const;
  [[nodiscard]] std::shared_ptr<const StarPixels> StarsIn(const PictureFrame& frame,
                                                          const Shot& shot) const;
  /// What air, fog and a polariser leave of light from space at a place of the picture; nothing behind ground.
  [[nodiscard]] std::optional<BandLight> LeftOfSpace(const PictureFrame& frame, double x,
                                                     double y) const;
  [[nodiscard]] PictureFrame Reduced(PictureFrame frame, EffectSet effects) const;
  [[nodiscard]] Image Pixels(const PictureFrame& frame,
                             const std::vector<PixelPlace>& places) const;
  [[nodiscard]] CountedPicture Picture(const PictureFrame& frame) const;
  /// Rows of a picture whose pixels take equally many rays.
  void AddRows(const PictureFrame& frame, PixelWriter& writer) const;
  /// Tiles of one whose pixels take what their noise asks for.
  void AddTiles(const PictureFrame& frame, PixelWriter& writer) const;
  void AddTile(const PictureFrame& frame, double floor, int x0, int y0,
               const OpenSkyPixels& open_sky, PixelWriter& writer) const;
  void Write(const PictureFrame& frame, int x, int y, const PixelLight& pixel,
             PixelWriter& writer) const;
  /// Of what is darker, noise counts as if it were so bright (effect_choice.h) [cd/m^2].
  [[nodiscard]] double NoiseFloor(const PictureFrame& frame) const;
  /// @param expected_m  how far the ray may go; 0: unknown.
  [[nodiscard]] Hit Trace(const CameraRay& ray, const PictureFrame& frame,
                          double expected_m = 0.0) const {
    if (frame.bent && frame.bent->moves_ground) return OnBentRay(ray, frame, expected_m);
    return Relief(frame).Trace(ray.origin, ray.direction, frame.camera().PixelAngle());
  }
  [[nodiscard]] const SceneGeometry& Relief(const PictureFrame& frame) const {
    return frame.Has(Effect::kRelief) ? geometry : smooth_geometry;
  }
  /// What a bent ray meets. Terrain is seen within 0.1' of where the ray equation has it.
  [[nodiscard]] Hit OnBentRay(const CameraRay& ray, const PictureFrame& frame,
                              double expected_m) const;
  /// Returns the largest lift [rad] of terrain and the horizon.
  [[nodiscard]] double MostLift(const PictureFrame& frame, double eye_height_m) const;
  /// Where it moves something in the picture by more than half a pixel; else null.
  [[nodiscard]] std::shared_ptr<const BentSight> BentSightOf(const PictureFrame& frame,
                                                             const Shot& shot) const;
  [[nodiscard]] Shaded Shade(const Hit& hit, const SharedAir& through, const CameraRay& ray,
                             const PictureFrame& frame, const LampTile& near,
                             std::array<double, 2> disk_sample) const;
  /// Shade() of a camera without a polariser, and without Shaded::polarised.
  [[nodiscard]] Shaded ShadedWithoutPolariser(const Hit& hit, const SharedAir& through,
                                              const CameraRay& ray, const PictureFrame& frame,
                                              const LampTile& near,
                                              std::array<double, 2> disk_sample) const;
  /// Q and U of what the ground there sends, of sun and moon.
  [[nodiscard]] PolarisedLight PolarisedGround(const Hit& hit, const CameraRay& ray,
                                               const PictureFrame& frame,
                                               std::array<double, 2> disk_sample) const;
  [[nodiscard]] BandLight SunDisk(const glm::dvec3& direction, const AirAlongRay& through,
                                  const PictureFrame& frame) const;
  /// With the stars at the pixel, which rays do not meet.
  [[nodiscard]] static PixelSum WithStars(const PictureFrame& frame, int x, int y, PixelSum rays);
  [[nodiscard]] BandLight MoonSeen(const glm::dvec3& direction, const AirAlongRay& through,
                                   const PictureFrame& frame) const;
  [[nodiscard]] std::optional<BandLight> TownsOf() const;
  [[nodiscard]] GeodeticPosition EyeOf(const Shot& shot) const;
  [[nodiscard]] SunPosition ApparentSun(const Shot& shot) const;  // see SceneRenderer
  [[nodiscard]] CameraStand StandOf(const Shot& shot) const;
  [[nodiscard]] Lighting LightingAt(const Shot& shot, const CameraStand& stand) const;
  /// What shines besides the sun, where that is dim enough.
  void AddNight(const Shot& shot, const CameraStand& stand, double earth_sun_au,
                Lighting& light) const;
  /// Of one light and the sky that it makes, on a level plane [lux].
  [[nodiscard]] double IlluminanceBy(const DistantLight& source, const glm::dvec3& eye,
                                     const Lighting& light) const;
  [[nodiscard]] double SunIlluminance(const PictureFrame& frame) const;
  /// See SceneRenderer.
  [[nodiscard]] double Illuminance(const glm::dvec3& eye, const Lighting& light) const;
  [[nodiscard]] LampPlan PlanLamps(const PictureFrame& frame) const;

  [[nodiscard]] EffectSet Present(const PictureFrame& frame) const;
  /// The same scene on as many bands; nothing where nobody knows its air there.
  [[nodiscard]] std::unique_ptr<SceneState> OnOtherBands(int bands) const;
  /// The scene without its fine spectrum: itself where it has none.
  [[nodiscard]] const SceneState& OnFewBands() const;
  [[nodiscard]] const SceneState& For(EffectSet effects) const {
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
  std::optional<BandLight> towns;  // TownLight
  mutable std::once_flag few_bands_asked;
  mutable std::unique_ptr<SceneState> few_bands;
};

}  // namespace alpenglow::renderer
