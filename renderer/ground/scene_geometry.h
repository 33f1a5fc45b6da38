// SPDX-License-Identifier: MIT
// Rays of one eye in air that bends them, tabulated.
//
//   dt/ds = (grad n - (t grad n) t) / n          the ray equation, t the unit direction
//
// is followed by the midpoint rule in the vertical plane of a ray. A ray that leaves the eye along a
// direction t0 is, at a distance x along t0,
//
//   p(x) = eye + x t0 - y u,     y = (x - x0)^2 g(sin(elevation), x - x0)
//
// with u the direction across t0 in that plane, upwards, and x0 where the ray enters the air that
// bends. g changes so little that it is linear between nodes.
//
// Between two of its points a ray of the curvature c lies c L^2 / 8 from its chord. Chords are seen
// within an angle `off` of the ray where they are so short that
//
//   c L^2 / 8 = (distance + L / 2) off.
//
// Air that is thinner the higher it is bends rays towards the ground: no chord lies above its ray.
//
// Frame: that of SceneGround, the planet's centre at (0, 0, -R).
//
// What rays of a picture meet: terrain, the bare planet, or the sky.
//
// Frame: that of SceneGround. Altitudes are distances from the sphere that osculates the ellipsoid
// at the frame's origin, its centre at (0, 0, -R).
//
// Sunlight in the air over the terrain of a scene, by the method that fits the terrain.
#pragma once

#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <variant>
#include <vector>

#include "atmosphere/air/medium.h"
#include "atmosphere/sun/refraction.h"
#include "renderer/ground/scene_ground.h"
#include "renderer/ground/surface.h"
#include "renderer/layer.h"
#include "renderer/shadow/shadow_heights.h"
#include "renderer/shadow/sunlit_path.h"

namespace alpenglow::renderer {

class BentFan;

/// A ray of a fan. Refers to the fan.
class FanRay {
 public:
  FanRay(const BentFan& fan, const glm::dvec3& origin, const glm::dvec3& direction);

  /// The point of the ray at a distance along its first direction [m].
  [[nodiscard]] glm::dvec3 At(double along_m) const;
  [[nodiscard]] const BentFan& fan() const { return *fan_; }
  [[nodiscard]] const glm::dvec3& direction() const { return direction_; }
  /// Returns the sine of the elevation at the eye.
  [[nodiscard]] double sine() const { return sine_; }

 private:
  const BentFan* fan_;
  glm::dvec3 origin_, direction_, across_;
  double sine_;
  double enters_m_;
  const float* row_;  // of g, and the next one
  float share_;       // of the next one
};

/// Immutable, safe to share between threads.
class BentFan {
 public:
  /// @param eye, up  in the frame; up: unit. @param reach_m  > 0: points are asked for up to there.
  BentFan(const BendingAir& air, const glm::dvec3& eye, const glm::dvec3& up, double reach_m);

  /// Returns the length of the longest chord from a distance on that is seen so near to the ray.
  [[nodiscard]] double ChordFrom(double along_m, double off_rad) const;
  /// How near to the end of a chord, of whatever length, places on it are seen so near to the ray:
  /// c d (D - d) / 2 = off d.
  [[nodiscard]] double EndOfChord(double off_rad) const;
  /// A distance along a ray at which it is below a height [m over the sphere], and from which on the
  /// ray does not come back to it before it has been lower; infinite where there is none.
  [[nodiscard]] double SinksBelow(const FanRay& ray, double height_m) const;
  /// Returns a distance from which on a ray is above a height; infinite where none is known.
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
  double first_, last_;          // of that
  std::vector<float> g_per_m_;   // a row of kDistances + 1 an elevation
};

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

/// For one position of the sun. ShadowHeights over ground that is one surface, SunProbes over
/// meshes with overhangs; unbroken light without terrain, and with the sun so low that the beams
/// over the terrain have passed over the planet's horizon high above it.
class TerrainSunlight {
 public:
  /// Unbroken light.
  TerrainSunlight() = default;
  /// Refers to the ground.
  TerrainSunlight(const SceneGround& ground, const glm::dvec3& to_sun, double sun_radius_rad);

  /// Whether terrain can shade anything.
  [[nodiscard]] bool IsBroken() const;
  /// The stretches of a ray within [0, length_m] that the sun reaches; length_m is finite. The
  /// shadow of the planet itself is not among them.
  [[nodiscard]] SunlitPath Along(const glm::dvec3& origin, const glm::dvec3& unit,
                                 double length_m) const;

 private:
  struct Unbroken {};
  std::variant<Unbroken, ShadowHeights, SunProbes> method_;
};

}  // namespace alpenglow::renderer
