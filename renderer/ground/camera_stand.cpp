// SPDX-License-Identifier: MIT
#include "renderer/ground/camera_stand.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/number/constants.h"
#include "atmosphere/text/error.h"
#include "renderer/ground/ground_heights.h"

namespace alpenglow::renderer {
namespace {

std::string TextOf(const GeodeticPosition& place) {
  return fmt::format("the eye at {:.6f}, {:.6f}", place.latitude_rad / kRadiansPerDegree,
                     place.longitude_rad / kRadiansPerDegree);
}

void RequireOverGround(const SceneGround& ground, const GeodeticPosition& place) {
  if (!ground.terrain) {
    if (place.height_m < 0.0) {
      throw InputError(fmt::format("{} is {:.1f} m high; the ground there is at 0 m", TextOf(place),
                                   place.height_m));
    }
    return;
  }
  const auto there = GroundHeightsAt(*ground.terrain, ground.frame, place);
  if (there && place.height_m < there->lowest_m) {
    throw InputError(fmt::format("{} is {:.1f} m high; the ground there is at {:.1f} m",
                                 TextOf(place), place.height_m, there->lowest_m));
  }
}

/// Throws InputError where the place is too far from the scene's.
CameraStand StandOver(const SceneGround& ground, const GeodeticPosition& place) {
  const LocalFrame there(ground.frame.ellipsoid(), place);
  const auto in_frame = [&](const glm::dvec3& axis) {
    return ground.frame.EnuFromEcef(there.EcefFromEnu(Vector<Enu>{axis})).xyz;
  };
  const CameraStand stand{
      ground.frame.EnuFromGeodetic(place).xyz,
      {in_frame({1.0, 0.0, 0.0}), in_frame({0.0, 1.0, 0.0}), in_frame({0.0, 0.0, 1.0})}};
  constexpr double kFarthest_m = 500e3;
  const double radius_m = ground.frame.ellipsoid().equatorial_radius_m;
  const double along_m = radius_m * std::acos(std::min(stand.frame_from_enu[2].z, 1.0));
  if (along_m > kFarthest_m) {
    throw InputError(
        fmt::format("{} is {:.0f} km from the scene's place; at most {:.0f} km can be "
                    "shown from one frame",
                    TextOf(place), 1e-3 * along_m, 1e-3 * kFarthest_m));
  }
  return stand;
}

}  // namespace

CameraStand StandOfScene(const SceneGround& ground) {
  return {{0.0, 0.0, ground.eye_height_m}, glm::dmat3(1.0)};
}

CameraStand StandAt(const SceneGround& ground, const GeodeticPosition& place) {
  const CameraStand stand = StandOver(ground, place);
  RequireOverGround(ground, place);
  return stand;
}

double GroundHeightUnder(const SceneGround& ground, const GeodeticPosition& place) {
  if (!ground.terrain) return 0.0;
  StandOver(ground, place);  // throws where the place is too far away
  const auto there = GroundHeightsAt(*ground.terrain, ground.frame, place);
  return there ? there->highest_m : 0.0;
}

MovingCamera CameraOn(const SceneGround& ground, const Camera& camera,
                      std::span<const CameraPose> poses, int width, int height) {
  if (poses.empty()) return CameraRays(camera, width, height, StandOfScene(ground));
  std::vector<CameraRays> steps;
  for (const CameraPose& pose : poses) {
    Camera there = camera;
    there.heading_rad = pose.heading_rad;
    there.pitch_rad = pose.pitch_rad;
    there.roll_rad = pose.roll_rad;
    there.fov_rad = pose.fov_rad;
    steps.emplace_back(there, width, height, StandAt(ground, pose.place));
  }
  return MovingCamera(std::move(steps));
}

}  // namespace alpenglow::renderer
