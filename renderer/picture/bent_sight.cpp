// SPDX-License-Identifier: MIT
// Where bent rays of a picture lead, and whether that shows.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/number/constants.h"
#include "atmosphere/sun/moon.h"
#include "renderer/picture/scene_state.h"

namespace alpenglow {
namespace {

/// The direction in the same vertical plane that stands so high.
glm::dvec3 AtElevation(const glm::dvec3& direction, const glm::dvec3& up, double elevation_rad) {
  const glm::dvec3 across = direction - glm::dot(direction, up) * up;
  const double length = glm::length(across);
  if (!(length > 0.0)) return direction;  // at the zenith
  return std::cos(elevation_rad) / length * across + std::sin(elevation_rad) * up;
}

double Elevation(const glm::dvec3& direction, const glm::dvec3& up) {
  return std::asin(std::clamp(glm::dot(direction, up), -1.0, 1.0));
}

/// How much flatter the sun's disk is than round at its lower limb, or its colours apart at its
/// rim [rad].
double ChangeOfDisk(const BentView& view, double elevation_rad, double radius_rad,
                    std::size_t bands) {
  const auto lift = [&](double elevation, std::size_t band) {
    return elevation - view.TrueElevation(elevation, band);
  };
  const double lower = std::max(elevation_rad - radius_rad, view.horizon_rad());
  const double flatter = lift(lower, 0) - lift(std::max(elevation_rad, lower), 0);
  return std::max(flatter, std::abs(lift(lower, 0) - lift(lower, bands - 1)));
}

}  // namespace

double BentSight::ElevationOf(const glm::dvec3& direction) const {
  return Elevation(direction, up);
}

glm::dvec3 BentSight::TrueDirection(const glm::dvec3& direction, std::size_t band) const {
  return AtElevation(direction, up, view.TrueElevation(ElevationOf(direction), band));
}

std::shared_ptr<const BentSight> SceneState::BentSightOf(const PictureFrame& frame,
                                                         const Shot& shot) const {
  const CameraRays& camera = frame.camera();
  const double half_pixel = 0.5 * camera.PixelAngle();
  const glm::dvec3 up = geometry.UpAt(camera.eye());
  const double height_m = std::max(geometry.AltitudeOf(camera.eye()), 0.0);
  // The margin around the picture is that of what stands on its edge.
  const auto in_picture = [&](const glm::dvec3& direction, double margin_rad) {
    const auto at = camera.PlaceOf(direction);
    const double margin = margin_rad / camera.PixelAngle();
    return at && (*at)[0] > -margin && (*at)[0] < frame.settings.width + margin &&
           (*at)[1] > -margin && (*at)[1] < frame.settings.height + margin;
  };
  const auto horizon_in_picture = [&](double elevation_rad) {
    constexpr int kPlaces = 16;
    bool above = false, below = false;
    for (int i = 0; i <= kPlaces * kPlaces; ++i) {
      const double x = i % kPlaces * frame.settings.width / (kPlaces - 1.0);
      const double y = i / kPlaces * frame.settings.height / (kPlaces - 1.0);
      (Elevation(camera.Direction(x, y), up) > elevation_rad ? above : below) = true;
    }
    return above && below;
  };
  const double radius_rad = frame.light.sun_radius_rad;
  constexpr double kLow_rad = 10.0 * kRadiansPerDegree;
  const double sun_rad = Elevation(frame.light.to_sun, up);
  const double geometric_rad = -std::acos(geometry.radius_m() / (geometry.radius_m() + height_m));
  const bool may_see_disk = sun_rad < kLow_rad && sun_rad > geometric_rad - 2.0 * radius_rad &&
                            in_picture(frame.light.to_sun, 2.0 * radius_rad);
  const bool may_see_sea = !geometry.HasTerrain() && horizon_in_picture(geometric_rad);
  if (!may_see_disk && !may_see_sea) return nullptr;
  const glm::dmat3 frame_from_enu = StandOf(shot).frame_from_enu;
  const SunPosition sun = SunAt(EyeOf(shot), shot.instant);
  const MoonPosition moon = MoonAt(EyeOf(shot), shot.instant);
  auto bent = std::make_shared<BentSight>(
      BentSight{BentView(medium, height_m), up,
                frame_from_enu * DirectionFromAngles(sun.elevation_rad, sun.azimuth_rad).xyz,
                frame_from_enu * DirectionFromAngles(moon.elevation_rad, moon.azimuth_rad).xyz});
  const bool moves_disk = may_see_disk && ChangeOfDisk(bent->view, sun_rad, radius_rad,
                                                       medium.wavelengths_nm.size()) > half_pixel;
  const bool moves_sea = may_see_sea && bent->view.horizon_rad() - geometric_rad > half_pixel;
  return moves_disk || moves_sea ? bent : nullptr;
}

Hit SceneState::OnBentSea(const CameraRay& ray, const PictureFrame& frame) const {
  const BentSight& bent = *frame.bent;
  const auto met = bent.view.ToGround(bent.ElevationOf(ray.direction));
  if (!met) return {};
  const glm::dvec3 across = AtElevation(ray.direction, bent.up, 0.0);
  const double sine = std::sin(0.5 * met->angle_rad);
  const glm::dvec3 foot = ray.eye - geometry.AltitudeOf(ray.eye) * bent.up;
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

}  // namespace alpenglow
