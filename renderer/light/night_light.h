// SPDX-License-Identifier: MIT
// The light of a night without moon in the bands of a picture: what arrives from above the air
// (night_sky.h), and what air and fog scatter of it.
//
// Airglow has the colours of a dark sky, U 22.28, B 22.64, V 21.61, R 20.87, I 19.71 (Patat 2003,
// Astron. Astrophys. 400, 1183); zodiacal light that of the sun; faint stars that of a black body
// of 5000 K. Air and fog along a ray of transmittance T send (1 - T) J, where
//
//   J = (mean radiance from above + what grey ground, a sixth, sends back) / 2
//
// is what molecules, or droplets deep in a cloud, would scatter of light that comes from all sides.
// It makes the zenith brighter by a tenth than extinction alone, and the horizon by as much as it
// is: an approximation, for light that itself varies by a factor of two from night to night. What
// ozone and soot absorb of J is left out. Lamps of towns add to J (town_light.h).
#pragma once

#include <glm/vec3.hpp>
#include <optional>

#include "atmosphere/colour/spectrum.h"
#include "atmosphere/ray/single_scattering.h"
#include "atmosphere/sun/night_sky.h"
#include "renderer/ground/band_light.h"

namespace alpenglow::renderer {

/// At one eye. Immutable, safe to ask from many threads.
class NightLight {
 public:
  /// @param sky  in the frame of the picture. @param up  unit, at the eye.
  /// @param towns  TownLight; nothing: there are none.
  NightLight(const NightSky& sky, const AirIntegrator<float>& air, const BandColour& colour,
             const glm::dvec3& up, double altitude_m,
             const std::optional<BandLight>& towns = std::nullopt);

  /// From above the air, W m^-2 sr^-1 nm^-1.
  [[nodiscard]] BandLight Above(const glm::dvec3& direction) const;

  /// J: what air without an end would send.
  [[nodiscard]] const BandLight& scattered() const { return scattered_; }

  /// On the ground, W m^-2 nm^-1. @param cos_up  between the surface's normal and the vertical:
  /// as of a sky that is even all around.
  [[nodiscard]] BandLight OnSurface(double cos_up) const;

 private:
  NightSky sky_;
  glm::dvec3 up_;
  double altitude_m_;
  BandLight airglow_, zodiacal_, starlight_;  // of 1 cd/m^2, of 1/sr, of 1 cd/m^2
  BandLight scattered_, level_;
};

}  // namespace alpenglow::renderer
