// SPDX-License-Identifier: MIT
#include "renderer/picture/sky_pixels.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/math/constants.h"
#include "renderer/picture/pixel_shader.h"

namespace alpenglow::renderer {
namespace {

/// Returns the solid angle of the pixel around a place of the picture.
double SolidAngle(const CameraRays& camera, double x, double y) {
  const glm::dvec3 across = camera.Direction(x + 0.5, y) - camera.Direction(x - 0.5, y);
  const glm::dvec3 down = camera.Direction(x, y + 0.5) - camera.Direction(x, y - 0.5);
  return glm::length(glm::cross(across, down));
}

}  // namespace

StarBell StarBellAround(double place) {
  constexpr double kDeviation = 0.5;
  StarBell weights{};
  double sum = 0.0;
  for (int i = 0; i < 2 * kStarReach + 1; ++i) {
    const double off = (std::floor(place) + i - kStarReach + 0.5 - place) / kDeviation;
    sum += weights.at(static_cast<std::size_t>(i)) = std::exp(-0.5 * off * off);
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

StarPixels::StarPixels(const CameraRays& camera, int width, int height,
                       const std::vector<StarLight>& lights, const Left& left, const Hidden& hidden)
    : width_(width), height_(height) {
  for (const StarLight& light : lights) {
    if (light.way.empty()) {
      AddPoint(camera, light, left);
    } else {
      AddTrail(camera, light, left, hidden);
    }
  }
}

bool StarPixels::IsNear(const Place& place) const {
  return place.x > -kStarReach && place.x < width_ + kStarReach && place.y > -kStarReach &&
         place.y < height_ + kStarReach;
}

void StarPixels::AddPoint(const CameraRays& camera, const StarLight& light, const Left& left) {
  const auto at = camera.PlaceOf(light.direction);
  if (!at) return;
  const Place place{(*at)[0], (*at)[1]};
  if (!IsNear(place)) return;
  const std::optional<BandLight> through = left(place.x, place.y);
  if (!through) return;
  directions_.push_back(light.direction);
  Spread(camera, place, *through * light.irradiance);
}

void StarPixels::AddTrail(const CameraRays& camera, const StarLight& light, const Left& left,
                          const Hidden& hidden) {
  const std::size_t known = pixels_.size();
  const auto steps = static_cast<float>(light.way.size() - 1);
  for (std::size_t i = 0; i + 1 < light.way.size(); ++i) {
    const auto from = camera.PlaceOf(light.way[i]), to = camera.PlaceOf(light.way[i + 1]);
    if (!from || !to) continue;
    // Skip steps that cross the seam of a panorama.
    if (std::abs((*to)[0] - (*from)[0]) > 0.5 * width_ && camera.IsPanorama()) continue;
    AddStep(camera, {(*from)[0], (*from)[1]}, {(*to)[0], (*to)[1]},
            (1.0F / steps) * light.irradiance, left, hidden);
  }
  if (pixels_.size() > known) directions_.push_back(light.direction);
}

// Transmittance changes little from end to end of a step. If ground hides one end, it is evaluated
// at every point.
void StarPixels::AddStep(const CameraRays& camera, const Place& from, const Place& to,
                         const BandLight& irradiance, const Left& left, const Hidden& hidden) {
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  const int count = std::max(static_cast<int>(std::ceil(2.0 * length)), 1);
  const auto place = [&](int i) {
    const double share = (i + 0.5) / count;
    return Place{std::lerp(from.x, to.x, share), std::lerp(from.y, to.y, share)};
  };
  std::optional<BandLight> first, last;
  bool is_asked = false;
  for (int i = 0; i < count; ++i) {
    const Place at = place(i);
    if (!IsNear(at)) continue;
    if (!is_asked) {
      first = left(from.x, from.y);
      last = left(to.x, to.y);
      is_asked = true;
    }
    std::optional<BandLight> through;
    if (!first || !last) {
      through = left(at.x, at.y);
    } else if (!hidden(at.x, at.y)) {
      const auto share = static_cast<float>((i + 0.5) / count);
      through = (1.0F - share) * *first + share * *last;
    }
    if (through) Spread(camera, at, (1.0F / static_cast<float>(count)) * (*through * irradiance));
  }
}

void StarPixels::Spread(const CameraRays& camera, const Place& place, const BandLight& irradiance) {
  const auto [x, y] = place;
  const StarBell across = StarBellAround(x), down = StarBellAround(y);
  const double per_sr = 1.0 / SolidAngle(camera, x, y);
  for (int j = 0; j < 2 * kStarReach + 1; ++j) {
    const int row = static_cast<int>(std::floor(y)) + j - kStarReach;
    for (int i = 0; i < 2 * kStarReach + 1; ++i) {
      const int column = static_cast<int>(std::floor(x)) + i - kStarReach;
      if (row < 0 || row >= height_ || column < 0 || column >= width_) continue;
      const double share =
          across.at(static_cast<std::size_t>(i)) * down.at(static_cast<std::size_t>(j)) * per_sr;
      const auto at = pixels_.try_emplace(row * width_ + column, irradiance.count).first;
      at->second = at->second + static_cast<float>(share) * irradiance;
    }
  }
}

const BandLight* StarPixels::At(int x, int y) const {
  const auto found = pixels_.find(y * width_ + x);
  return found == pixels_.end() ? nullptr : &found->second;
}

namespace {

// Returns the angular radius around a pixel that must be free of ground and disks: a ray counts for
// pixels up to a filter's width away, and two pixels cover features between the azimuths of the
// skyline.
double AroundPixel(const FrameContext& frame) {
  return (4.0 * frame.filter().radius() + 2.0) * frame.camera().PixelAngle();
}

}  // namespace

OccludedSkyPixels::OccludedSkyPixels(const PixelShader& shader)
    : frame_(shader.frame()), around_rad_(AroundPixel(frame_)) {
  const CameraRays& camera = frame_.camera();
  const PreparedScene& scene = frame_.scene();
  const bool is_solid = scene.ground().is_solid || !scene.geometry().HasTerrain();
  if (!frame_.settings().skips_open_sky || !is_solid || camera.HasLens() ||
      frame_.moving().IsMoving())
    return;
  const glm::dvec3 up = scene.geometry().UpAt(camera.eye());
  const auto sees_sky = [&](const glm::dvec3& direction) {
    return shader.Trace({camera.eye(), camera.eye(), direction, direction}).kind == HitKind::kSky;
  };
  skyline_.emplace(up, ArcAround(up), 0.5 * camera.PixelAngle(), sees_sky);
}

Skyline::Arc OccludedSkyPixels::ArcAround(const glm::dvec3& up) const {
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

bool OccludedSkyPixels::Has(int x, int y) const {
  if (!skyline_) return false;
  const glm::dvec3 middle = frame_.camera().Direction(x + 0.5, y + 0.5);
  const auto is_near = [&](const glm::dvec3& to_disk, double radius_rad) {
    return glm::length(middle - to_disk) < 2.0 * radius_rad + around_rad_;
  };
  const Lighting& light = frame_.light();
  if (is_near(light.to_sun, light.sun_radius_rad)) return false;
  if (light.moon &&
      is_near(light.moon->to_moon, light.moon->radius_rad + glm::length(light.moon_turn)))
    return false;
  return skyline_->IsBelow(middle, around_rad_);
}

}  // namespace alpenglow::renderer
