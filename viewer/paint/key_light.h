// SPDX-License-Identifier: MIT
// What lights air and land of a picture: the sun, the moon, or both. The sun is what the moon leaves of
// it: a whole picture is lit as its eye is.
//
// One of them throws the shadows: the sun until it has set on all land, 2.5 degrees down, then a moon
// that counts.
#pragma once

#include <glm/vec4.hpp>
#include <optional>

#include "atmosphere/colour/spectrum.h"
#include "atmosphere/sun/sun.h"
#include "atmosphere/sun/time.h"
#include "viewer/air/solved_air.h"

namespace alpenglow::viewer {

struct KeyLight {
  SunPosition disk;      // where it is seen from the eye, and how wide
  glm::vec4 irradiance;  // above the air, one value a band [W m^-2 nm^-1]
  bool is_moon = false;

  [[nodiscard]] LightSource source() const {
    return is_moon ? LightSource::kMoon : LightSource::kSun;
  }
};

/// Without the moon before it. @param sun  apparent.
[[nodiscard]] KeyLight SunAsKey(const SunPosition& sun, const Medium& medium);

struct LightsOfSky {
  KeyLight key;                   // what throws shadows
  std::optional<KeyLight> other;  // where it counts
};

/// Sun and moon. A light counts that brings over a ten-thousandth of what the other brings to a level
/// place at the eye, in the band next to 555 nm. No other planet has this moon: there it is the sun.
[[nodiscard]] LightsOfSky LightsOfSkyAt(const GeodeticPosition& eye, const UtcInstant& now,
                                        const SunPosition& sun, const SolvedAir& air);

/// Of a light and the sky that it makes, on a level plane [lux]. @param colour  of the air's bands.
[[nodiscard]] double LevelIlluminance(const KeyLight& key, const SolvedAir& air, double altitude_m,
                                      const BandColour& colour);

}  // namespace alpenglow::viewer
