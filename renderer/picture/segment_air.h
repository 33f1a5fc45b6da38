// SPDX-License-Identifier: MIT
// Air and media along the view rays of a pixel: light of sun and sky, fog, volumes, and the
// airlight of lamps.
#pragma once

#include <glm/vec3.hpp>
#include <limits>
#include <vector>

#include "renderer/illumination/aerial_perspective.h"
#include "renderer/material/band_light.h"
#include "renderer/media/media_light.h"
#include "renderer/picture/frame_context.h"
#include "renderer/surface/scene_geometry.h"

namespace alpenglow::renderer {

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
void AddAir(const FrameContext& frame, SharedSegmentAir& rays);

/// Returns the transmittance of fog along a ray, unless the light of the air includes it already.
[[nodiscard]] BandLight UnmarchedFog(const FrameContext& frame, const glm::dvec3& direction,
                                     double length_m);

/// Computes the airlight of lamps for pixel (x, y), and the transmittance of fog that only lamps
/// light. Call after AddAir.
void AddLamps(const FrameContext& frame, int x, int y, SharedSegmentAir& rays);

}  // namespace alpenglow::renderer
