// SPDX-License-Identifier: MIT
// What rays of a picture meet: terrain, the bare planet, or the sky.
//
// Frame: that of SceneGround. Altitudes are distances from the sphere that osculates the ellipsoid
// at the frame's origin, its centre at (0, 0, -R).
#pragma once

#include <glm/vec3.hpp>
#include <limits>
#include <optional>

#include "atmosphere/air/medium.h"
#include "renderer/ground/bent_fan.h"
#include "renderer/ground/scene_ground.h"
#include "renderer/ground/surface.h"

namespace alpenglow::renderer {

/// Distance of a point from the sphere with its centre at
/// (0, 0, -R) [m], to the rounding of its coordinates.
[[nodiscard]] double AltitudeOverSphere(const glm::dvec3& point, double radius_m);

/// What a ray of the camera meets first.
enum class HitKind { kSky, kTerrain, kPlanet };
struct Hit {
  HitKind kind = HitKind::kSky;
  double distance_m = std::numeric_limits<double>::infinity();
  glm::dvec3 normal{0.0, 0.0, 1.0};       // with relief finer than the mesh
  glm::dvec3 mesh_normal{0.0, 0.0, 1.0};  // interpolated between vertices
  glm::dvec3 geometric_normal{0.0, 0.0, 1.0};
  glm::dvec3 point{0.0};         // where the ray ends: of what is there
  glm::dvec3 smooth_point{0.0};  // where light falls on it: TerrainHit::smooth_point
  double footprint_m = 0.0;      // width of a pixel there
};

/// Immutable, safe to share between threads. Refers to the ground and the medium.
class SceneGeometry {
 public:
  /// @param with_relief  normals have the relief that samples of elevation leave out.
  SceneGeometry(const SceneGround& ground, const Medium& medium, bool with_relief);

  [[nodiscard]] double radius_m() const { return medium_.planet_radius_m; }
  [[nodiscard]] bool HasTerrain() const { return ground_.terrain.has_value(); }
  /// Distance from the sphere [m], to the rounding of the point's coordinates.
  [[nodiscard]] double AltitudeOf(const glm::dvec3& point) const;
  /// Unit.
  [[nodiscard]] glm::dvec3 UpAt(const glm::dvec3& point) const;
  /// @param cosine  of the ray and the normal of the mesh.
  [[nodiscard]] GroundPoint GroundAt(const glm::dvec3& point, double footprint_m,
                                     double cosine = 1.0) const;

  /// @param direction  unit; pixel_angle_rad: between neighbouring pixels.
  [[nodiscard]] Hit Trace(const glm::dvec3& origin, const glm::dvec3& direction,
                          double pixel_angle_rad) const;

  /// What stands on a bent ray; the sky where no terrain does. Needs terrain.
  /// @param off_rad  that places on the ray may lie beside it, seen from the eye. @param expected_m
  ///     how far it may go: a good guess saves half of the time. 0: unknown.
  [[nodiscard]] Hit TerrainAlong(const FanRay& ray, double off_rad, double pixel_angle_rad,
                                 double expected_m) const;
  /// Not nearer than anything of the terrain [m]. Needs terrain.
  [[nodiscard]] double FarthestFrom(const glm::dvec3& point) const;
  /// Whether terrain covers the sphere of the planet below a point. Needs terrain.
  [[nodiscard]] bool CoversPlanetAt(const glm::dvec3& point) const;

 private:
  /// Not farther than anything of the terrain [m].
  [[nodiscard]] double NearestTo(const glm::dvec3& point) const;
  /// Returns the distance [m] from the eye beyond which no terrain stands on a ray.
  [[nodiscard]] double EndOf(const FanRay& ray) const;
  /// Finds the terrain on the chord of a ray between two distances.
  struct OnChord {
    glm::dvec3 begin, direction;
    double length_m;
    TerrainHit hit;
  };
  [[nodiscard]] std::optional<OnChord> MeetOnChord(const FanRay& ray, double from_m,
                                                   double to_m) const;
  /// @param before_m  from the eye to where the straight ray starts.
  [[nodiscard]] Hit OnTerrain(const TerrainHit& hit, const glm::dvec3& origin,
                              const glm::dvec3& direction, double before_m,
                              double pixel_angle_rad) const;
  [[nodiscard]] bool HiddenByPlanet(const glm::dvec3& origin, const glm::dvec3& direction,
                                    double distance_m) const;

  const SceneGround& ground_;
  const Medium& medium_;
  bool with_relief_;
  double top_m_;     // altitude that no terrain reaches
  double bottom_m_;  // below which there is none
};

}  // namespace alpenglow::renderer
