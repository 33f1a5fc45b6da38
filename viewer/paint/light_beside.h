// SPDX-License-Identifier: MIT
// The lesser of sun and moon where both count: its sky as seen from the eye, with the planet under it,
// and what falls on land. Added to a picture of the greater (NIGHT_PASS of picture.frag.glsl). Land
// throws no shadows of it; air before land is as bright, for each part of light that it takes, as the sky
// over the horizon behind or, of a sun that is down, as the mean of that sky and dark ground.
#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "viewer/paint/key_light.h"

namespace alpenglow {

/// One value a band.
struct LightBeside {
  /// Columns of azimuth from north over east, rows of elevation from the nadir up, in the middle of
  /// texels; row by row [W m^-2 sr^-1 nm^-1].
  static constexpr int kColumns = 256, kRows = 128;

  std::vector<glm::vec4> sky;
  glm::vec4 level;     // of that sky on level ground [W m^-2 nm^-1]
  glm::vec4 direct;    // of the light itself, on what faces it [W m^-2 nm^-1]
  glm::vec3 to_light;  // unit; east, north and up of the eye
};

[[nodiscard]] LightBeside LightBesideOf(const KeyLight& light, const GeodeticPosition& eye,
                                        const SolvedAir& air);

}  // namespace alpenglow
