// SPDX-License-Identifier: MIT
#include "viewer/paint/star_points.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/number/constants.h"
#include "renderer/picture/star_pixels.h"
#include "viewer/shaders/uniform_blocks.h"

namespace alpenglow {
namespace {

glm::vec4 FirstFour(const StarBell& bell) { return {bell[0], bell[1], bell[2], bell[3]}; }

// Of pixels a plane one away has squares, which are seen at an angle and from farther away.
double PixelSolidAngle(const PaintedView& view, double along) {
  const double side = PixelAngle(view);
  return side * side * along * along * along;
}

}  // namespace

std::vector<StarPoint> StarPointsIn(const PaintedView& view, const StarrySky& sky) {
  const LandView axes = LandViewOf(view);
  const auto place = [](double share, double part, int side) {
    return 0.5 * side * (1.0 + share - part);
  };
  std::vector<StarPoint> points;
  for (const StarLight& light : sky.lights) {
    if (light.lux < sky.faintest_lux) continue;
    const glm::dvec3 towards = sky.turn * light.direction;
    const double along = glm::dot(towards, axes.forward);
    if (along <= 1e-3 || glm::length(towards - sky.to_moon) < sky.moon_radius_rad) continue;
    const double x = place(glm::dot(towards, axes.right) / glm::dot(axes.right, axes.right) / along,
                           view.part.x * view.part.z, view.width);
    const double y = place(glm::dot(towards, axes.up) / glm::dot(axes.up, axes.up) / along,
                           view.part.y * view.part.w, view.height);
    if (!(x > -kStarReach && x < view.width + kStarReach && y > -kStarReach &&
          y < view.height + kStarReach)) {
      continue;
    }
    const StarBell across = StarBellAround(x), up = StarBellAround(y);
    glm::vec4 radiance(0.0F);
    const auto per_sr = static_cast<float>(1.0 / PixelSolidAngle(view, along));
    for (std::size_t band = 0; band < light.irradiance.count; ++band)
      radiance[static_cast<glm::length_t>(band)] = per_sr * light.irradiance[band];
    points.push_back(
        {{std::floor(x) - kStarReach, std::floor(y) - kStarReach, std::floor(x), std::floor(y)},
         {glm::vec3(towards), 0.0F},
         radiance,
         FirstFour(across),
         FirstFour(up),
         {across[4], up[4], 0.0F, 0.0F}});
  }
  return points;
}

// Rodrigues' rotation about the celestial pole, westwards.
glm::dmat3 TurnOfSky(double latitude_rad, double seconds) {
  constexpr double kSiderealDay_s = 86164.0905;
  const double angle = -2.0 * kPi * seconds / kSiderealDay_s;
  const glm::dvec3 pole(0.0, std::cos(latitude_rad), std::sin(latitude_rad));
  glm::dmat3 turn(1.0);
  for (const glm::length_t axis : {0, 1, 2}) {
    glm::dvec3 unit(0.0);
    unit[axis] = 1.0;
    turn[axis] = std::cos(angle) * unit + std::sin(angle) * glm::cross(pole, unit) +
                 (1.0 - std::cos(angle)) * glm::dot(pole, unit) * pole;
  }
  return turn;
}

}  // namespace alpenglow
