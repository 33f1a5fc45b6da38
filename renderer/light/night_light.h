// SPDX-License-Identifier: MIT
// What air scatters of the lamps of towns, said by how bright they make the zenith.
//
// Lamps without end all around send light up evenly, L from every direction below; air that favours
// no direction scatters it once. Along a ray of transmittance T that is
//
//   (1 - T) J,      J = L / 2,
//
// which rises from the zenith to the horizon as the air does that one looks through, thickens with
// haze, and stands before mountains too. J is chosen so that the zenith over the ground of the place
// has the brightness asked for, of which kNaturalZenith is the sky's own (night_sky.h). A dome of
// light over one town, in one direction, is not drawn, nor are the lamps.
//
// Half of the luminance of J is that of sodium lamps, of the colour of a black body of 2050 K, half
// that of white LED, of 4000 K: four bands do not resolve the lines that they have.
//
// Stars and planets over a place, as light in the bands of a picture.
//
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
// ozone and soot absorb of J is left out. Lamps of towns add to J (night_light.h).
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "atmosphere/ray/bent_view.h"
#include "atmosphere/ray/single_scattering.h"
#include "atmosphere/sun/geodesy.h"
#include "atmosphere/sun/night_sky.h"
#include "atmosphere/sun/time.h"
#include "renderer/ground/band_light.h"

namespace alpenglow::renderer {

/// J [W m^-2 sr^-1 nm^-1].
/// @param zenith  [V magnitudes a square arcsecond], nothing of towns where it is darker than
/// kNaturalZenith. @param ground_m  altitude of the place that has it, >= 0.
[[nodiscard]] BandLight TownLight(double zenith, double ground_m, const AirIntegrator<float>& air,
                                  const BandColour& colour);

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
