// SPDX-License-Identifier: MIT
#include "renderer/surface/scene_geometry.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>

#include "atmosphere/math/constants.h"
#include "atmosphere/ray/ray.h"
#include "renderer/surface/inside_planet.h"

namespace alpenglow::renderer {
namespace {

/// Returns the lowest altitude of the box around the terrain, which is at its centre, because
/// altitude above the sphere grows with the distance from the centre.
double BottomOf(const SceneGround& ground) {
  return ground.terrain ? ground.terrain->Bounds().first.z : 0.0;
}

/// Returns the greatest altitude of the box around the terrain, which is at its corners, because
/// altitude above the sphere grows with the distance from the centre.
double TopOf(const SceneGround& ground, double radius_m) {
  if (!ground.terrain) return 0.0;
  const auto [low, high] = ground.terrain->Bounds();
  const glm::dvec3 across = glm::max(glm::abs(low), glm::abs(high));
  return AltitudeOverSphere({across.x, across.y, high.z}, radius_m);
}

}  // namespace

// This is |p - c| - R without cancellation.
double AltitudeOverSphere(const glm::dvec3& point, double radius_m) {
  const double across = point.x * point.x + point.y * point.y;
  const double q = across + point.z * (2.0 * radius_m + point.z);
  return q / (std::sqrt(across + (radius_m + point.z) * (radius_m + point.z)) + radius_m);
}

SceneGeometry::SceneGeometry(const SceneGround& ground, const Medium& medium, bool with_relief,
                             const Place& eye)
    : ground_(ground),
      medium_(medium),
      pattern_(ground.frame, eye),
      with_relief_(with_relief),
      top_m_(TopOf(ground, medium.planet_radius_m)),
      bottom_m_(BottomOf(ground)) {}

double SceneGeometry::AltitudeOf(const glm::dvec3& point) const {
  return AltitudeOverSphere(point, radius_m());
}

glm::dvec3 SceneGeometry::UpAt(const glm::dvec3& point) const {
  return glm::normalize(point + glm::dvec3(0.0, 0.0, radius_m()));
}

GroundPoint SceneGeometry::GroundAt(const glm::dvec3& point, double footprint_m,
                                    double cosine) const {
  GroundPoint at = pattern_.At(point);
  at.altitude_m = std::max(AltitudeOf(point), 0.0);
  at.across_m = footprint_m;
  at.cosine = cosine;
  return at;
}

glm::dvec3 SceneGeometry::DetailedNormal(const GroundPoint& at, const glm::dvec3& normal) const {
  return pattern_.FromPattern(MountainSurface::DetailedNormal(at, pattern_.ToPattern(normal)));
}

// Returns whether the bare planet stands between the eye and terrain beyond its horizon.
bool SceneGeometry::HiddenByPlanet(const glm::dvec3& origin, const glm::dvec3& direction,
                                   double distance_m) const {
  return PlanetHides(origin, origin + distance_m * direction, radius_m(),
                     [&](const glm::dvec3& point) { return CoversPlanetAt(point); });
}

bool SceneGeometry::CoversPlanetAt(const glm::dvec3& point) const {
  constexpr double kAbove_m = 20000.0;
  const glm::dvec3 up = UpAt(point);
  return ground_.terrain->Intersect(point + kAbove_m * up, -up).has_value();
}

Hit SceneGeometry::OnTerrain(const TerrainHit& hit, const glm::dvec3& origin,
                             const glm::dvec3& direction, double before_m,
                             double pixel_angle_rad) const {
  const double distance_m = before_m + hit.distance_m;
  Hit found{HitKind::kTerrain,    distance_m,
            hit.normal,           hit.normal,
            hit.geometric_normal, origin + hit.distance_m * direction,
            hit.smooth_point,     distance_m * pixel_angle_rad};
  if (with_relief_) {
    found.normal = DetailedNormal(
        GroundAt(found.point, found.footprint_m, -glm::dot(found.normal, direction)), found.normal);
  }
  return found;
}

double SceneGeometry::EndOf(const FanRay& ray) const {
  return std::min({ray.fan().reach_m(), ray.fan().RisesAbove(ray, top_m_),
                   ray.fan().SinksBelow(ray, bottom_m_)});
}

std::optional<SceneGeometry::OnChord> SceneGeometry::MeetOnChord(const FanRay& ray, double from_m,
                                                                 double to_m) const {
  const glm::dvec3 begin = ray.At(from_m), chord = ray.At(to_m) - begin;
  const double length_m = glm::length(chord);
  const glm::dvec3 direction = chord / length_m;
  const auto hit = ground_.terrain->Intersect(begin, direction, length_m);
  if (!hit) return std::nullopt;
  return OnChord{begin, direction, length_m, *hit};
}

// If the ground is solid below its surface, and the chord below a ray is in the air, then the ray
// does not hit anything either. A long chord therefore gives the distance up to which the ray is
// free, and short chords from there on give the hit. A hit near the end of the long chord is
// accepted, because the chord is close enough to the ray there.
Hit SceneGeometry::TerrainAlong(const FanRay& ray, double off_rad, double pixel_angle_rad,
                                double expected_m) const {
  constexpr double kBefore = 1.0 - 1e-4;  // step back from the hit
  constexpr double kBehind = 1.01;        // beyond the expected distance
  const double end_m = EndOf(ray), near_end_m = ray.fan().EndOfChord(off_rad);
  double from_m = NearestTo(ray.At(0.0));
  const auto hit_on = [&](const OnChord& met) {
    return OnTerrain(met.hit, met.begin, met.direction, from_m, pixel_angle_rad);
  };
  double look_m =
      expected_m > 0.0 ? std::min(kBehind * expected_m + 0.5 * near_end_m, end_m) : end_m;
  while (from_m < end_m) {
    if (ground_.is_solid && from_m + ray.fan().ChordFrom(from_m, off_rad) < look_m) {
      const auto ahead = MeetOnChord(ray, from_m, look_m);
      if (ahead && ahead->length_m - ahead->hit.distance_m < near_end_m) return hit_on(*ahead);
      if (!ahead) {
        from_m = look_m;
        look_m = end_m;
        continue;
      }
      from_m += kBefore * ahead->hit.distance_m / ahead->length_m * (look_m - from_m);
    }
    const double to_m = std::min(from_m + ray.fan().ChordFrom(from_m, off_rad), end_m);
    if (const auto met = MeetOnChord(ray, from_m, to_m)) return hit_on(*met);
    from_m = to_m;
    look_m = end_m;
  }
  return {};
}

double SceneGeometry::NearestTo(const glm::dvec3& point) const {
  const auto [low, high] = ground_.terrain->Bounds();
  return glm::length(glm::clamp(point, low, high) - point);
}

double SceneGeometry::FarthestFrom(const glm::dvec3& point) const {
  const auto [low, high] = ground_.terrain->Bounds();
  return glm::length(glm::max(glm::abs(low - point), glm::abs(high - point)));
}

Hit SceneGeometry::Trace(const glm::dvec3& origin, const glm::dvec3& direction,
                         double pixel_angle_rad) const {
  if (ground_.terrain) {
    const auto hit = ground_.terrain->Intersect(origin, direction);
    if (hit && !HiddenByPlanet(origin, direction, hit->distance_m)) {
      return OnTerrain(*hit, origin, direction, 0.0, pixel_angle_rad);
    }
  }
  const double mu = std::clamp(glm::dot(direction, UpAt(origin)), -1.0, 1.0);
  if (mu >= 0.0) return {};
  const RayExtent extent =
      ExtentOf({AltitudeOf(origin), mu, 1.0, mu}, radius_m(), medium_.atmosphere_height_m);
  if (extent.end != RayEnd::kGround) return {};
  const glm::dvec3 point = origin + extent.end_m * direction;
  const glm::dvec3 up = UpAt(point);
  return {HitKind::kPlanet, extent.end_m, up, up, up, point, point, extent.end_m * pixel_angle_rad};
}

}  // namespace alpenglow::renderer
