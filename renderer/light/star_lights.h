// SPDX-License-Identifier: MIT
// Stars and planets over a place, as light in the bands of a picture.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "atmosphere/ray/bent_view.h"
#include "atmosphere/sun/geodesy.h"
#include "atmosphere/sun/time.h"
#include "renderer/ground/band_light.h"

namespace alpenglow::renderer {

/// A point of light as it arrives at the top of the air.
struct StarLight {
  glm::dvec3 direction;  // unit, refracted, in the frame of the picture
  BandLight irradiance;  // W m^-2 nm^-1
  double lux = 0.0;      // the same as illuminance
  /// Where it stands at even steps of the time that the shutter is open, as `direction`, first as it
  /// opens; empty: it stands still.
  std::vector<glm::dvec3> way = {};
};

/// A shutter that is open so long that the heavens turn.
struct OpenShutter {
  double open_s = 0.0;
  int steps = 0;  // of StarLight::way
};

/// @param open_s  >= 0. @param pixel_angle_rad  between pixels: from step to step the way of a light
/// is straight within a tenth of it.
[[nodiscard]] OpenShutter OpenFor(double open_s, double pixel_angle_rad);

/// Where the sun brings more than this to a level plane nobody sees what else shines [lux]: the
/// brightest moon is a ten-thousandth of it.
inline constexpr double kDaylight_lux = 5000.0;

/// Of stars and planets that are drawn [magnitude]: those that make their pixel brighter by a
/// thousandth than an even sky would be.
/// @param lux  of that sky on a level plane, > 0. @param pixel_angle_rad  between pixels.
[[nodiscard]] double FaintestStar(double lux, double pixel_angle_rad);

/// Planets, then stars, brightest first, as bright as `faintest` at least. Directions: east, north,
/// up at the eye, where bent rays show them (without their dispersion). Planets move with the stars while the shutter is open (0.2 arcseconds a minute).
[[nodiscard]] std::vector<StarLight> StarLightsOver(const GeodeticPosition& eye,
                                                    const UtcInstant& instant, const BentView& view,
                                                    const BandColour& colour, double faintest,
                                                    const OpenShutter& shutter = {});

}  // namespace alpenglow::renderer
