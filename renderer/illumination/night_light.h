// SPDX-License-Identifier: MIT
// This header provides the light of the night in the bands of a picture: light pollution of towns,
// stars and planets, and the light of a moonless night sky above the air (night_sky.h) with its
// scattering by air and media.
//
// Skyglow models light pollution by the brightness that it adds to the zenith. Endless lamps all
// around emit the radiance L uniformly upwards, and air that scatters equally in all directions
// scatters it once. Along a ray of transmittance T the result is
//
//   (1 - T) J,      J = L / 2.
//
// It increases from the zenith to the horizon with the amount of air along the ray, increases with
// haze, and also appears in front of mountains. J is chosen so that the zenith over the ground of
// the place has the requested brightness, which includes kNaturalZenith of the natural sky
// (night_sky.h). Light domes over single towns and the lamps themselves are not drawn.
//
// Half of the luminance of J has the colour of sodium lamps, a black body of 2050 K, and half that
// of white LED, a black body of 4000 K; four bands do not resolve the emission lines of these
// lamps.
//
// Airglow has the colours of a dark sky, U 22.28, B 22.64, V 21.61, R 20.87, I 19.71 (Patat 2003,
// Astron. Astrophys. 400, 1183). Zodiacal light has the colour of the sun, and faint stars that of
// a black body of 5000 K. Air and media along a ray of transmittance T add (1 - T) J, where
//
//   J = (mean radiance from above + what grey ground, a sixth, sends back) / 2
//
// is the light that molecules, or droplets deep in a cloud, scatter from light incident on all
// sides. Compared with extinction alone, it makes the zenith brighter by a tenth and the horizon
// twice as bright. This approximation suits a light that itself varies by a factor of two from
// night to night. The absorption of J by ozone and soot is neglected. Lamps of towns add to J.
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "atmosphere/astronomy/night_sky.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/ray/single_scattering.h"
#include "atmosphere/refraction/refracted_view.h"
#include "atmosphere/time_place/geodesy.h"
#include "atmosphere/time_place/time.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Returns J of light pollution [W m^-2 sr^-1 nm^-1]; 0 in air that does not scatter.
/// @param zenith  [V magnitudes per square arcsecond]; J is 0 if it is darker than kNaturalZenith.
/// @param ground_m  altitude of the place with this zenith, >= 0.
[[nodiscard]] Spectrum Skyglow(double zenith, double ground_m, const SingleScattering<float>& air,
                               const BandColour& colour);

/// A star or planet at the top of the air.
struct StarLight {
  glm::dvec3 direction;  // unit, refracted, in the frame of the picture
  Spectrum irradiance;   // W m^-2 nm^-1
  double lux = 0.0;      // the same, as illuminance
  /// Directions, like `direction`, at equal time steps while the shutter is open, the first one
  /// when it opens; empty: the light does not move.
  std::vector<glm::dvec3> way = {};
};

/// A long exposure, during which the heavens turn.
struct OpenShutter {
  double open_s = 0.0;
  int steps = 0;  // number of steps of StarLight::way
};

/// Returns an exposure of a duration.
/// @param open_s  >= 0.
/// @param pixel_angle_rad  between pixels; between two steps the path of a light is straight within
///     a tenth of it.
[[nodiscard]] OpenShutter OpenFor(double open_s, double pixel_angle_rad);

/// Illuminance of level ground by the sun above which other lights are invisible [lux]: the
/// brightest moon gives a ten-thousandth of it.
inline constexpr double kDaylight_lux = 5000.0;

/// Returns the faintest magnitude of stars and planets that are drawn: they brighten their pixel by
/// a thousandth of a uniform sky.
/// @param lux  illuminance of level ground by that sky, > 0.
/// @param pixel_angle_rad  between pixels.
[[nodiscard]] double FaintestStar(double lux, double pixel_angle_rad);

/// Returns planets, then stars, brightest first, at least as bright as `faintest`. Directions are
/// east, north, up at the eye, refracted (without dispersion). While the shutter is open, planets
/// move with the stars (they are off by 0.2 arcseconds a minute).
[[nodiscard]] std::vector<StarLight> StarLightsOver(const Place& eye, const UtcTime& instant,
                                                    const RefractedView& view,
                                                    const BandColour& colour, double faintest,
                                                    const OpenShutter& shutter = {});

/// Light of the night sky at one eye. Immutable, safe to use from many threads.
class NightLight {
 public:
  /// @param sky  in the frame of the picture.
  /// @param up  unit, at the eye.
  /// @param towns  Skyglow; empty: none.
  NightLight(const NightSky& sky, const SingleScattering<float>& air, const BandColour& colour,
             const glm::dvec3& up, double altitude_m,
             const std::optional<Spectrum>& towns = std::nullopt);

  /// Returns the radiance from above the air, W m^-2 sr^-1 nm^-1.
  [[nodiscard]] Spectrum Above(const glm::dvec3& direction) const;

  /// J: the radiance of an infinitely long path through the air.
  [[nodiscard]] const Spectrum& scattered() const { return scattered_; }

  /// Returns the irradiance of the ground, W m^-2 nm^-1, assuming that the sky is uniform.
  /// @param cos_up  between the surface's normal and the vertical.
  [[nodiscard]] Spectrum OnSurface(double cos_up) const;

 private:
  NightSky sky_;
  glm::dvec3 up_;
  double altitude_m_;
  Spectrum airglow_, zodiacal_, starlight_;  // per 1 cd/m^2, per 1/sr, per 1 cd/m^2
  Spectrum scattered_, level_;
};

}  // namespace alpenglow::renderer
