// SPDX-License-Identifier: MIT
// This header provides the geometry of a scene: what a camera ray hits, which is terrain, the bare
// planet, or the sky. Spheres of glass and mirrors are found by PixelShader.
//
// All coordinates are in the frame of SceneGround. Altitudes are distances from the sphere that
// osculates the ellipsoid at the frame's origin; its centre is at (0, 0, -R).
#pragma once

#include <glm/vec3.hpp>
#include <limits>
#include <optional>

#include "atmosphere/medium/medium.h"
#include "renderer/layer.h"
#include "renderer/surface/ground_pattern.h"
#include "renderer/surface/refracted_fan.h"
#include "renderer/surface/scene_ground.h"
#include "renderer/surface/surface.h"

namespace alpenglow::renderer {

/// Returns the distance of a point from the sphere with its centre at (0, 0, -R) [m], accurate to
/// the rounding of the point's coordinates.
[[nodiscard]] double AltitudeOverSphere(const glm::dvec3& point, double radius_m);

/// Kind of object that a camera ray hits first.
enum class HitKind { kSky, kTerrain, kPlanet, kSphere };
struct Hit {
  HitKind kind = HitKind::kSky;
  double distance_m = std::numeric_limits<double>::infinity();
  glm::dvec3 normal{0.0, 0.0, 1.0};       // with relief finer than the mesh
  glm::dvec3 mesh_normal{0.0, 0.0, 1.0};  // interpolated between vertices
  glm::dvec3 geometric_normal{0.0, 0.0, 1.0};
  glm::dvec3 point{0.0};         // where the ray ends: selects the material
  glm::dvec3 smooth_point{0.0};  // where light is evaluated: TerrainHit::smooth_point
  double footprint_m = 0.0;      // width of a pixel there
};

/// Intersections of camera rays with the scene. Immutable, safe to share between threads. Refers to
/// the ground and the medium.
class SceneGeometry {
 public:
  /// @param with_relief  adds relief finer than the elevation samples to the normals.
  SceneGeometry(const SceneGround& ground, const Medium& medium, bool with_relief)
      : SceneGeometry(ground, medium, with_relief, ground.frame.origin()) {}
  /// @param eye  selects the pattern of the ground.
  SceneGeometry(const SceneGround& ground, const Medium& medium, bool with_relief,
                const Place& eye);

  [[nodiscard]] double radius_m() const { return medium_.planet_radius_m; }
  [[nodiscard]] bool HasTerrain() const { return ground_.terrain.has_value(); }
  /// Returns the distance from the sphere [m], accurate to the rounding of the point's coordinates.
  [[nodiscard]] double AltitudeOf(const glm::dvec3& point) const;
  /// Returns the unit vertical at a point.
  [[nodiscard]] glm::dvec3 UpAt(const glm::dvec3& point) const;
  /// @param cosine  between the ray and the normal of the mesh.
  [[nodiscard]] GroundPoint GroundAt(const glm::dvec3& point, double footprint_m,
                                     double cosine = 1.0) const;
  [[nodiscard]] const GroundPattern& pattern() const { return pattern_; }
  /// Returns MountainSurface::DetailedNormal in the frame of the ground.
  [[nodiscard]] glm::dvec3 DetailedNormal(const GroundPoint& at, const glm::dvec3& normal) const;

  /// @param direction  unit.
  /// @param pixel_angle_rad  between neighbouring pixels.
  [[nodiscard]] Hit Trace(const glm::dvec3& origin, const glm::dvec3& direction,
                          double pixel_angle_rad) const;

  /// Returns the terrain that a refracted ray hits; the sky if there is none. Needs terrain.
  /// @param off_rad  greatest angle between the hit and the ray, seen from the eye.
  /// @param expected_m  estimated distance of the hit: a good guess saves half of the time. 0:
  ///     unknown.
  [[nodiscard]] Hit TerrainAlong(const FanRay& ray, double off_rad, double pixel_angle_rad,
                                 double expected_m) const;
  /// Returns a distance beyond which there is no terrain [m]. Needs terrain.
  [[nodiscard]] double FarthestFrom(const glm::dvec3& point) const;
  /// Returns whether terrain covers the sphere of the planet below a point. Needs terrain.
  [[nodiscard]] bool CoversPlanetAt(const glm::dvec3& point) const;

 private:
  /// Returns a distance within which there is no terrain [m].
  [[nodiscard]] double NearestTo(const glm::dvec3& point) const;
  /// Returns the distance [m] from the eye beyond which no terrain is on a ray.
  [[nodiscard]] double EndOf(const FanRay& ray) const;
  /// A hit of the terrain on the chord of a ray between two distances.
  struct OnChord {
    glm::dvec3 begin, direction;
    double length_m;
    TerrainHit hit;
  };
  [[nodiscard]] std::optional<OnChord> MeetOnChord(const FanRay& ray, double from_m,
                                                   double to_m) const;
  /// @param before_m  distance from the eye to the start of the straight ray.
  [[nodiscard]] Hit OnTerrain(const TerrainHit& hit, const glm::dvec3& origin,
                              const glm::dvec3& direction, double before_m,
                              double pixel_angle_rad) const;
  [[nodiscard]] bool HiddenByPlanet(const glm::dvec3& origin, const glm::dvec3& direction,
                                    double distance_m) const;

  const SceneGround& ground_;
  const Medium& medium_;
  GroundPattern pattern_;
  bool with_relief_;
  double top_m_;     // no terrain is above this altitude
  double bottom_m_;  // no terrain is below this altitude
};

}  // namespace alpenglow::renderer
