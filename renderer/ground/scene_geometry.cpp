// SPDX-License-Identifier: MIT
#include "renderer/ground/scene_geometry.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/ray/ray.h"

namespace alpenglow::renderer {

// |p - c| - R without cancelling.
double AltitudeOverSphere(const glm::dvec3& point, double radius_m) {
  const double across = point.x * point.x + point.y * point.y;
  const double q = across + point.z * (2.0 * radius_m + point.z);
  return q / (std::sqrt(across + (radius_m + point.z) * (radius_m + point.z)) + radius_m);
}

namespace {

/// Nothing of the box around the terrain is lower: the farther from the middle, the higher.
double BottomOf(const SceneGround& ground) {
  return ground.terrain ? ground.terrain->Bounds().first.z : 0.0;
}

/// Of the box around the terrain: the farther from the middle, the higher over the sphere.
double TopOf(const SceneGround& ground, double radius_m) {
  if (!ground.terrain) return 0.0;
  const auto [low, high] = ground.terrain->Bounds();
  const glm::dvec3 across = glm::max(glm::abs(low), glm::abs(high));
  return AltitudeOverSphere({across.x, across.y, high.z}, radius_m);
}

}  // namespace

SceneGeometry::SceneGeometry(const SceneGround& ground, const Medium& medium, bool with_relief)
    : ground_(ground),
      medium_(medium),
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
  const GeodeticPosition& origin = ground_.frame.origin();
  return {origin.longitude_rad * std::cos(origin.latitude_rad) * radius_m() + point.x,
          origin.latitude_rad * radius_m() + point.y,
          std::max(AltitudeOf(point), 0.0),
          footprint_m,
          cosine,
          point.z};
}

// Whether the bare planet stands between the eye and terrain behind its horizon: the ray goes
// through it, comes out again before the terrain, and no terrain covers the planet there (a ray
// through a basin below the sphere is in free air).
bool SceneGeometry::HiddenByPlanet(const glm::dvec3& origin, const glm::dvec3& direction,
                                   double distance_m) const {
  const double mu = std::clamp(glm::dot(direction, UpAt(origin)), -1.0, 1.0);
  if (mu >= 0.0) return false;
  const double altitude = AltitudeOf(origin);
  const double deepest_m = -(radius_m() + altitude) * mu;
  if (distance_m < deepest_m) return false;  // it would have to come out beyond
  const RayExtent extent =
      ExtentOf({altitude, mu, 1.0, mu}, radius_m(), medium_.atmosphere_height_m);
  if (extent.end != RayEnd::kGround || 2.0 * deepest_m - extent.end_m > distance_m) return false;
  return !CoversPlanetAt(origin + deepest_m * direction);
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
    found.normal = MountainSurface::DetailedNormal(
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

// Where the ground is solid below its surface, nothing stands on a ray whose chord below it is in
// the air. So a long chord says up to where that is so, and a short one from there on what is met;
// of the long one, too, the end lies near enough to the ray.
Hit SceneGeometry::TerrainAlong(const FanRay& ray, double off_rad, double pixel_angle_rad,
                                double expected_m) const {
  constexpr double kBefore = 1.0 - 1e-4;  // the place that is met
  constexpr double kBehind = 1.01;        // what is expected
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
