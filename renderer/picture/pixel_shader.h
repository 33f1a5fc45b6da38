// SPDX-License-Identifier: MIT
// The radiance of single rays of a picture: what a ray meets, and the light that arrives along it.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <optional>

#include "atmosphere/reference/path_sampling.h"
#include "lut/multiple_scattering/polarised_scattering.h"
#include "renderer/camera/camera_rays.h"
#include "renderer/lamps/lamp_light.h"
#include "renderer/picture/frame_context.h"
#include "renderer/picture/picture_layers.h"
#include "renderer/picture/shared_segment_air.h"
#include "renderer/surface/scene_geometry.h"

namespace alpenglow::renderer {

/// Immutable, safe to share between threads. Refers to the frame.
class PixelShader {
 public:
  explicit PixelShader(const FrameContext& frame) : frame_(&frame) {}

  [[nodiscard]] const FrameContext& frame() const { return *frame_; }
  /// @param expected_m  expected length of the ray; 0: unknown.
  [[nodiscard]] Hit Trace(const CameraRay& ray, double expected_m = 0.0) const;
  /// Returns the light that arrives along a ray.
  /// @param near  lamps that can light the pixel. @param disk_sample  see GroundLight::Natural.
  /// @param traced  light of OnePath(), which replaces that of air, clouds and ground; null: the fast
  ///     method.
  [[nodiscard]] Shaded Shade(const Hit& hit, const SharedSegmentAir& through, const CameraRay& ray,
                             const LampTile& near, std::array<double, 2> disk_sample,
                             const Spectrum* traced = nullptr) const;
  /// Returns the light of one path of sun and one of the moon, W m^-2 sr^-1 nm^-1.
  [[nodiscard]] Spectrum OnePath(const CameraRay& ray,
                                 atmosphere::reference::PathRandom& random) const;
  /// Returns the fraction of light from space that air, media and a polariser let through at a place
  /// of the picture; no value where ground is in front.
  [[nodiscard]] std::optional<Spectrum> LeftOfSpace(double x, double y) const;
  /// Returns the light of the disk of the sun, or of the moon, that arrives from a direction if no
  /// ground is in front; 0 beside the disk.
  [[nodiscard]] Spectrum SunFrom(const glm::dvec3& direction) const;
  [[nodiscard]] Spectrum MoonFrom(const glm::dvec3& direction) const;

 private:
  /// Returns the light of a disk that arrives from a direction.
  /// @param disk  returns its light behind the air along a ray.
  using DiskBehind = Spectrum (*)(const FrameContext& frame, const glm::dvec3& direction,
                                  const AirAlongRay& through);
  [[nodiscard]] Spectrum DiskFrom(const glm::dvec3& direction, DiskBehind disk) const;
  /// Computes Shade() without a polariser and without Shaded::polarised.
  /// @param spheres  number of spheres that the ray has met before.
  [[nodiscard]] Shaded WithoutPolariser(const Hit& hit, const SharedSegmentAir& through,
                                        const CameraRay& ray, const LampTile& near,
                                        std::array<double, 2> disk_sample, const Spectrum* traced,
                                        int spheres) const;
  /// Adds the light that arrives through a sphere of glass or from a mirror. @param spheres  number of
  /// spheres that the ray has met before.
  void AddSphere(const CameraRay& ray, const LampTile& near, std::array<double, 2> disk_sample,
                 int spheres, Shaded& shaded) const;
  /// Returns the light of caustics in media along a ray.
  [[nodiscard]] Spectrum CausticsAlong(const CameraRay& ray, double length_m) const;
  /// Adds the light that the ground sends towards the eye.
  /// @param has_natural  whether it includes that of sun and moon.
  void AddGround(const Hit& hit, const CameraRay& ray, const LampTile& near,
                 std::array<double, 2> disk_sample, bool has_natural, Shaded& shaded) const;
  /// Returns Q and U of the distant lights that the ground sends towards the eye.
  [[nodiscard]] PolarisedLight PolarisedGround(const Hit& hit, const CameraRay& ray,
                                               std::array<double, 2> disk_sample) const;

  const FrameContext* frame_;
};

}  // namespace alpenglow::renderer
