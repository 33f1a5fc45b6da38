// SPDX-License-Identifier: MIT
#include "viewer/paint/star_points.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/number/constants.h"
#include "atmosphere/sun/sun.h"
#include "renderer/picture/star_pixels.h"
#include "viewer/shaders/uniform_blocks.h"

namespace alpenglow::viewer {
namespace {

glm::vec4 FirstFour(const StarBell& bell) { return {bell[0], bell[1], bell[2], bell[3]}; }

// Of pixels a plane one away has squares, which are seen at an angle and from farther away.
double PixelSolidAngle(const PaintedView& view, double along) {
  const double side = PixelAngle(view);
  return side * side * along * along * along;
}

/// The direction at another elevation.
glm::dvec3 AtElevation(const glm::dvec3& direction, double elevation_rad) {
  return DirectionFromAngles(elevation_rad, std::atan2(direction.x, direction.y)).xyz;
}

double Elevation(const glm::dvec3& direction) {
  return std::asin(std::clamp(direction.z, -1.0, 1.0));
}

}  // namespace

glm::dvec3 TowardsStar(const StarLight& light, const StarrySky& sky) {
  constexpr double kHigh_sine = 0.35;  // from there on refraction changes by 2" in half a minute
  const glm::dvec3& before = light.direction;
  if (sky.bent == nullptr || std::abs(before.z) > kHigh_sine) return sky.turn * before;
  const glm::dvec3 truly =
      sky.turn * AtElevation(before, sky.bent->TrueElevation(Elevation(before)));
  return AtElevation(truly, sky.bent->LiftedElevationOf(Elevation(truly)));
}

std::vector<StarPoint> StarPointsIn(const PaintedView& view, const StarrySky& sky) {
  const LandView axes = LandViewOf(view);
  // Stars about the picture may be lifted into it.
  constexpr double kMostLift_rad = 0.1 * kRadiansPerDegree;
  const double reach = kStarReach + 2.0 * kMostLift_rad / PixelAngle(view);
  const auto place = [](double share, double part, int side) {
    return 0.5 * side * (1.0 + share - part);
  };
  const auto place_of = [&](const glm::dvec3& towards, double margin) -> std::optional<glm::dvec2> {
    const double along = glm::dot(towards, axes.forward);
    if (along <= 1e-3) return std::nullopt;
    const double x = place(glm::dot(towards, axes.right) / glm::dot(axes.right, axes.right) / along,
                           view.part.x * view.part.z, view.width);
    const double y = place(glm::dot(towards, axes.up) / glm::dot(axes.up, axes.up) / along,
                           view.part.y * view.part.w, view.height);
    const bool is_in =
        x > -margin && x < view.width + margin && y > -margin && y < view.height + margin;
    return is_in ? std::optional(glm::dvec2(x, y)) : std::nullopt;
  };
  std::vector<StarPoint> points;
  for (const StarLight& light : sky.lights) {
    if (light.lux < sky.faintest_lux) continue;
    if (!place_of(sky.turn * light.direction, reach)) continue;
    const glm::dvec3 towards = TowardsStar(light, sky);
    const auto at = place_of(towards, kStarReach);
    if (!at || glm::length(towards - sky.to_moon) < sky.moon_radius_rad) continue;
    const double x = at->x, y = at->y, along = glm::dot(towards, axes.forward);
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

}  // namespace alpenglow::viewer
