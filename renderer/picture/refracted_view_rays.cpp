// SPDX-License-Identifier: MIT
#include "renderer/picture/refracted_view_rays.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/astronomy/moon.h"
#include "atmosphere/astronomy/sun.h"
#include "atmosphere/math/constants.h"
#include "renderer/picture/frame_context.h"

namespace alpenglow::renderer {
namespace {

/// Returns the direction in the same vertical plane at an elevation.
glm::dvec3 AtElevation(const glm::dvec3& direction, const glm::dvec3& up, double elevation_rad) {
  const glm::dvec3 across = direction - glm::dot(direction, up) * up;
  const double length = glm::length(across);
  if (!(length > 0.0)) return direction;  // at the zenith
  return std::cos(elevation_rad) / length * across + std::sin(elevation_rad) * up;
}

double Elevation(const glm::dvec3& direction, const glm::dvec3& up) {
  return std::asin(std::clamp(glm::dot(direction, up), -1.0, 1.0));
}

/// Largest distance between a chord and its bent ray, as an angle from the eye. Compared with exact
/// rays, moonlit crests of one pixel are off by 2.8 % of their light in one pixel of a thousand at
/// 0.04 pixels, and by 1.0 % at 0.005, for 1.01 times the time.
constexpr double kOffPixels = 0.005, kLeastOff_rad = 1e-4 * kRadiansPerDegree / 60.0;

/// Returns the larger of the flattening of a disk at its lower limb and the separation of its
/// colours at the limb [rad].
double ChangeOfDisk(const RefractedView& view, double elevation_rad, double radius_rad,
                    std::size_t bands) {
  const auto lift = [&](double elevation, std::size_t band) {
    return elevation - view.TrueElevation(elevation, band);
  };
  const double lower = std::max(elevation_rad - radius_rad, view.horizon_rad());
  const double flatter = lift(lower, 0) - lift(std::max(elevation_rad, lower), 0);
  return std::max(flatter, std::abs(lift(lower, 0) - lift(lower, bands - 1)));
}

/// Returns the largest lift [rad] of terrain and the horizon.
double MostLift(const FrameContext& frame, double eye_height_m) {
  const LandBend bend = LandBendOf(GentleAirOf(frame.scene().medium()), eye_height_m);
  return MostLiftOfPlanet(bend, eye_height_m,
                          frame.scene().geometry().FarthestFrom(frame.camera().eye()));
}

/// Elevations of the rays of a picture, and the least angle of a pixel where land may be refracted
/// visibly, at 16 x 16 places with those of its corners.
struct PictureExtent {
  double lowest_rad, highest_rad, least_pixel_rad;
};
PictureExtent ExtentOfPicture(const FrameContext& frame, const glm::dvec3& up) {
  constexpr int kPlaces = 16;
  // The pixels of a panorama shrink to points at the zenith and the nadir, where nothing is lifted.
  constexpr double kSteep_rad = 45.0 * kRadiansPerDegree;
  PictureExtent seen{0.5 * kPi, -0.5 * kPi, frame.camera().PixelAngle()};
  for (int i = 0; i < kPlaces * kPlaces; ++i) {
    const double x = i % kPlaces * frame.settings().width / (kPlaces - 1.0);
    const double y = i / kPlaces * frame.settings().height / (kPlaces - 1.0);
    const double elevation_rad = Elevation(frame.camera().Direction(x, y), up);
    seen.lowest_rad = std::min(seen.lowest_rad, elevation_rad);
    seen.highest_rad = std::max(seen.highest_rad, elevation_rad);
    if (std::abs(elevation_rad) > kSteep_rad) continue;
    const auto [across_rad, down_rad] = frame.camera().PixelExtentAt(x, y);
    seen.least_pixel_rad = std::min({seen.least_pixel_rad, across_rad, down_rad});
  }
  return seen;
}

/// Returns whether refraction may move the sea by more than an angle, in a picture that shows
/// elevations. It moves the sea most where a ray meets it at the lowest angle, by at most the
/// refraction of a plane layer.
bool MayMoveSea(const LimbView& limb, const PictureExtent& seen, double horizon_rad,
                double angle_rad) {
  if (seen.lowest_rad > horizon_rad) return false;
  if (seen.highest_rad > horizon_rad) return true;
  const double cosine = limb.GroundCosine(std::sin(seen.highest_rad));
  const BendingAir& air = limb.bending_air();
  const double bends = RefractivityAt(air, 0.0) - RefractivityAt(air, limb.altitude_m());
  return bends * std::sqrt(1.0 - cosine * cosine) > angle_rad * cosine;
}

/// Returns the angle, seen from the eye, between a ray to the sea and the place where it ends.
double LiftOfSea(const RefractedView& view, double radius_m, double height_m,
                 double elevation_rad) {
  const auto met = view.ToGround(elevation_rad);
  if (!met) return 0.0;
  const double sine = std::sin(0.5 * met->angle_rad);
  return elevation_rad - std::atan2(-(height_m + 2.0 * radius_m * sine * sine),
                                    radius_m * std::sin(met->angle_rad));
}

/// Returns whether the bare planet occludes the terrain that a ray meets: the ray enters the planet
/// before it, where no terrain covers the planet (a ray through a basin below the sphere is in free
/// air). Inside the planet the air of ground level continues.
bool HiddenByPlanet(const SceneGeometry& geometry, const RefractedGroundRay& met,
                    const BendingAir& air, const glm::dvec3& foot, const glm::dvec3& up,
                    const glm::dvec3& across, const glm::dvec3& point) {
  const glm::dvec3 from_centre = point + glm::dvec3(0.0, 0.0, geometry.radius_m());
  const double angle = std::atan2(glm::dot(from_centre, across), glm::dot(from_centre, up));
  if (angle < met.angle_rad) return false;
  const double bends =
      -RefractivitySlopeAt(air, 0.0) * geometry.radius_m() / (1.0 + air.refractivity);
  const double to_deepest = met.elevation_rad / (1.0 - bends);
  const double inside = met.angle_rad + std::min(to_deepest, 0.5 * (angle - met.angle_rad));
  const double sine = std::sin(0.5 * inside);
  return !geometry.CoversPlanetAt(foot + geometry.radius_m() *
                                             (std::sin(inside) * across - 2.0 * sine * sine * up));
}

/// Returns whether a ray descends all the way to a point that is not below the planet's sphere. The
/// chord to the point is not above the ray.
bool IsBeforeHorizon(const SceneGeometry& geometry, const CameraRay& ray, const glm::dvec3& point) {
  return geometry.AltitudeOf(point) >= 0.0 &&
         glm::dot(point - ray.origin, geometry.UpAt(point)) < 0.0;
}

}  // namespace

double RefractedViewRays::ElevationOf(const glm::dvec3& direction) const {
  return Elevation(direction, up);
}

glm::dvec3 RefractedViewRays::TrueDirection(const glm::dvec3& direction, std::size_t band) const {
  return AtElevation(direction, up, view.TrueElevation(ElevationOf(direction), band));
}

std::shared_ptr<const RefractedViewRays> RefractedViewRaysOf(const FrameContext& frame,
                                                             const Observer& observer) {
  const Medium& medium = frame.scene().medium();
  const SceneGeometry& geometry = frame.scene().geometry();
  const CameraRays& camera = frame.camera();
  const glm::dvec3 up = geometry.UpAt(camera.eye());
  const PictureExtent seen = ExtentOfPicture(frame, up);
  const double half_pixel = 0.5 * seen.least_pixel_rad;
  const double height_m = std::max(geometry.AltitudeOf(camera.eye()), 0.0);
  // The margin around the picture admits bodies that only touch its edge.
  const auto in_picture = [&](const glm::dvec3& direction, double margin_rad) {
    const auto at = camera.PlaceOf(direction);
    const double margin = margin_rad / camera.PixelAngle();
    return at && (*at)[0] > -margin && (*at)[0] < frame.settings().width + margin &&
           (*at)[1] > -margin && (*at)[1] < frame.settings().height + margin;
  };
  constexpr double kLow_rad = 10.0 * kRadiansPerDegree;
  const double geometric_rad = -std::acos(geometry.radius_m() / (geometry.radius_m() + height_m));
  const auto may_see = [&](const glm::dvec3& to_disk, double radius_rad) {
    const double elevation = Elevation(to_disk, up);
    return elevation < kLow_rad && elevation > geometric_rad - 2.0 * radius_rad &&
           in_picture(to_disk, 2.0 * radius_rad);
  };
  const Lighting& light = frame.light();
  const bool may_see_sun = may_see(light.source.direction.seen, light.source.radius_rad);
  const bool may_see_moon =
      light.moon && may_see(light.moon->direction.seen, light.moon->radius_rad);
  const bool may_see_sea =
      !geometry.HasTerrain() && MayMoveSea(frame.limb(), seen, geometric_rad, half_pixel);
  const bool moves_terrain = geometry.HasTerrain() && MostLift(frame, height_m) > half_pixel;
  if (!may_see_sun && !may_see_moon && !may_see_sea && !moves_terrain) return nullptr;
  const glm::dmat3& frame_from_enu = observer.from_eye.axes();
  const SunInSky& sun = observer.bodies.sun;
  const MoonPosition& moon = observer.bodies.moon;
  auto bent = std::make_shared<RefractedViewRays>(RefractedViewRays{
      RefractedView(medium, height_m), up,
      frame_from_enu * EnuFromAngles(sun.elevation_rad(), sun.azimuth_rad()).xyz,
      frame_from_enu * EnuFromAngles(moon.elevation_rad(), moon.azimuth_rad()).xyz});
  const auto moves = [&](const glm::dvec3& to_disk, double radius_rad) {
    return ChangeOfDisk(bent->view, Elevation(to_disk, up), radius_rad,
                        medium.wavelengths_nm.size()) > half_pixel;
  };
  const bool moves_disk =
      (may_see_sun && moves(light.source.direction.seen, light.source.radius_rad)) ||
      (may_see_moon && moves(light.moon->direction.seen, light.moon->radius_rad));
  const double horizon_rad = bent->view.horizon_rad();
  const bool moves_sea = may_see_sea && (seen.highest_rad > geometric_rad
                                             ? horizon_rad - geometric_rad
                                             : LiftOfSea(bent->view, geometry.radius_m(), height_m,
                                                         seen.highest_rad)) > half_pixel;
  if (moves_terrain) {
    bent->fan = std::make_shared<RefractedFan>(bent->view.air(), camera.eye(), up,
                                               geometry.FarthestFrom(camera.eye()));
  }
  bent->moves_ground = !geometry.HasTerrain() || moves_terrain;
  return moves_disk || moves_sea || moves_terrain ? bent : nullptr;
}

Hit OnRefractedRay(const FrameContext& frame, const CameraRay& ray, double expected_m) {
  const SceneGeometry& geometry = frame.scene().geometry();
  const RefractedViewRays& bent = *frame.bent();
  Hit hit;
  if (geometry.HasTerrain()) {
    const double off_rad = std::max(kOffPixels * frame.camera().PixelAngle(), kLeastOff_rad);
    hit = frame.geometry().TerrainAlong(FanRay(*bent.fan, ray.origin, ray.direction), off_rad,
                                        frame.camera().PixelAngle(), expected_m);
    if (hit.kind == HitKind::kTerrain && IsBeforeHorizon(geometry, ray, hit.point)) return hit;
  }
  const auto met = bent.view.ToGround(bent.ElevationOf(ray.direction));
  if (!met) return hit;
  const glm::dvec3 across = AtElevation(ray.direction, bent.up, 0.0);
  const glm::dvec3 foot = ray.eye - geometry.AltitudeOf(ray.eye) * bent.up;
  if (hit.kind == HitKind::kTerrain &&
      !HiddenByPlanet(geometry, *met, bent.view.air(), foot, bent.up, across, hit.point))
    return hit;
  const double sine = std::sin(0.5 * met->angle_rad);
  const glm::dvec3 point = foot + geometry.radius_m() * (std::sin(met->angle_rad) * across -
                                                         2.0 * sine * sine * bent.up);
  const glm::dvec3 up = geometry.UpAt(point);
  const double distance_m = glm::length(point - ray.origin);
  return {HitKind::kPlanet,
          distance_m,
          up,
          up,
          up,
          point,
          point,
          distance_m * frame.camera().PixelAngle()};
}

}  // namespace alpenglow::renderer
