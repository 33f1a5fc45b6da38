// SPDX-License-Identifier: MIT
// What lights air and land of a picture: the sun or, once that brings less, the moon.
//
// Where both count, with the sun 5 to 11 degrees down and a bright moon up, the lesser stands beside it
// (light_beside.h). The sun is what the moon leaves of it: a whole picture is lit as its eye is.
#pragma once

#include <glm/vec4.hpp>
#include <optional>

#include "atmosphere/colour/spectrum.h"
#include "atmosphere/sun/sun.h"
#include "atmosphere/sun/time.h"
#include "viewer/air/solved_air.h"

namespace alpenglow {

struct KeyLight {
  SunPosition disk;      // where it is seen from the eye, and how wide
  glm::vec4 irradiance;  // above the air, one value a band [W m^-2 nm^-1]
  bool is_moon = false;
};

/// Without the moon before it. @param sun  apparent.
[[nodiscard]] KeyLight SunAsKey(const SunPosition& sun, const Medium& medium);

struct LightsOfSky {
  KeyLight key;
  std::optional<KeyLight> beside;  // where it brings over a thousandth of what the key brings
};

/// Sun and moon; the key is the one that brings more light to a level place at the eye, in the band
/// next to 555 nm. No other planet has this moon: there it is the sun.
[[nodiscard]] LightsOfSky LightsOfSkyAt(const GeodeticPosition& eye, const UtcInstant& now,
                                        const SunPosition& sun, const SolvedAir& air);

/// Of a light and the sky that it makes, on a level plane [lux]. @param colour  of the air's bands.
[[nodiscard]] double LevelIlluminance(const KeyLight& key, const SolvedAir& air, double altitude_m,
                                      const BandColour& colour);

}  // namespace alpenglow
