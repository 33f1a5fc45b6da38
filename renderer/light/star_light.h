// SPDX-License-Identifier: MIT
// Stars and planets as light that arrives at the top of the air over a place.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "atmosphere/sun/moon_disk.h"
#include "atmosphere/sun/time.h"
#include "renderer/ground/band_light.h"

namespace alpenglow {

/// A point of light.
struct StarLight {
  glm::dvec3 direction;  // unit, refracted
  BandLight irradiance;  // W m^-2 nm^-1
};

/// In the frame east, north, up of the eye: planets, then stars, each brightest first; without
/// those that stand behind the moon.
/// @param faintest  [magnitudes]. @param wavelengths_nm  of the bands, as `colour` has them.
[[nodiscard]] std::vector<StarLight> StarLightsOver(const GeodeticPosition& eye,
                                                    const UtcInstant& instant, double faintest,
                                                    const MoonDisk& moon,
                                                    const std::vector<double>& wavelengths_nm,
                                                    const BandColour& colour);

}  // namespace alpenglow
