// SPDX-License-Identifier: MIT
#include "renderer/picture/unoccluded_sky_pixels.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/math/constants.h"
#include "renderer/picture/frame_context.h"
#include "renderer/picture/pixel_shader.h"

namespace alpenglow::renderer {
namespace {

// Returns the angular radius around a pixel that must be free of ground and disks: a ray counts for
// pixels up to a filter's width away, and two pixels cover features between the azimuths of the
// skyline.
double AroundPixel(const FrameContext& frame) {
  return (4.0 * frame.filter().radius() + 2.0) * frame.camera().PixelAngle();
}

}  // namespace

UnoccludedSkyPixels::UnoccludedSkyPixels(const PixelShader& shader)
    : frame_(shader.frame()), around_rad_(AroundPixel(frame_)) {
  const CameraRays& camera = frame_.camera();
  const PreparedScene& scene = frame_.scene();
  const bool is_solid = scene.ground().is_solid || !scene.geometry().HasTerrain();
  if (!frame_.settings().skips_open_sky || !is_solid || !scene.spheres().empty() ||
      camera.HasLens() || frame_.moving().IsMoving())
    return;
  const glm::dvec3 up = scene.geometry().UpAt(camera.eye());
  const auto sees_sky = [&](const glm::dvec3& direction) {
    return shader.Trace({camera.eye(), camera.eye(), direction, direction}).kind == HitKind::kSky;
  };
  skyline_.emplace(up, ArcAround(up), 0.5 * camera.PixelAngle(), sees_sky);
}

Skyline::Arc UnoccludedSkyPixels::ArcAround(const glm::dvec3& up) const {
  const CameraRays& camera = frame_.camera();
  const int width = frame_.settings().width, height = frame_.settings().height;
  const Skyline::Arc whole{0.0, 2.0 * kPi};
  const auto shows = [&](const glm::dvec3& direction) {
    const auto at = camera.PlaceOf(direction);
    return at && (*at)[0] >= 0.0 && (*at)[0] <= width && (*at)[1] >= 0.0 && (*at)[1] <= height;
  };
  if (camera.IsPanorama() || shows(up) || shows(-up)) return whole;
  const glm::dvec3 middle = camera.Direction(0.5 * width, 0.5 * height);
  const glm::dvec3 ahead = middle - glm::dot(middle, up) * up, side = glm::cross(up, ahead);
  double first = 0.0, last = 0.0;
  constexpr int kPlaces = 64;
  constexpr double kAndSteps = 1.1;  // margin for the azimuth steps of the skyline
  for (int i = 0; i <= kPlaces; ++i) {
    const double x = static_cast<double>(i) / kPlaces * width;
    const double y = static_cast<double>(i) / kPlaces * height;
    for (const glm::dvec3& direction : {camera.Direction(x, 0.0), camera.Direction(x, height),
                                        camera.Direction(0.0, y), camera.Direction(width, y)}) {
      const double azimuth = std::atan2(glm::dot(direction, side), glm::dot(direction, ahead));
      const double across = glm::length(direction - glm::dot(direction, up) * up);
      const double beside = std::asin(std::min(std::sin(kAndSteps * around_rad_) / across, 1.0));
      first = std::min(first, azimuth - beside);
      last = std::max(last, azimuth + beside);
    }
  }
  // If the zenith or nadir is just outside the picture, the azimuth can turn by more than half a
  // circle between two places of the border.
  if (last - first > kPi) return whole;
  return {Skyline::AzimuthOf(ahead, up) + first, last - first};
}

bool UnoccludedSkyPixels::Has(int x, int y) const {
  if (!skyline_) return false;
  const glm::dvec3 middle = frame_.camera().Direction(x + 0.5, y + 0.5);
  if (frame_.limb().IsSteepAt(middle)) return false;
  const auto is_near = [&](const glm::dvec3& to_disk, double radius_rad) {
    return glm::length(middle - to_disk) < 2.0 * radius_rad + around_rad_;
  };
  const Lighting& light = frame_.light();
  if (is_near(light.source.direction.seen, light.source.radius_rad)) return false;
  if (light.moon &&
      is_near(light.moon->direction.seen, light.moon->radius_rad + glm::length(light.moon_turn)))
    return false;
  return skyline_->IsBelow(middle, around_rad_);
}

}  // namespace alpenglow::renderer
