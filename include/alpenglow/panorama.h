// SPDX-License-Identifier: MIT
/// @file
/// Panoramas of the whole sphere around one observer, for lighting.
#pragma once

#include <string>
#include <vector>

#include <alpenglow/export.h>
#include <alpenglow/image.h>
#include <alpenglow/progress.h>
#include <alpenglow/sky.h>
#include <alpenglow/sun_and_moon.h>

namespace ALPENGLOW_EXPORT alpenglow {

/// The direction in the centre of a panorama. East is +x in all programs; panoramas are never
/// mirrored.
enum class PanoramaCentre {
  kNorth,    ///< geographic: north
  kBlender,  ///< +x, east
  kOpenExr,  ///< +z, south
  kThreeJs,  ///< +x, east
  kUnity,    ///< +x, east
  kGodot     ///< +z, south
};

/// Size and content of a panorama.
struct PanoramaOptions {
  int width = 2048;         ///< in [1, 32768]
  int height = 1024;        ///< in [1, 32768]
  double altitude_m = 2.0;  ///< of the observer, in [-12000, 1e9]; below 0 the view is that from 0
  SunInSky sun;             ///< its default stands 45 degrees high in the south
  PanoramaCentre centre = PanoramaCentre::kNorth;  ///< convention of the program that reads it
  bool draws_sun = false;      ///< draw the disk: a few pixels of some 1e9 cd/m^2
  bool draws_compass = false;  ///< paint N, E, S and W on the horizon, to check the orientation
  /// Layers of polarisation, without the disk and the compass: "stokes_q" and "stokes_u" (linear
  /// sRGB [cd/m^2]; Q is positive for light that vibrates along the vertical of the picture, U from
  /// its lower left to its upper right), and "polarisation" (of the luminance: degree in [0, 1], and
  /// angle in degrees clockwise from the vertical, in [-90, 90]).
  std::vector<std::string> layers;
};

/// Renders the sky and the ground around an observer, on all processors: longitude-latitude, row 0
/// at the zenith. The ground has the albedo of the atmosphere and is seen through the air.
///
/// Error of the luminance against evaluation at the centres of pixels, relative to it or to 1e-4 of
/// the brightest pixel: below 0.1 % (rms) with the sun above 10 degrees, below 0.3 % down to -10
/// degrees in the air of the earth (asserted by panorama_test). Relative to it or to a thousandth
/// of the mean of the sky it is below 0.75 % (rms) over the sky in every preset and with every
/// mixture of aerosols, in mist and with narrow lobes to either side (asserted by same_light_test).
/// Throws InputError for a member out of range, an unknown layer, and for an atmosphere whose
/// wavelengths show no colours (Atmosphere::ColourOf), and Cancelled if `progress` ends the work.
/// @param sky       light of an atmosphere.
/// @param options   see there.
/// @param progress  receives the fraction of rows that are done; may be empty.
[[nodiscard]] HdrImage RenderPanorama(const Sky& sky, const PanoramaOptions& options,
                                      const ProgressFunction& progress = {});

/// Returns the illuminance of sun and sky on a horizontal plane at the observer [lx]; the horizon
/// cuts the disk of the sun. Throws InputError as RenderPanorama() does.
/// @param sky         light of an atmosphere.
/// @param altitude_m  of the observer, in [-12000, 1e9].
/// @param sun         position of the sun.
[[nodiscard]] double HorizontalIlluminance(const Sky& sky, double altitude_m, const SunInSky& sun);

}  // namespace alpenglow
