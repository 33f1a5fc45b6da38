// SPDX-License-Identifier: MIT
#include "renderer/surface/scene_geometry.h"

#include <tbb/parallel_for.h>

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

// Rays are straight above this number of scale heights, where air bends them by a ten-thousandth of
// the value at the ground.
constexpr double kScaleHeightsThatBend = 9.0;
// Greatest change of height in a step, in scale heights: the midpoint rule is then within 1 % of
// the bending.
constexpr double kHeightOfStep = 0.08;
// Air deeper than this is not needed: its density is held constant.
constexpr double kDeepest_m = -2000.0;

/// A ray in its vertical plane, relative to the eye: x along its initial direction, y upwards
/// across it.
struct InPlane {
  glm::dvec2 at, direction;
};

/// The ray equation in a plane through the planet's centre.
class PlaneOfRay {
 public:
  PlaneOfRay(const BendingAir& air, double height_m, double sine)
      : air_(air),
        centre_(-(air.planet_radius_m + height_m) *
                glm::dvec2(sine, std::sqrt(std::max(1.0 - sine * sine, 0.0)))) {}

  [[nodiscard]] double HeightOf(const glm::dvec2& at) const {
    return glm::length(at - centre_) - air_.planet_radius_m;
  }
  [[nodiscard]] glm::dvec2 Turn(const InPlane& ray) const {
    const glm::dvec2 up = glm::normalize(ray.at - centre_);
    const double height_m = std::max(HeightOf(ray.at), kDeepest_m);
    return CurvaturePerMetreAt(air_, height_m) * (up - glm::dot(up, ray.direction) * ray.direction);
  }
  /// Follows a ray up to a distance along its initial direction.
  [[nodiscard]] InPlane Followed(InPlane ray, double along_m) const {
    const double may_rise_m = kHeightOfStep * air_.UpperScaleHeight();
    const double least_sine = std::sqrt(may_rise_m / (2.0 * air_.planet_radius_m));
    while (ray.at.x < along_m) {
      const double left_m = (along_m - ray.at.x) / ray.direction.x;
      const double height_m = HeightOf(ray.at);
      const bool bends =
          height_m > kDeepest_m && height_m < kScaleHeightsThatBend * air_.UpperScaleHeight();
      const double sine = std::abs(glm::dot(ray.direction, glm::normalize(ray.at - centre_)));
      const double by_height_m = may_rise_m / std::max(sine, least_sine);
      ray = Stepped(ray, bends ? std::min(left_m, by_height_m) : left_m, bends);
      if (left_m <= by_height_m || !bends) break;
    }
    return ray;
  }

 private:
  [[nodiscard]] InPlane Stepped(const InPlane& ray, double step_m, bool bends) const {
    if (!bends) return {ray.at + step_m * ray.direction, ray.direction};
    const glm::dvec2 half = glm::normalize(ray.direction + 0.5 * step_m * Turn(ray));
    const glm::dvec2 middle = ray.at + 0.5 * step_m * half;
    return {ray.at + step_m * half, glm::normalize(ray.direction + step_m * Turn({middle, half}))};
  }

  const BendingAir& air_;
  glm::dvec2 centre_;
};

double SineOfGrazing(const BendingAir& air, double height_m) {
  return std::sin(GrazingElevation(air, std::max(height_m, 0.0)));
}

}  // namespace

// Nodes are densest around the ray that grazes the ground, within the angle that half a scale
// height subtends at the far end of a ray.
RefractedFan::RefractedFan(const BendingAir& air, const glm::dvec3& eye, const glm::dvec3& up,
                           double reach_m)
    : air_(air),
      up_(up),
      height_m_(AltitudeOverSphere(eye, air.planet_radius_m)),
      reach_m_(reach_m),
      most_curvature_per_m_(std::abs(RefractivitySlopeAt(air, 0.0))),
      grazing_sine_(SineOfGrazing(air, height_m_)),
      scale_(std::min(0.5 * air.UpperScaleHeight() / reach_m, 1.0)),
      first_(std::asinh((-1.0 - grazing_sine_) / scale_)),
      last_(std::asinh((1.0 - grazing_sine_) / scale_)),
      g_per_m_(static_cast<std::size_t>(kElevations) * (kDistances + 1)) {
  tbb::parallel_for(0, kElevations, [&](int i) {
    const double u = first_ + (last_ - first_) * i / (kElevations - 1);
    FillRow(std::clamp(grazing_sine_ + scale_ * std::sinh(u), -1.0, 1.0),
            &g_per_m_[static_cast<std::size_t>(i) * (kDistances + 1)]);
  });
}

double RefractedFan::EntersAir(double sine) const {
  const double bends_below_m = kScaleHeightsThatBend * air_.UpperScaleHeight();
  const double over_m = height_m_ - bends_below_m;
  if (over_m <= 0.0) return 0.0;
  const double radius_m = air_.planet_radius_m + height_m_;
  const double enters = radius_m * radius_m * sine * sine - over_m * (2.0 * radius_m - over_m);
  if (sine >= 0.0 || enters <= 0.0) return std::numeric_limits<double>::infinity();
  return -radius_m * sine - std::sqrt(enters);
}

void RefractedFan::FillRow(double sine, float* row) const {
  const double enters_m = EntersAir(sine);
  if (!(enters_m < reach_m_)) return;
  const PlaneOfRay plane(air_, height_m_, sine);
  InPlane ray{{enters_m, 0.0}, {1.0, 0.0}};
  row[0] = static_cast<float>(-0.5 * plane.Turn(ray).y);
  for (int i = 1; i <= kDistances; ++i) {
    const double share = static_cast<double>(i) / kDistances;
    const double along_m = share * share * reach_m_;
    ray = plane.Followed(ray, enters_m + along_m);
    row[i] = static_cast<float>(-ray.at.y / (along_m * along_m));
  }
}

double RefractedFan::RowOf(double sine) const {
  const double u = std::asinh((sine - grazing_sine_) / scale_);
  return std::clamp((u - first_) / (last_ - first_), 0.0, 1.0) * (kElevations - 1);
}

double RefractedFan::ChordFrom(double along_m, double off_rad) const {
  const double b = 4.0 * off_rad / std::max(most_curvature_per_m_, 1e-15);
  return 0.5 * b + std::sqrt(0.25 * b * b + 2.0 * b * along_m);
}

double RefractedFan::EndOfChord(double off_rad) const {
  return 2.0 * off_rad / std::max(most_curvature_per_m_, 1e-15);
}

// A refracted ray never lies above its initial direction, and this line does not lie above the
// parabola, up to terms of third order.
double RefractedFan::SinksBelow(const FanRay& ray, double height_m) const {
  constexpr double kMargin = 1.05;
  const double a = (1.0 - ray.sine() * ray.sine()) / (2.0 * (air_.planet_radius_m + height_m_));
  const double over_m = height_m_ - height_m;
  const double root = ray.sine() * ray.sine() - 4.0 * a * over_m;
  if (ray.sine() >= 0.0 || root < 0.0) return std::numeric_limits<double>::infinity();
  return kMargin * 2.0 * std::max(over_m, 0.0) / (std::sqrt(root) - ray.sine());
}

// Gently bending air bends rays less than the ground curves: the sine of a rising ray keeps
// growing.
double RefractedFan::RisesAbove(const FanRay& ray, double height_m) const {
  if (ray.sine() <= 0.0) return std::numeric_limits<double>::infinity();
  return std::max(height_m - height_m_, 0.0) / ray.sine();
}

FanRay::FanRay(const RefractedFan& fan, const glm::dvec3& origin, const glm::dvec3& direction)
    : fan_(&fan),
      origin_(origin),
      direction_(direction),
      sine_(std::clamp(glm::dot(direction, fan.up_), -1.0, 1.0)),
      enters_m_(fan.EntersAir(sine_)) {
  const glm::dvec3 across = fan.up_ - sine_ * direction;
  across_ = across / std::max(glm::length(across), 1e-9);  // rays to or from the zenith do not bend
  const double row = fan.RowOf(sine_);
  const int below = std::min(static_cast<int>(row), RefractedFan::kElevations - 2);
  share_ = static_cast<float>(row - below);
  row_ = &fan.g_per_m_[static_cast<std::size_t>(below) * (RefractedFan::kDistances + 1)];
}

glm::dvec3 FanRay::At(double along_m) const {
  const glm::dvec3 straight = origin_ + along_m * direction_;
  const double in_air_m = along_m - enters_m_;
  if (!(in_air_m > 0.0)) return straight;
  const double node =
      RefractedFan::kDistances * std::sqrt(std::min(in_air_m / fan_->reach_m_, 1.0));
  const int before = std::min(static_cast<int>(node), RefractedFan::kDistances - 1);
  const auto way = static_cast<float>(node - before);
  const float* here = row_ + before;
  const float* next = here + RefractedFan::kDistances + 1;
  const float g = (1.0F - way) * (here[0] + share_ * (next[0] - here[0])) +
                  way * (here[1] + share_ * (next[1] - here[1]));
  return straight - in_air_m * in_air_m * static_cast<double>(g) * across_;
}

// This is |p - c| - R without cancellation.
double AltitudeOverSphere(const glm::dvec3& point, double radius_m) {
  const double across = point.x * point.x + point.y * point.y;
  const double q = across + point.z * (2.0 * radius_m + point.z);
  return q / (std::sqrt(across + (radius_m + point.z) * (radius_m + point.z)) + radius_m);
}

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

TerrainSunlight::TerrainSunlight(const SceneGround& ground, const glm::dvec3& to_light,
                                 double radius_rad) {
  // At -3 degrees a beam has touched the planet 330 km away, and passes 4 km above ground that is
  // 100 km nearer to the sun than the place it lights.
  constexpr double kLowestSun_rad = -3.0 * kRadiansPerDegree;
  if (!ground.terrain || std::asin(to_light.z) < kLowestSun_rad) return;
  if (ground.is_one_surface) {
    method_.emplace<ShadowHeights>(ground.terrain->mesh(), to_light, radius_rad);
  } else {
    method_.emplace<SunProbes>(*ground.terrain, to_light, radius_rad);
  }
}

bool TerrainSunlight::IsBroken() const { return !std::holds_alternative<Unbroken>(method_); }

SunlitPath TerrainSunlight::Along(const glm::dvec3& origin, const glm::dvec3& unit,
                                  double length_m) const {
  if (const auto* heights = std::get_if<ShadowHeights>(&method_))
    return heights->Along(origin, unit, length_m);
  if (const auto* probes = std::get_if<SunProbes>(&method_))
    return probes->Along(origin, unit, length_m);
  return length_m > 0.0 ? SunlitPath{{0.0, length_m}} : SunlitPath{};
}

}  // namespace alpenglow::renderer
