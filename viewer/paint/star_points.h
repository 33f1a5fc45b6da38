// SPDX-License-Identifier: MIT
// Stars and planets of a view as the squares of pixels that their light falls on: the renderer's
// bell (star_pixels.h), which brings the same lux at every size.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "atmosphere/ray/bent_view.h"
#include "renderer/light/star_lights.h"
#include "viewer/paint/painted_view.h"

namespace alpenglow::viewer {

/// As star.vert.glsl reads it, once a star.
struct StarPoint {
  glm::vec4 corner;      // lowest pixel, from the left and from below; the pixel of its middle
  glm::vec4 towards;     // unit, east, north, up at the eye
  glm::vec4 light;       // irradiance above the air by the solid angle of a pixel, one value a band
                         // [W m^-2 sr^-1 nm^-1]
  glm::vec4 across, up;  // shares of the first four columns and rows
  glm::vec4 last;        // and of the fifth of each
};

/// The stars as they stand over an eye.
struct StarrySky {
  const std::vector<StarLight>& lights;
  glm::dmat3 turn;      // from the directions of the lights to where they are now
  double faintest_lux;  // that is painted
  glm::dvec3 to_moon;   // unit, before what it hides
  double moon_radius_rad;
  const BentView* bent =
      nullptr;  // the air that lifted the lights; null: they are where they stand
};

/// Where a star of such a sky is seen, unit: its true direction turns, and where it is now the air
/// lifts it otherwise.
[[nodiscard]] glm::dvec3 TowardsStar(const StarLight& light, const StarrySky& sky);

/// Those that fall into the picture.
[[nodiscard]] std::vector<StarPoint> StarPointsIn(const PaintedView& view, const StarrySky& sky);

/// How the sky turns in a time: of directions east, north, up at a latitude.
[[nodiscard]] glm::dmat3 TurnOfSky(double latitude_rad, double seconds);

}  // namespace alpenglow::viewer
