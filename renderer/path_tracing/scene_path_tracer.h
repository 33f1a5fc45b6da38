// SPDX-License-Identifier: MIT
// The exact method for whole scenes: paths through air, clouds and terrain together.
//
// The light of a path is that of all orders of scattering between molecules, aerosol, droplets,
// crystals and Lambertian ground, with the shadows of terrain, clouds and planet. On a segment of a
// path, null collisions draw a collision with a cloud (cloud_tracking.h); the air in front of it, and
// its sunlight, follow from closed columns (atmosphere/reference/path_tracer.h). One path serves all
// bands: it continues from a point drawn by its scattered light, summed over bands, and the sum of its
// weights never increases. Ratio tracking gives the transmittance of clouds to the sun.
//
// The mean over paths has no bias, but for:
//
//   - rays are straight: the sun stands where straight rays light the air like the refracted rays
//     (LightDirection::for_air), and it is a point;
//   - clouds lie in a flat frame (lit_clouds/cloud_chords.h), scatter all bands alike, and depolarise;
//   - columns of air have a relative error of 1e-6.
#pragma once

#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "atmosphere/reference/path_tracer.h"
#include "renderer/cloud_light/cloud_tracking.h"
#include "renderer/cloud_phase/cloud_phase.h"
#include "renderer/illumination/lighting.h"
#include "renderer/layer.h"
#include "renderer/lit_clouds/cloud_layers.h"
#include "renderer/lit_ground/ground_light.h"
#include "renderer/surface/scene_geometry.h"
#include "renderer/surface/scene_ground.h"

namespace alpenglow::renderer {

/// A scene in the light of one distant source.
struct TracedScene {
  const Medium& medium;  // over the sphere that osculates the ellipsoid
  const SceneGround& ground;
  const SceneGeometry& geometry;
  const GroundLight& ground_light;  // gives the albedo of the ground
  Lighting light;
  std::shared_ptr<const CloudLayers> clouds;  // null: none
  std::vector<CloudPhases> phases;            // of each layer
  double pixel_angle_rad;                     // detail of the ground below it is omitted
};

/// Immutable; safe to use from many threads. Refers to the parts of the scene.
class ScenePathTracer final : private atmosphere::reference::PathSurroundings {
 public:
  using PathRandom = atmosphere::reference::PathRandom;

  explicit ScenePathTracer(const TracedScene& scene);
  ScenePathTracer(const ScenePathTracer&) = delete;
  ScenePathTracer& operator=(const ScenePathTracer&) = delete;
  ~ScenePathTracer() override = default;

  /// Returns the light of one path per unit irradiance of the source [1/sr]; its mean over random
  /// numbers is the radiance.
  /// @param origin, direction  in the frame of the scene; unit.
  [[nodiscard]] SpectrumOf<double> OnePath(const glm::dvec3& origin, const glm::dvec3& direction,
                                           PathRandom& random) const;
  /// Returns the radiance along a ray with its standard error. The result does not depend on the
  /// number of threads. Throws InputError for options that are not valid.
  [[nodiscard]] atmosphere::reference::PathTracedRadiance Radiance(
      const glm::dvec3& origin, const glm::dvec3& direction,
      const atmosphere::reference::PathOptions& options = {}) const;

 private:
  using PathMeeting = atmosphere::reference::PathMeeting;
  using PathSegment = atmosphere::reference::PathSegment;
  struct Layer {
    const CloudField* field;
    CloudTracker tracker;
    AltitudeRange range;
    CloudPhases phases;
  };
  struct Collision {
    double distance_m;
    const PhaseFunction* phase;
    double albedo;
  };

  [[nodiscard]] std::optional<PathMeeting> Meet(const PathSegment& segment,
                                                PathRandom& random) const override;
  [[nodiscard]] double SunTransmittance(const glm::dvec3& point, PathRandom& random) const override;
  [[nodiscard]] const PhaseFunction* SunLobe(PathRandom& random) const override;

  /// Returns the point of a scene that has a point relative to the planet's centre.
  [[nodiscard]] glm::dvec3 InScene(const glm::dvec3& from_centre) const {
    return from_centre - centre_to_origin_;
  }
  [[nodiscard]] std::optional<Collision> CollisionOn(const glm::dvec3& origin,
                                                     const glm::dvec3& direction, double length_m,
                                                     PathRandom& random) const;
  [[nodiscard]] std::optional<Hit> TerrainWithin(const glm::dvec3& origin,
                                                 const glm::dvec3& direction,
                                                 std::optional<double> length_m) const;
  [[nodiscard]] PathMeeting OnSurface(const Hit& hit, const glm::dvec3& direction) const;

  TracedScene scene_;
  glm::dvec3 centre_to_origin_, to_sun_;
  std::vector<Layer> layers_;
  atmosphere::reference::AirPathTracer air_;
};

}  // namespace alpenglow::renderer
