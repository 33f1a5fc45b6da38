// SPDX-License-Identifier: MIT
// The night sky without moon: stars to V 6.0 and planets as point sources, and the diffuse light of
// airglow, zodiacal light and faint stars, outside the air that scatters.
//
// Stars: 5080 of the Bright Star Catalogue (data/bright_stars.csv), with proper motion, precession
// and nutation (IAU 2006/2000A); aberration (20 arcseconds) and parallax (under 1) are neglected.
// Light of magnitude V outside the air: 2.54e-6 lux 10^(-0.4 V) (Cox 2000, Allen's Astrophysical
// Quantities, 2.3). The colour is that of a black body with the same B - V (Ballesteros 2012, EPL
// 97, 34008):
//
//   T = 4600 K (1 / (0.92 (B - V) + 1.7) + 1 / (0.92 (B - V) + 0.62)).
//
// Airglow comes from a layer 90 km high. The path through it is longer towards the horizon
// (van Rhijn 1921), with z the angle from the zenith:
//
//   V(z) = 1 / sqrt(1 - (R sin z / (R + 90 km))^2)
//
// Zodiacal light is from the table of Leinert et al. (1998, Astron. Astrophys. Suppl. 127, 1, table
// 17), over ecliptic latitude and longitude from the sun, with the colour of the sun. The light of
// stars too faint to be drawn individually is a disk that thins out away from the plane of the
// galaxy, with b the galactic latitude, and is brighter towards its centre,
//
//   S = 24 S10 (1 + 0.45 cos l) / sqrt(sin^2 b + 0.12^2),
//
// with a bulge of 400 S10 around l = 0, b = -5 and the lane of dust from there to Cygnus, where
// seven tenths of the light are lost. This is a coarse model of the maps of star counts of Roach
// and Megill (1961, Astrophys. J. 133, 228). 1 S10 is a star of V = 10 in a square degree: 27.78
// magnitudes a square arcsecond. Airglow is the rest of the 21.6 magnitudes of a dark zenith (Patat
// 2003, Astron. Astrophys. 400, 1183): 180 S10, as in years of medium solar activity.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "atmosphere/astronomy/ephemeris.h"
#include "atmosphere/time_place/geodesy.h"
#include "atmosphere/time_place/time.h"

namespace alpenglow::atmosphere {

/// Returns the stars up to a magnitude, brightest first, without refraction. The catalogue is read
/// on the first call.
[[nodiscard]] std::vector<PointLight> StarsAt(const UtcTime& instant, double faintest = 6.0);

/// Returns the illuminance outside the air [lux], on a plane that faces the light.
[[nodiscard]] double IlluminanceOf(double magnitude);

/// Returns the magnitude of an illuminance, the inverse of IlluminanceOf. @param lux  > 0.
[[nodiscard]] double MagnitudeOf(double lux);

/// Returns the temperature [K] of a black body of the colour B - V, in [-0.4, 3].
[[nodiscard]] double TemperatureOf(double colour_index);

/// Returns the luminance of a surface brightness in V magnitudes per square arcsecond [cd/m^2]:
/// 10.8e4 10^(-0.4 V).
[[nodiscard]] double LuminanceOfSurfaceBrightness(double magnitudes);

/// Surface brightness of the natural zenith, away from the Milky Way [V magnitudes a square
/// arcsecond].
inline constexpr double kNaturalZenith = 21.6;

/// Returns the surface brightness of the zenith of a moonless night with light pollution [V
/// magnitudes a square arcsecond]. For the classes of Bortle (2001, Sky & Telescope 101, 2, 126) it
/// is the middle of the range that readers of sky quality meters assign to the class. Classes 8 and
/// 9, which have no upper limit, are 0.5 and 1.25 magnitudes brighter than 7; 1 and 2 are the
/// natural sky.
/// @param bortle_class  1 to 9.
[[nodiscard]] double ZenithOfBortleClass(int bortle_class);

/// Luminance of one S10 [cd/m^2].
inline constexpr double kS10_cd_per_m2 = 8.29e-7;

/// Returns the path length in a layer 90 km high along a ray, relative to the zenith. @param sin_z
/// in [0, 1].
[[nodiscard]] double VanRhijn(double sin_z);

/// Returns the zodiacal light [W m^-2 sr^-1 um^-1] at 500 nm, constant within 15 degrees of the
/// sun.
/// @param longitude_rad  from the sun, any value; latitude_rad in [-pi/2, pi/2].
[[nodiscard]] double ZodiacalLight(double longitude_rad, double latitude_rad);

/// Returns the light [S10] of stars fainter than V 6.
[[nodiscard]] double Starlight(double longitude_rad, double latitude_rad);

/// Components of the light of the night sky in a direction.
struct NightRadiance {
  double airglow_cd_per_m2;
  double zodiacal_per_irradiance;  // [1/sr], per solar irradiance at 1 au
  double starlight_cd_per_m2;
};

/// Orientation of the sky over a place. Its frame can be rotated together with that of the picture.
class NightSky {
 public:
  NightSky(const Place& place, const UtcTime& instant);

  /// @param frame_from_enu  a rotation.
  [[nodiscard]] NightSky InFrame(const glm::dmat3& frame_from_enu) const;

  /// @param direction, up  unit vectors in the frame, initially east, north, up.
  /// @param altitude_m  altitude of the observer: above the layer there is no airglow.
  [[nodiscard]] NightRadiance Towards(const glm::dvec3& direction, const glm::dvec3& up,
                                      double altitude_m) const;

 private:
  glm::dmat3 ecliptic_from_frame_;
  glm::dmat3 galactic_from_frame_;
  double sun_longitude_rad_;
};

}  // namespace alpenglow::atmosphere
