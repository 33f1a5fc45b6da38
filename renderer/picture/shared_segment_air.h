// SPDX-License-Identifier: MIT
// The air and the media in front of what the rays of a pixel meet: light of sun and sky, and the
// airlight of lamps. Rays of a pixel that meet nearly the same share it.
#pragma once

#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "renderer/illumination/aerial_perspective.h"
#include "renderer/media/media_light.h"
#include "renderer/picture/frame_context.h"
#include "renderer/surface/scene_geometry.h"

namespace alpenglow::renderer {

/// The air along the mean of some rays.
struct SharedSegmentAir {
  HitKind kind;
  double first_distance_m;     // of the first ray
  glm::dvec3 first_direction;  // of the first ray, unit
  double first_cosine;         // LimbView::GroundCosine of the first ray
  bool is_alone;               // the light of the air changes too much around the ray to be shared
  glm::dvec3 direction_sum;    // sum of unit vectors
  glm::dvec3 point_sum;        // sum of the points that the rays hit; 0 for sky
  double distance_sum_m;
  int rays;
  // Values along the mean direction of the rays, to their mean distance:
  AirAlongRay air{};  // Q and U in the axes of the picture
  /// Transmittance of the layers that only lamps light; `air` includes that of other media.
  Spectrum layers_left{};
  Spectrum lamp_light{};  // airlight of lamps, W m^-2 sr^-1 nm^-1
  Spectrum night{};       // light of the night sky and towns in air and clouds, in the same unit
  Spectrum media{};       // light of sun and sky scattered by media, W m^-2 sr^-1 nm^-1
  /// Fraction of the light of disks and stars that arrives in addition to the transmittance of `air`,
  /// which is that of media for wide sources.
  Spectrum narrow_left{};
  std::vector<MarchedPiece> pieces{};  // pieces of media along the ray
  Spectrum cloud_light{};              // light of clouds, W m^-2 sr^-1 nm^-1
  CloudsOnRay clouds{};                // `air` includes their transmittance

  [[nodiscard]] double length_m() const {
    return kind == HitKind::kSky ? std::numeric_limits<double>::infinity() : distance_sum_m / rays;
  }

  /// Returns the air of one ray.
  [[nodiscard]] static SharedSegmentAir Of(const Hit& hit, const glm::dvec3& direction,
                                           const FrameContext& frame);
  void Add(const Hit& hit, const glm::dvec3& direction);
  [[nodiscard]] glm::dvec3 Direction() const { return glm::normalize(direction_sum); }

  /// Returns whether the air along a direction may replace the mean over the rays.
  [[nodiscard]] bool MayLookAlong(const glm::dvec3& direction, const FrameContext& frame) const;
  /// @param widest_rad  largest angle between two rays that share air.
  [[nodiscard]] bool Takes(const Hit& hit, const glm::dvec3& direction, double widest_rad,
                           const FrameContext& frame) const;
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

/// Returns the transmittance of layers along a ray, unless the light of the air includes it.
[[nodiscard]] Spectrum UnmarchedLayers(const FrameContext& frame, const glm::dvec3& direction,
                                       double length_m);

/// Computes the light of lamps and of the night in air and clouds for pixel (x, y), and the
/// transmittance of layers that only lamps light. Call after AddAir.
void AddLamps(const FrameContext& frame, int x, int y, SharedSegmentAir& rays);

}  // namespace alpenglow::renderer
