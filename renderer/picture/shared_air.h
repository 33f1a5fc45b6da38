// SPDX-License-Identifier: MIT
// The air of a scene, solved, whole and without some of its parts.
//
// What stands between an eye and the ends of its rays: air, fog, volumes, and light of lamps in
// them.
#pragma once

#include <glm/vec3.hpp>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "atmosphere/ray/bent_view.h"
#include "atmosphere/ray/single_scattering.h"
#include "lut/diffuse/multiple_scattering.h"
#include "renderer/camera/camera_rays.h"
#include "renderer/effect/effects.h"
#include "renderer/ground/scene_geometry.h"
#include "renderer/lamp/lamp_light.h"
#include "renderer/light/aerial_perspective.h"
#include "renderer/media/media_light.h"
#include "renderer/picture/ground_light.h"
#include "renderer/picture/render.h"
#include "renderer/picture/sky_pixels.h"

namespace alpenglow::renderer {

/// Air and what its light reaches, of all orders as hazy and thick air needs it (OptionsFor). Refers to the parts of the ground.
struct AirModel {
  AirModel(const Medium& medium, const GroundParts& parts)
      : air(medium),
        beam(medium),
        diffuse(medium, OptionsFor(medium)),
        aerial(air, diffuse),
        ground_light(parts, sunlit()) {}
  AirModel(const AirModel&) = delete;
  AirModel& operator=(const AirModel&) = delete;

  [[nodiscard]] SunlitAir sunlit() const { return {air, beam, diffuse}; }

  AirIntegrator<float> air;
  BentBeam beam;
  DiffuseLight diffuse;
  AerialPerspective aerial;
  GroundLight ground_light;
};

/// Safe to share between threads. Air that lacks a part is solved when it is first asked for. The
/// air in front of lamps has all parts always.
class AirModels {
 public:
  AirModels(const Medium& medium, const GroundParts& parts)
      : parts_(parts), whole_(medium, parts) {}

  [[nodiscard]] const AirModel& whole() const { return whole_; }
  /// With those of molecules, aerosol and ozone that are among the effects.
  [[nodiscard]] const AirModel& With(EffectSet effects) const;

 private:
  GroundParts parts_;
  AirModel whole_;
  mutable std::mutex mutex_;
  mutable std::map<EffectSet, std::unique_ptr<AirModel>> partial_;
};

/// What a light beside the sun makes of a picture, as if it were the sun.
struct SecondLight {
  Lighting light;
  BandLight by_sun;  // its irradiance, relative to the sun's
  std::shared_ptr<const TerrainSunlight> sunlight;
  std::shared_ptr<const MediaLight> media;

  [[nodiscard]] GroundSources ground_sources() const { return {light, media.get()}; }
};

/// What bent rays show of the sun, of terrain and of a sea without it.
struct BentSight {
  BentView view;
  glm::dvec3 up;               // at the eye, unit
  glm::dvec3 to_sun, to_moon;  // unit, as if there were no air
  bool moves_ground = false;   // the farthest, or the horizon, by more than half a pixel
  std::shared_ptr<const BentFan> fan = nullptr;  // rays to terrain; null: it moves none

  [[nodiscard]] double ElevationOf(const glm::dvec3& direction) const;
  /// Where light of a band that is seen in a direction comes from, unit.
  [[nodiscard]] glm::dvec3 TrueDirection(const glm::dvec3& direction, std::size_t band) const;
};

/// What all pixels of a picture share. Copies share what took time to prepare.
struct PictureFrame {
  RenderSettings settings;
  const AirModel* model;
  MovingCamera moving;
  PixelFilter filter;
  Lighting light;
  std::shared_ptr<const TerrainSunlight> sunlight;
  std::shared_ptr<const LampLight> lamps;
  std::shared_ptr<const LampPlan> plan;
  std::shared_ptr<const MediaLight> media;  // null: no volumes, and fog is lit by lamps alone
  std::shared_ptr<const SecondLight> moonlit = nullptr;  // null: the moon lights nothing
  std::shared_ptr<const NightLight> night = nullptr;     // null: the sky of the night does not show
  std::shared_ptr<const StarPixels> stars = nullptr;     // null: none are seen
  bool polarised = false;  // Stokes parameters are asked for, by a polariser or a layer
  std::shared_ptr<const BentSight> bent = nullptr;        // null: it would move nothing
  double sunlight_s = 0.0, plan_s = 0.0, slopes_s = 0.0;  // time that they took

  [[nodiscard]] bool Has(Effect effect) const { return settings.effects.Has(effect); }
  [[nodiscard]] const CameraRays& camera() const { return moving.middle(); }
  [[nodiscard]] GroundSources ground_sources() const { return {light, media.get()}; }
  [[nodiscard]] bool HasLitFog() const { return media && media->media().fog() != nullptr; }
};

/// Rays of a pixel that look through the same air, to the same place but for an edge's width.
struct SharedAir {
  HitKind kind;
  double first_distance_m;     // of the ray that began it
  glm::dvec3 first_direction;  // of that ray, unit
  glm::dvec3 direction_sum;    // of unit vectors
  double distance_sum_m;
  int rays;
  // Along the mean of their directions, to their mean distance:
  AirAlongRay air{};       // Q and U in the axes of the picture
  BandLight fog{};         // what fog leaves of light from the end, unless `air` says so
  BandLight lamp_light{};  // of lamps in the air, W m^-2 sr^-1 nm^-1
  BandLight media{};       // of volumes and fog in sun and sky, W m^-2 sr^-1 nm^-1
  std::vector<MarchedPiece> pieces{};  // of media on the way

  [[nodiscard]] double length_m() const {
    return kind == HitKind::kSky ? std::numeric_limits<double>::infinity() : distance_sum_m / rays;
  }

  /// @param widest_rad  between two rays that share air.
  [[nodiscard]] bool Takes(const Hit& hit, const glm::dvec3& direction, double widest_rad) const;
};

/// Which of the airs of a pixel a ray looks through; makes a new one if none, or if airs
/// are not shared.
/// @param direction  CameraRay::through: air is as the middle of the lens sees it, beams in it too;
///     LampLight::SeenBy spreads the glow about lamps.
[[nodiscard]] std::size_t AirFor(const Hit& hit, const glm::dvec3& direction,
                                 const PictureFrame& frame, std::vector<SharedAir>& airs);

/// Light of sun and sky in air and media along the mean of the rays, and what they leave.
void AddAir(const PictureFrame& frame, const SceneGeometry& geometry, const Medium& medium,
            SharedAir& rays);

/// Light of lamps on the way, of pixel (x, y); and what
/// fog leaves that only lamps light. After AddAir.
void AddLamps(const PictureFrame& frame, int x, int y, SharedAir& rays);

}  // namespace alpenglow::renderer
