// SPDX-License-Identifier: MIT
// This header provides the geometry of a scene: refracted rays of one eye (RefractedFan),
// intersections of camera rays with terrain or planet (SceneGeometry), and sunlit stretches of rays
// (TerrainSunlight).
//
// RefractedFan tabulates rays through air that refracts them. The ray equation
//
//   dt/ds = (grad n - (t grad n) t) / n          t is the unit direction
//
// is integrated by the midpoint rule in the vertical plane of a ray. A ray that leaves the eye
// along a direction t0 is, at a distance x along t0,
//
//   p(x) = eye + x t0 - y u,     y = (x - x0)^2 g(sin(elevation), x - x0)
//
// where u is the upward direction perpendicular to t0 in that plane, and x0 the distance at which
// the ray enters the air that bends it. g varies so slowly that linear interpolation between nodes
// is enough.
//
// Between two of its points, a ray of curvature c deviates by c L^2 / 8 from its chord of length L.
// Seen from the eye, the chord stays within an angle `off` of the ray if
//
//   c L^2 / 8 = (distance + L / 2) off.
//
// Air whose density decreases with height bends rays towards the ground, so no chord lies above its
// ray.
//
// All coordinates are in the frame of SceneGround. Altitudes are distances from the sphere that
// osculates the ellipsoid at the frame's origin; its centre is at (0, 0, -R).
//
// SceneGeometry finds what a camera ray hits: terrain, the bare planet, or the sky. TerrainSunlight
// finds sunlight in the air over the terrain, by the method that suits the terrain.
#pragma once

#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <variant>
#include <vector>

#include "atmosphere/medium/medium.h"
#include "atmosphere/refraction/refraction.h"
#include "renderer/layer.h"
#include "renderer/surface/ground_pattern.h"
#include "renderer/surface/scene_ground.h"
#include "renderer/surface/surface.h"
#include "renderer/visibility/shadow_heights.h"
#include "renderer/visibility/sunlit_path.h"

namespace alpenglow::renderer {

class RefractedFan;

/// A ray of a fan. Refers to the fan.
class FanRay {
 public:
  FanRay(const RefractedFan& fan, const glm::dvec3& origin, const glm::dvec3& direction);

  /// Returns the point of the ray at a distance along its initial direction [m].
  [[nodiscard]] glm::dvec3 At(double along_m) const;
  [[nodiscard]] const RefractedFan& fan() const { return *fan_; }
  [[nodiscard]] const glm::dvec3& direction() const { return direction_; }
  /// Returns the sine of the elevation at the eye.
  [[nodiscard]] double sine() const { return sine_; }

 private:
  const RefractedFan* fan_;
  glm::dvec3 origin_, direction_, across_;
  double sine_;
  double enters_m_;
  const float* row_;  // row of g below; the next row follows
  float share_;       // weight of the next row
};

/// A table of refracted rays from one eye. Immutable, safe to share between threads.
class RefractedFan {
 public:
  /// @param eye, up  in the frame; `up` is a unit vector.
  /// @param reach_m  > 0: greatest distance at which points are evaluated.
  RefractedFan(const BendingAir& air, const glm::dvec3& eye, const glm::dvec3& up, double reach_m);

  /// Returns the length of the longest chord from a distance that stays within `off_rad` of the
  /// ray.
  [[nodiscard]] double ChordFrom(double along_m, double off_rad) const;
  /// Returns how close to the end of a chord of any length D its points stay within `off_rad` of
  /// the ray: D - d for the distance d from its start at which c d (D - d) / 2 = off d.
  [[nodiscard]] double EndOfChord(double off_rad) const;
  /// Returns a distance along a ray at which it is below a height [m above the sphere], and beyond
  /// which it does not return to this height before sinking further; infinite if there is none.
  [[nodiscard]] double SinksBelow(const FanRay& ray, double height_m) const;
  /// Returns a distance beyond which a ray stays above a height; infinite if none is known.
  [[nodiscard]] double RisesAbove(const FanRay& ray, double height_m) const;

  [[nodiscard]] double height_m() const { return height_m_; }
  [[nodiscard]] double reach_m() const { return reach_m_; }

 private:
  friend class FanRay;
  static constexpr int kElevations = 512, kDistances = 64;

  [[nodiscard]] double RowOf(double sine) const;
  [[nodiscard]] double EntersAir(double sine) const;
  void FillRow(double sine, float* row) const;

  BendingAir air_;
  glm::dvec3 up_;
  double height_m_, reach_m_;
  double most_curvature_per_m_;
  double grazing_sine_, scale_;  // rows are even in asinh((sine - grazing_sine_) / scale_)
  double first_, last_;          // range of that asinh
  std::vector<float> g_per_m_;   // one row of kDistances + 1 values per elevation
};

/// Returns the distance of a point from the sphere with its centre at (0, 0, -R) [m], accurate to
/// the rounding of the point's coordinates.
[[nodiscard]] double AltitudeOverSphere(const glm::dvec3& point, double radius_m);

/// Kind of object that a camera ray hits first.
enum class HitKind { kSky, kTerrain, kPlanet };
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

/// Sunlight over terrain for one position of the sun. It uses ShadowHeights over ground that is one
/// surface, and SunProbes over meshes with overhangs. The light is unbroken without terrain, and
/// when the sun is so low that beams which pass the planet's horizon are high above the terrain.
class TerrainSunlight {
 public:
  /// Creates unbroken light.
  TerrainSunlight() = default;
  /// Refers to the ground.
  TerrainSunlight(const SceneGround& ground, const glm::dvec3& to_light, double radius_rad);

  /// Returns whether terrain can cast shadows.
  [[nodiscard]] bool IsBroken() const;
  /// Returns the stretches of a ray within [0, length_m] that terrain does not shade from the sun;
  /// length_m is finite. The planet's own shadow is not considered.
  [[nodiscard]] SunlitPath Along(const glm::dvec3& origin, const glm::dvec3& unit,
                                 double length_m) const;

 private:
  struct Unbroken {};
  std::variant<Unbroken, ShadowHeights, SunProbes> method_;
};

}  // namespace alpenglow::renderer
