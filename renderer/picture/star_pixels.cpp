// SPDX-License-Identifier: MIT
#include "renderer/picture/star_pixels.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace alpenglow {
namespace {

/// Of the pixel around a place of the picture.
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
                       const std::vector<StarLight>& lights, const Left& left)
    : width_(width), height_(height) {
  for (const StarLight& light : lights) {
    const auto place = camera.PlaceOf(light.direction);
    if (!place) continue;
    const auto [x, y] = *place;
    if (!(x > -kStarReach && x < width + kStarReach && y > -kStarReach && y < height + kStarReach))
      continue;
    const std::optional<BandLight> through = left(x, y);
    if (!through) continue;
    directions_.push_back(light.direction);
    Spread(camera, x, y, *through * light.irradiance);
  }
}

void StarPixels::Spread(const CameraRays& camera, double x, double y, const BandLight& irradiance) {
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

}  // namespace alpenglow
