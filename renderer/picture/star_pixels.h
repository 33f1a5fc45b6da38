// SPDX-License-Identifier: MIT
// Stars and planets in a picture: points whose light is spread over the pixels around them.
//
// A light of illuminance E brings a pixel of the solid angle Omega the radiance w E / Omega, with w
// from a bell of half a pixel's deviation over 5 x 5 pixels, whose sum is one: the illuminance in a
// picture is that of the light whatever its size, and nothing twinkles as a star moves on.
#pragma once

#include <array>
#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <unordered_map>
#include <vector>

#include "renderer/camera/camera_rays.h"
#include "renderer/ground/band_light.h"
#include "renderer/light/star_lights.h"

namespace alpenglow {

inline constexpr int kStarReach = 2;
/// Shares of the pixels around the one that a place lies in, along one side; their sum is one.
using StarBell = std::array<double, 2 * kStarReach + 1>;
[[nodiscard]] StarBell StarBellAround(double place);

/// Of one picture. Immutable.
class StarPixels {
 public:
  /// What is left of light that falls in at a place of the picture; nothing where something stands
  /// before it.
  using Left = std::function<std::optional<BandLight>(double x, double y)>;

  /// @param lights  brightest first.
  StarPixels(const CameraRays& camera, int width, int height, const std::vector<StarLight>& lights,
             const Left& left);

  /// Radiance to add to a pixel, W m^-2 sr^-1 nm^-1; null: nothing.
  [[nodiscard]] const BandLight* At(int x, int y) const;
  /// Of those that are in the picture, brightest first.
  [[nodiscard]] const std::vector<glm::dvec3>& directions() const { return directions_; }

 private:
  void Spread(const CameraRays& camera, double x, double y, const BandLight& irradiance);

  int width_, height_;
  std::unordered_map<int, BandLight> pixels_;
  std::vector<glm::dvec3> directions_;
};

}  // namespace alpenglow
