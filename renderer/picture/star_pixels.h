// SPDX-License-Identifier: MIT
// Stars and planets in a picture: points whose light is spread over the pixels around them.
//
// A light of illuminance E adds the radiance w E / Omega to a pixel of solid angle Omega. The
// weights w come from a bell with a standard deviation of half a pixel over 5 x 5 pixels, whose sum
// is one: the illuminance in a picture equals that of the light for any picture size, and a moving
// star does not twinkle. During a long exposure the light is spread along its path, evenly in time,
// in steps of half a pixel.
#pragma once

#include <array>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "renderer/camera/camera_rays.h"
#include "renderer/illumination/night_light.h"
#include "renderer/picture/spread_light.h"

namespace alpenglow::renderer {

inline constexpr int kStarReach = 2;
/// Weights of the pixels around the one that contains a place, along one axis; their sum is one.
using StarBell = std::array<double, 2 * kStarReach + 1>;
[[nodiscard]] StarBell StarBellAround(double place);

/// Stars of one picture. Immutable.
class StarPixels {
 public:
  /// Returns the transmittance of light from space at a place of the picture; no value where
  /// something occludes it.
  using Left = std::function<std::optional<Spectrum>(double x, double y)>;

  /// Returns whether something occludes a place of the picture. Cheaper than Left, which also
  /// computes air.
  using Hidden = std::function<bool(double x, double y)>;

  /// @param lights  brightest first.
  StarPixels(const CameraRays& camera, int width, int height, const std::vector<StarLight>& lights,
             const Left& left, const Hidden& hidden);

  /// Returns the radiance to add to a pixel, W m^-2 sr^-1 nm^-1; null: nothing to add.
  [[nodiscard]] const Spectrum* At(int x, int y) const { return spread_.At(x, y); }
  /// Directions of the lights within the picture, brightest first.
  [[nodiscard]] const std::vector<glm::dvec3>& directions() const { return directions_; }

 private:
  /// Returns whether a place is near enough to light a pixel of the picture. Places are in pixels
  /// from the upper left corner.
  [[nodiscard]] bool IsNear(const glm::dvec2& place) const;
  void AddPoint(const CameraRays& camera, const StarLight& light, const Left& left);
  void AddTrail(const CameraRays& camera, const StarLight& light, const Left& left,
                const Hidden& hidden);
  void AddStep(const CameraRays& camera, const glm::dvec2& from, const glm::dvec2& to,
               const Spectrum& irradiance, const Left& left, const Hidden& hidden);
  void Spread(const CameraRays& camera, const glm::dvec2& place, const Spectrum& irradiance);

  int width_, height_;
  SpreadLight spread_;
  std::vector<glm::dvec3> directions_;
};

}  // namespace alpenglow::renderer
