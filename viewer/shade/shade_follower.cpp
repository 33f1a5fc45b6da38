// SPDX-License-Identifier: MIT
#include "viewer/shade/shade_follower.h"

#include <chrono>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "atmosphere/text/error.h"
#include "viewer/shade/heights_around.h"

namespace alpenglow::viewer {
namespace {

constexpr double kSunStep = 0.2;     // of the disk's radius
constexpr double kPlaceStep = 0.2;   // of the ground's half width
constexpr int kLinesOfAFrame = 256;  // two megabytes at a thousand columns

// Of the frame of one place in that of another, with the distance of their origins.
glm::dmat4 BetweenFrames(const LocalFrame& to, const LocalFrame& from) {
  glm::dmat4 matrix(1.0);
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 unit(0.0);
    unit[axis] = 1.0;
    matrix[axis] = glm::dvec4(to.EnuFromEcef(from.EcefFromEnu(Vector<Enu>{unit})).xyz, 0.0);
  }
  matrix[3] = glm::dvec4(to.EnuFromEcef(from.EcefFromEnu(Point<Enu>{})).xyz, 1.0);
  return matrix;
}

double DistanceBetween(const LocalFrame& a, const LocalFrame& b) {
  return glm::length(a.EnuFromGeodetic(b.origin()).xyz);
}

bool AreOne(const LocalFrame& a, const LocalFrame& b) {
  return a.origin().latitude_rad == b.origin().latitude_rad &&
         a.origin().longitude_rad == b.origin().longitude_rad;
}

}  // namespace

class ShadeFollower::Maker {
 public:
  std::shared_ptr<const Made> operator()(const Request& request) {
    const auto begin = std::chrono::steady_clock::now();
    if (!IsKept(request)) Keep(request);
    ShadeMap map =
        heights_ ? ShadeMapOf(*heights_, request.to_sun, request.sun_radius_rad, request.size.cells)
                 : ShadeMap{};
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    return std::make_shared<const Made>(
        Made{request.frame, request.to_sun, std::move(map), took.count()});
  }

 private:
  [[nodiscard]] bool IsKept(const Request& request) const {
    return kept_ && kept_->ground == request.ground && kept_->size == request.size &&
           AreOne(kept_->frame, request.frame);
  }
  void Keep(const Request& request) {
    kept_ = request;
    heights_.reset();
    if (!request.ground) return;
    const ShadeSize& size = request.size;
    const auto grid = (*request.ground)(request.frame.origin(), size.half_width_m, size.samples);
    if (grid)
      heights_ = HeightsAround(*grid, request.frame, size.half_width_m,
                               size.nodes_a_sample * size.samples);
  }

  std::optional<Request> kept_;
  std::optional<HeightRaster> heights_;
};

ShadeFollower::ShadeFollower(const Ellipsoid& ellipsoid) : ellipsoid_(ellipsoid), maker_(Maker()) {}

void ShadeFollower::SetGround(GroundSampler sampler) {
  ground_ = sampler ? std::make_shared<const GroundSampler>(std::move(sampler)) : nullptr;
}

void ShadeFollower::SetSize(const ShadeSize& size) { size_ = size; }

ShadeFollower::Request ShadeFollower::RequestFor(const GeodeticPosition& eye,
                                                 const SunPosition& sun) const {
  const LocalFrame here(ellipsoid_, eye);
  LocalFrame frame(ellipsoid_, {eye.latitude_rad, eye.longitude_rad, 0.0});
  // Heights are kept as long as the eye is near the middle of them.
  if (asked_ && DistanceBetween(asked_->frame, frame) < kPlaceStep * size_.half_width_m)
    frame = asked_->frame;
  const Vector<Ecef> to_sun =
      here.EcefFromEnu(DirectionFromAngles(sun.elevation_rad, sun.azimuth_rad));
  return {ground_, size_, frame, glm::normalize(frame.EnuFromEcef(to_sun).xyz),
          sun.angular_radius_rad};
}

bool ShadeFollower::Suits(const Request& asked, const Request& wanted) const {
  return asked.ground == wanted.ground && asked.size == wanted.size &&
         AreOne(asked.frame, wanted.frame) &&
         glm::length(asked.to_sun - wanted.to_sun) < kSunStep * wanted.sun_radius_rad;
}

void ShadeFollower::Ask(const GeodeticPosition& eye, const SunPosition& sun) {
  const Request wanted = RequestFor(eye, sun);
  if (asked_ && Suits(*asked_, wanted)) return;
  asked_ = wanted;
  maker_.Ask(wanted);
}

void ShadeFollower::TakeFinished() {
  std::optional<std::shared_ptr<const Made>> made = maker_.Take();
  if (!made) return;
  coming_ = std::move(*made);
  texture_.TakeOver({coming_, &coming_->map});
}

void ShadeFollower::Upload(int lines, int unit) {
  if (!coming_) return;
  if (texture_.Upload(lines, unit)) used_ = std::exchange(coming_, nullptr);
}

void ShadeFollower::Follow(const GeodeticPosition& eye, const SunPosition& sun, int unit) {
  // A sun that outruns the maps must not keep them from ever being shown.
  if (!maker_.Busy() && !coming_) Ask(eye, sun);
  if (!coming_) TakeFinished();
  Upload(kLinesOfAFrame, unit);
}

void ShadeFollower::Settle(const GeodeticPosition& eye, const SunPosition& sun, int unit) {
  Ask(eye, sun);
  maker_.Wait();
  TakeFinished();
  Upload(std::numeric_limits<int>::max(), unit);
}

bool ShadeFollower::IsOf(const GeodeticPosition& eye, const SunPosition& sun) const {
  const double near = std::cos(3.0 * kRadiansPerDegree);
  if (!used_) return false;
  const LocalFrame here(ellipsoid_, eye);
  const Vector<Ecef> to_sun =
      here.EcefFromEnu(DirectionFromAngles(sun.elevation_rad, sun.azimuth_rad));
  return glm::dot(glm::normalize(used_->frame.EnuFromEcef(to_sun).xyz), used_->to_sun) > near;
}

glm::dmat4 ShadeFollower::MapFromEye(const GeodeticPosition& eye) const {
  ALPENGLOW_ENSURE(texture_.Shades(), ==, true);
  return BetweenFrames(used_->frame, LocalFrame(ellipsoid_, eye));
}

}  // namespace alpenglow::viewer
