// SPDX-License-Identifier: MIT
// The stars to V 6.0 and the planets, as points of light.
//
// Stars: 5080 of the Bright Star Catalogue (data/bright_stars.csv), with proper motion, precession
// and nutation (IAU 2006/2000A); aberration (20 arcseconds) and parallax (under 1) are left out.
// Light of magnitude V outside the air: 2.54e-6 lux 10^(-0.4 V) (Cox 2000, Allen's Astrophysical
// Quantities, 2.3). The colour of a black body stands for B - V (Ballesteros 2012, EPL 97, 34008):
//
//   T = 4600 K (1 / (0.92 (B - V) + 1.7) + 1 / (0.92 (B - V) + 0.62)).
//
// The sky of a night without moon, above the air that scatters.
//
// Airglow of a layer 90 km high, longer the lower one looks (van Rhijn 1921), z the angle from the
// zenith:     V(z) = 1 / sqrt(1 - (R sin z / (R + 90 km))^2)
//
// Zodiacal light by the table of Leinert et al. (1998, Astron. Astrophys. Suppl. 127, 1, table 17),
// over ecliptic latitude and longitude from the sun, of the sun's own colour. Light of the stars
// too faint to be drawn one by one: a disk that thins out away from the plane of the galaxy, b the
// galactic latitude, and brighter towards its centre,
//
//   S = 24 S10 (1 + 0.45 cos l) / sqrt(sin^2 b + 0.12^2),
//
// with a bulge of 400 S10 around l = 0, b = -5 and the lane of dust from there to Cygnus, where
// seven tenths of the light are lost; coarse, after the maps of star counts of Roach and Megill
// (1961, Astrophys. J. 133, 228). 1 S10 is a star of V = 10 in a square degree: 27.78 magnitudes a
// square arcsecond. Airglow is what of the 21.6 of a dark zenith (Patat 2003, Astron. Astrophys.
// 400, 1183) is left for it: 180 S10, as in years of a middling sun.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "atmosphere/sun/ephemeris.h"
#include "atmosphere/sun/geodesy.h"
#include "atmosphere/sun/time.h"

namespace alpenglow::atmosphere {

/// Stars up to a magnitude, brightest first, without refraction. The catalogue is read when it is
/// first asked for.
[[nodiscard]] std::vector<PointLight> StarsAt(const UtcInstant& instant, double faintest = 6.0);

/// Outside the air [lux], on a plane that faces the light.
[[nodiscard]] double IlluminanceOf(double magnitude);

/// Its inverse. @param lux  > 0.
[[nodiscard]] double MagnitudeOf(double lux);

/// Temperature [K] of a black body of the colour B - V, in [-0.4, 3].
[[nodiscard]] double TemperatureOf(double colour_index);

/// Light of V magnitudes a square arcsecond [cd/m^2]: 10.8e4 10^(-0.4 V).
[[nodiscard]] double LuminanceOfSurfaceBrightness(double magnitudes);

/// Of the natural zenith, away from the Milky Way [V magnitudes a square arcsecond].
inline constexpr double kNaturalZenith = 21.6;

/// The zenith of a moonless night among the lamps of towns [V magnitudes a square arcsecond]. Classes
/// of Bortle (2001, Sky & Telescope 101, 2, 126) are the middle of the ranges in which readers of sky
/// quality meters put them; 8 and 9, which have no end, 0.5 and 1.25 magnitudes brighter than 7; 1 and
/// 2 the natural sky. @param bortle_class  1 to 9.
[[nodiscard]] double ZenithOfBortleClass(int bortle_class);

/// In S10 [cd/m^2].
inline constexpr double kS10_cd_per_m2 = 8.29e-7;

/// Length of a layer 90 km high along a ray, relative to straight up. @param sin_z  in [0, 1].
[[nodiscard]] double VanRhijn(double sin_z);

/// [W m^-2 sr^-1 um^-1] at 500 nm. @param longitude_rad  from the sun, any; latitude_rad in
/// [-pi/2, pi/2]. Within 15 degrees of the sun as there.
[[nodiscard]] double ZodiacalLight(double longitude_rad, double latitude_rad);

/// [S10], of stars fainter than V 6.
[[nodiscard]] double Starlight(double longitude_rad, double latitude_rad);

/// The part of each, in a direction.
struct NightRadiance {
  double airglow_cd_per_m2;
  double zodiacal_per_irradiance;  // [1/sr], of the sun's irradiance at 1 au
  double starlight_cd_per_m2;
};

/// Where the heavens stand over a place. Its frame is turned along with that of the picture.
class NightSky {
 public:
  NightSky(const GeodeticPosition& place, const UtcInstant& instant);

  /// @param frame_from_enu  a rotation.
  [[nodiscard]] NightSky InFrame(const glm::dmat3& frame_from_enu) const;

  /// @param direction, up  unit, in the frame: east, north, up at first.
  /// @param altitude_m  of the eye: over the layer there is no airglow above.
  [[nodiscard]] NightRadiance Towards(const glm::dvec3& direction, const glm::dvec3& up,
                                      double altitude_m) const;

 private:
  glm::dmat3 ecliptic_from_frame_;
  glm::dmat3 galactic_from_frame_;
  double sun_longitude_rad_;
};

}  // namespace alpenglow::atmosphere
