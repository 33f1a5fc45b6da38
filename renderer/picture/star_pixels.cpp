// SPDX-License-Identifier: MIT
#include "renderer/picture/star_pixels.h"

#include <algorithm>
#include <cmath>

namespace alpenglow::renderer {

// A bell over the distance i - f from the place, where f in [-1/2, 1/2] is the place in its pixel,
//
//   exp(-(i - f)^2 / 2 s^2) = exp(-i^2 / 2 s^2) (exp(f / s^2))^i exp(-f^2 / 2 s^2),
//
// needs one exponential, since the last factor is common to all pixels.
StarBell StarBellAround(double place) {
  constexpr double kDeviation = 0.5, kPerVariance = 1.0 / (kDeviation * kDeviation);
  static const StarBell kAtCentre = [] {
    StarBell bell{};
    for (int i = -kStarReach; i <= kStarReach; ++i)
      bell.at(static_cast<std::size_t>(i + kStarReach)) = std::exp(-0.5 * kPerVariance * i * i);
    return bell;
  }();
  const double along = std::exp(kPerVariance * (place - std::floor(place) - 0.5));
  StarBell weights = kAtCentre;
  double after = 1.0, before = 1.0, sum = kAtCentre[kStarReach];
  for (std::size_t i = 1; i <= kStarReach; ++i) {
    sum += weights[kStarReach + i] *= after *= along;
    sum += weights[kStarReach - i] *= before /= along;
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

StarPixels::StarPixels(const CameraRays& camera, int width, int height,
                       const std::vector<StarLight>& lights, const Left& left, const Hidden& hidden)
    : width_(width), height_(height), spread_(width, height) {
  for (const StarLight& light : lights) {
    if (light.way.empty()) {
      AddPoint(camera, light, left);
    } else {
      AddTrail(camera, light, left, hidden);
    }
  }
}

bool StarPixels::IsNear(const glm::dvec2& place) const {
  return place.x > -kStarReach && place.x < width_ + kStarReach && place.y > -kStarReach &&
         place.y < height_ + kStarReach;
}

void StarPixels::AddPoint(const CameraRays& camera, const StarLight& light, const Left& left) {
  const auto at = camera.PlaceOf(light.direction);
  if (!at) return;
  const glm::dvec2 place{(*at)[0], (*at)[1]};
  if (!IsNear(place)) return;
  const std::optional<Spectrum> through = left(place.x, place.y);
  if (!through) return;
  directions_.push_back(light.direction);
  Spread(camera, place, *through * light.irradiance);
}

void StarPixels::AddTrail(const CameraRays& camera, const StarLight& light, const Left& left,
                          const Hidden& hidden) {
  const std::size_t known = spread_.size();
  const auto steps = static_cast<float>(light.way.size() - 1);
  for (std::size_t i = 0; i + 1 < light.way.size(); ++i) {
    const auto from = camera.PlaceOf(light.way[i]), to = camera.PlaceOf(light.way[i + 1]);
    if (!from || !to) continue;
    const double right = (*to)[0] - (*from)[0];  // the shorter way, across the seam of a panorama
    const double to_x =
        (*from)[0] + (camera.IsPanorama() ? std::remainder(right, 1.0 * width_) : right);
    AddStep(camera, {(*from)[0], (*from)[1]}, {to_x, (*to)[1]}, (1.0F / steps) * light.irradiance,
            left, hidden);
  }
  if (spread_.size() > known) directions_.push_back(light.direction);
}

// Transmittance changes little from end to end of a step. If ground hides one end, it is evaluated
// at every point.
void StarPixels::AddStep(const CameraRays& camera, const glm::dvec2& from, const glm::dvec2& to,
                         const Spectrum& irradiance, const Left& left, const Hidden& hidden) {
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  const int count = std::max(static_cast<int>(std::ceil(2.0 * length)), 1);
  const auto place = [&](int i) {
    const double share = (i + 0.5) / count;
    return glm::dvec2{std::lerp(from.x, to.x, share), std::lerp(from.y, to.y, share)};
  };
  std::optional<Spectrum> first, last;
  bool is_asked = false;
  for (int i = 0; i < count; ++i) {
    const glm::dvec2 at = place(i);
    if (!IsNear(at)) continue;
    if (!is_asked) {
      first = left(from.x, from.y);
      last = left(to.x, to.y);
      is_asked = true;
    }
    std::optional<Spectrum> through;
    if (!first || !last) {
      through = left(at.x, at.y);
    } else if (!hidden(at.x, at.y)) {
      const auto share = static_cast<float>((i + 0.5) / count);
      through = (1.0F - share) * *first + share * *last;
    }
    if (through) Spread(camera, at, (1.0F / static_cast<float>(count)) * (*through * irradiance));
  }
}

void StarPixels::Spread(const CameraRays& camera, const glm::dvec2& place,
                        const Spectrum& irradiance) {
  const double x = place.x, y = place.y;
  const StarBell across = StarBellAround(x), down = StarBellAround(y);
  for (int j = 0; j < 2 * kStarReach + 1; ++j) {
    for (int i = 0; i < 2 * kStarReach + 1; ++i) {
      const double share =
          across.at(static_cast<std::size_t>(i)) * down.at(static_cast<std::size_t>(j));
      spread_.Add(camera, static_cast<int>(std::floor(x)) + i - kStarReach,
                  static_cast<int>(std::floor(y)) + j - kStarReach,
                  static_cast<float>(share) * irradiance);
    }
  }
}

}  // namespace alpenglow::renderer
