// SPDX-License-Identifier: MIT
// The radiance of single rays of a picture: what a ray meets, the air and the media in front of it
// (light of sun and sky, and the airlight of lamps), and the light that arrives along
// it.
#pragma once

#include <array>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "renderer/camera/camera_rays.h"
#include "renderer/illumination/aerial_perspective.h"
#include "renderer/lamps/lamp_light.h"
#include "renderer/material/band_light.h"
#include "renderer/media/media_light.h"
#include "renderer/picture/frame_context.h"
#include "renderer/picture/picture_layers.h"
#include "renderer/surface/scene_geometry.h"

namespace alpenglow::renderer {

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
  BandLight layers_left{};
  BandLight lamp_light{};  // airlight of lamps, W m^-2 sr^-1 nm^-1
  BandLight media{};       // light of sun and sky scattered by media, W m^-2 sr^-1 nm^-1
  std::vector<MarchedPiece> pieces{};  // pieces of media along the ray

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
[[nodiscard]] BandLight UnmarchedLayers(const FrameContext& frame, const glm::dvec3& direction,
                                        double length_m);

/// Computes the airlight of lamps for pixel (x, y), and the transmittance of layers that only lamps
/// light. Call after AddAir.
void AddLamps(const FrameContext& frame, int x, int y, SharedSegmentAir& rays);

/// Immutable, safe to share between threads. Refers to the frame.
class PixelShader {
 public:
  explicit PixelShader(const FrameContext& frame) : frame_(&frame) {}

  [[nodiscard]] const FrameContext& frame() const { return *frame_; }
  /// @param expected_m  expected length of the ray; 0: unknown.
  [[nodiscard]] Hit Trace(const CameraRay& ray, double expected_m = 0.0) const;
  /// Returns the light that arrives along a ray.
  /// @param near  lamps that can light the pixel. @param disk_sample  see GroundLight::Natural.
  [[nodiscard]] Shaded Shade(const Hit& hit, const SharedSegmentAir& through, const CameraRay& ray,
                             const LampTile& near, std::array<double, 2> disk_sample) const;
  /// Returns the fraction of light from space that air, media and a polariser let through at a place
  /// of the picture; no value where ground is in front.
  [[nodiscard]] std::optional<BandLight> LeftOfSpace(double x, double y) const;
  /// Returns the light of the disk of the sun, or of the moon, that arrives from a direction if no
  /// ground is in front; 0 beside the disk.
  [[nodiscard]] BandLight SunFrom(const glm::dvec3& direction) const;
  [[nodiscard]] BandLight MoonFrom(const glm::dvec3& direction) const;

 private:
  /// Returns the light of a disk that arrives from a direction.
  /// @param disk  returns its light behind the air along a ray.
  using DiskBehind = BandLight (*)(const FrameContext& frame, const glm::dvec3& direction,
                                   const AirAlongRay& through);
  [[nodiscard]] BandLight DiskFrom(const glm::dvec3& direction, DiskBehind disk) const;
  /// Computes Shade() without a polariser and without Shaded::polarised.
  [[nodiscard]] Shaded WithoutPolariser(const Hit& hit, const SharedSegmentAir& through,
                                        const CameraRay& ray, const LampTile& near,
                                        std::array<double, 2> disk_sample) const;
  /// Adds the light that the ground sends towards the eye.
  void AddGround(const Hit& hit, const CameraRay& ray, const LampTile& near,
                 std::array<double, 2> disk_sample, Shaded& shaded) const;
  /// Returns Q and U of the distant lights that the ground sends towards the eye.
  [[nodiscard]] PolarisedLight PolarisedGround(const Hit& hit, const CameraRay& ray,
                                               std::array<double, 2> disk_sample) const;

  const FrameContext* frame_;
};

}  // namespace alpenglow::renderer
