// SPDX-License-Identifier: MIT
// The air of a scene and the media along view rays: solved air, whole and without some of its
// parts, fog, volumes, and the airlight of lamps.
#pragma once

#include <glm/vec3.hpp>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "atmosphere/ray/single_scattering.h"
#include "atmosphere/refraction/refracted_view.h"
#include "lut/multiple_scattering/multiple_scattering.h"
#include "renderer/camera/camera_rays.h"
#include "renderer/effects/effects.h"
#include "renderer/illumination/aerial_perspective.h"
#include "renderer/lamps/lamp_light.h"
#include "renderer/media/media_light.h"
#include "renderer/picture/ground_light.h"
#include "renderer/picture/render.h"
#include "renderer/picture/sky_pixels.h"
#include "renderer/surface/scene_geometry.h"

namespace alpenglow::renderer {

/// Air with its single and multiple scattering, solved with the options for hazy and thick air
/// (OptionsFor). Refers to the parts of the ground.
struct AirModel {
  AirModel(const Medium& medium, const GroundParts& parts)
      : air(medium),
        beam(medium),
        multiple_scattering(medium, OptionsFor(medium)),
        aerial(air, multiple_scattering),
        ground_light(parts, sunlit()) {}
  AirModel(const AirModel&) = delete;
  AirModel& operator=(const AirModel&) = delete;

  [[nodiscard]] SunlitAir sunlit() const { return {air, beam, multiple_scattering}; }

  SingleScattering<float> air;
  RefractedBeam beam;
  MultipleScattering multiple_scattering;
  AerialPerspective aerial;
  GroundLight ground_light;
};

/// Safe to share between threads. Air that lacks a part is solved on first use. The air in front of
/// lamps always has all parts.
class AirModels {
 public:
  AirModels(const Medium& medium, const GroundParts& parts)
      : parts_(parts), whole_(medium, parts) {}

  [[nodiscard]] const AirModel& whole() const { return whole_; }
  /// Returns the air with only those of molecules, aerosol and ozone that are in `effects`.
  [[nodiscard]] const AirModel& With(EffectSet effects) const;

 private:
  GroundParts parts_;
  AirModel whole_;
  mutable std::mutex mutex_;
  mutable std::map<EffectSet, std::unique_ptr<AirModel>> partial_;
};

/// Light of a source besides the sun, treated as if that source were the sun.
struct SecondLight {
  Lighting light;
  BandLight by_sun;  // irradiance relative to the sun's
  std::shared_ptr<const TerrainSunlight> sunlight;
  std::shared_ptr<const MediaLight> media;

  [[nodiscard]] GroundSources ground_sources() const { return {light, media.get()}; }
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

/// Data that all pixels of a picture share. Copies share the parts that take long to prepare.
struct FrameContext {
  RenderSettings settings;
  const AirModel* model;
  MovingCamera moving;
  PixelFilter filter;
  Lighting light;
  std::shared_ptr<const TerrainSunlight> sunlight;
  std::shared_ptr<const LampLight> lamps;
  std::shared_ptr<const LampPlan> plan;
  std::shared_ptr<const MediaLight> media;  // null: no volumes, and only lamps light fog
  std::shared_ptr<const SecondLight> moonlit = nullptr;  // null: the moon lights nothing
  std::shared_ptr<const NightLight> night = nullptr;     // null: the night sky is not visible
  std::shared_ptr<const StarPixels> stars = nullptr;     // null: no visible stars
  bool polarised = false;  // a polariser or a layer needs Stokes parameters
  std::shared_ptr<const RefractedViewRays> bent = nullptr;  // null: refraction moves nothing
  double sunlight_s = 0.0, plan_s = 0.0, slopes_s = 0.0;    // preparation times

  [[nodiscard]] bool Has(Effect effect) const { return settings.effects.Has(effect); }
  [[nodiscard]] const CameraRays& camera() const { return moving.middle(); }
  [[nodiscard]] GroundSources ground_sources() const { return {light, media.get()}; }
  [[nodiscard]] bool HasLitFog() const { return media && media->media().fog() != nullptr; }
};

/// Rays of a pixel that share one air: they end at the same place within the width of an edge.
struct SharedSegmentAir {
  HitKind kind;
  double first_distance_m;     // of the first ray
  glm::dvec3 first_direction;  // of the first ray, unit
  glm::dvec3 direction_sum;    // sum of unit vectors
  double distance_sum_m;
  int rays;
  // Values along the mean direction of the rays, to their mean distance:
  AirAlongRay air{};       // Q and U in the axes of the picture
  BandLight fog{};         // fog transmittance of light from the end, unless `air` includes it
  BandLight lamp_light{};  // airlight of lamps, W m^-2 sr^-1 nm^-1
  BandLight media{};       // light of sun and sky scattered by volumes and fog, W m^-2 sr^-1 nm^-1
  std::vector<MarchedPiece> pieces{};  // pieces of media along the ray

  [[nodiscard]] double length_m() const {
    return kind == HitKind::kSky ? std::numeric_limits<double>::infinity() : distance_sum_m / rays;
  }

  /// @param widest_rad  largest angle between two rays that share air.
  [[nodiscard]] bool Takes(const Hit& hit, const glm::dvec3& direction, double widest_rad) const;
};

/// Returns the index of the air of a pixel that a ray looks through; adds a new one if no air fits,
/// or if airs are not shared.
/// @param direction  CameraRay::through: air and the beams in it are computed for the middle of the
///     lens; LampLight::SeenBy spreads the glow around lamps.
[[nodiscard]] std::size_t AirFor(const Hit& hit, const glm::dvec3& direction,
                                 const FrameContext& frame, std::vector<SharedSegmentAir>& airs);

/// Computes the light of sun and sky in air and media along the mean of the rays, and the
/// transmittance.
void AddAir(const FrameContext& frame, const SceneGeometry& geometry, const Medium& medium,
            SharedSegmentAir& rays);

/// Computes the airlight of lamps for pixel (x, y), and the transmittance of fog that only lamps
/// light. Call after AddAir.
void AddLamps(const FrameContext& frame, int x, int y, SharedSegmentAir& rays);

}  // namespace alpenglow::renderer
