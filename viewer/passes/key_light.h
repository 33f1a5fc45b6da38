// SPDX-License-Identifier: MIT
// The lights of the sky in a picture: the sun, the moon, or both.
//
// In a solar eclipse the sunlight is what the moon leaves uncovered as seen from the eye, for the
// whole picture. One light casts the shadows: the sun until it has set for all land, at 2.5 degrees
// below the horizontal, then the moon if it is bright enough.
#pragma once

#include <glm/vec4.hpp>
#include <optional>

#include "atmosphere/astronomy/sun.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/time_place/time.h"
#include "lut/camera_tables/air_tables.h"
#include "renderer/illumination/lighting.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

struct KeyLight {
  SunPosition disk;      // apparent position from the eye, and radius
  glm::vec4 irradiance;  // above the atmosphere, by band [W m^-2 nm^-1]
  bool is_moon = false;

  [[nodiscard]] LightSource source() const {
    return is_moon ? LightSource::kMoon : LightSource::kSun;
  }
};

/// Returns the sun as a light, not covered by the moon.
/// @param sun  apparent.
[[nodiscard]] KeyLight SunAsKey(const SunPosition& sun, const Medium& medium);

struct LightsOfSky {
  KeyLight key;                   // casts the shadows
  std::optional<KeyLight> other;  // if bright enough
};

/// Returns the lights of the sky. A light is included if its contribution on a level surface at the
/// eye, in the band nearest to 555 nm, exceeds a ten-thousandth of the other's. Planets other than
/// the Earth have no moon; their only light is the sun.
[[nodiscard]] LightsOfSky LightsOfSkyAt(const GeodeticPosition& eye, const UtcInstant& now,
                                        const SunPosition& sun, const SolvedAir& air);

/// Returns the illuminance [lux] of a level surface by a light and the sky that it lights.
/// @param colour  of the medium's bands.
[[nodiscard]] double LevelIlluminance(const KeyLight& key, const SolvedAir& air, double altitude_m,
                                      const BandColour& colour);

}  // namespace alpenglow::viewer
