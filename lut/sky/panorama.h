// SPDX-License-Identifier: MIT
// Q and U of a sky along rows of one zenith angle.
//
// At one zenith angle they are smooth in the azimuth from the sun's, Q an even and U an odd function
// of it: they are evaluated at equal steps over half a turn and go through them as cubics.
//
// Panoramas: the whole sphere around an observer as one latitude-longitude picture, for lighting.
//
// Row 0 is the zenith, the last row the nadir; columns are azimuths, never mirrored: what is to the
// right in the picture is to the right of one who looks at its centre from inside. Programs differ
// in what they take for the centre. With east as +x in all of them (north +y in Blender, -z in
// OpenEXR, three.js and Godot, +z in Unity):
//
//                              up   centre            a quarter to the left   north is
//   geographic                      north             west
//   Blender, Cycles            +z   +x = east         +y = north              +y
//   three.js, glTF             +y   +x = east         -z = north              -z
//   Unity (left-handed)        +y   +x = east         +z = north              +z
//   OpenEXR latlong            +y   +z = south        +x = east               -z
//   Godot                      +y   +z = south        +x = east               -z
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "atmosphere/number/constants.h"
#include "atmosphere/ray/single_scattering.h"
#include "lut/diffuse/multiple_scattering.h"
#include "lut/diffuse/polarised_light.h"
#include "lut/picture/image.h"
#include "lut/sky/sky_view.h"

namespace alpenglow::lut {

/// Of light between an observer and the end of a view, all orders, per unit solar irradiance
/// [1/sr]; the ground's is not polarised. U is positive from the lower left to the upper right, on
/// both sides of the sun.
class PolarisedRow {
 public:
  /// @param mu_s  cosine of the sun's zenith angle at the observer.
  /// `air` and `diffuse` must be of one medium; neither is kept.
  PolarisedRow(const AirIntegrator<float>& air, const DiffuseLight& diffuse, double altitude_m,
               double mu_s, double zenith_angle_rad);

  /// @param azimuth_rad  from the sun's, clockwise.
  /// Within 1e-3 of the radiance of what is evaluated there by day, 3e-3 in twilight, up to 10 km.
  [[nodiscard]] PolarisedLight At(double azimuth_rad) const;

 private:
  std::vector<PolarisedLight> nodes_;
};

enum class PanoramaOrientation { kNorth, kBlender, kOpenExr, kThree, kUnity, kGodot };
/// "north" (or "geographic"), "blender", "openexr", "three", "unity", "godot"; throws InputError
/// for another name.
[[nodiscard]] PanoramaOrientation PanoramaOrientationFromName(const std::string& name);
[[nodiscard]] std::string NameOf(PanoramaOrientation orientation);

/// Azimuth, from north over east [rad], of the middle of a picture.
[[nodiscard]] double CentreAzimuth(PanoramaOrientation orientation);

/// The sun as the picture shows it. Rays are straight.
struct PanoramaSun {
  double elevation_rad = 0.0;
  double azimuth_rad = kPi;  // from north over east
  double distance = 1.0;     // relative to the one for which the medium's irradiance is
  double angular_radius_rad = kSunAngularRadius_rad;
  double lower_for_air_rad = 0.0;  // as of SunPosition (sun.h)

  /// Returns the elevation [rad] of the sun that lights the air.
  [[nodiscard]] double elevation_for_air_rad() const { return elevation_rad - lower_for_air_rad; }
};

struct PanoramaSettings {
  int width = 2048;
  int height = 1024;
  double altitude_m = 2.0;  // of the observer
  PanoramaSun sun;
  PanoramaOrientation orientation = PanoramaOrientation::kNorth;
  bool sun_disk = false;  // draw the sun itself: a few pixels of some 1e9 cd/m^2
  bool compass = false;   // paint N, E, S and W on the horizontal
  /// How the light is polarised, the sun's disk and the compass aside; none twice.
  std::vector<StokesLayer> layers = {};
  /// Of the sky view; when not given, finer than SkyViewSizeFor.
  std::optional<SkyViewSize> view_size;
};

/// Linear sRGB in cd/m^2. Sky of all orders of scattering; below the horizon the medium's Lambert
/// ground lit by sun and sky, behind the air before it. The sun's disk, on request, brings its
/// whole light, spread over the pixels that it touches. The same bytes for any number of threads.
/// Error of luminance against direct evaluation of the pixels' middles, relative to it or to 1e-4
/// of the brightest pixel: rms below 0.1 % with the sun over 10 degrees, below 0.3 % down to -10.
/// @param row_done  called once a row, from any thread.
/// Throws InputError for a size outside [1, kLargestImageSide].
[[nodiscard]] Image RenderPanorama(
    const AirIntegrator<float>& air, const DiffuseLight& diffuse, const PanoramaSettings& settings,
    const std::function<void()>& row_done = [] {});

/// Light [lx] of sun and sky on a horizontal plane at
/// the observer, the sun's disk cut by the horizon.
[[nodiscard]] double HorizontalIlluminance(const AirIntegrator<float>& air,
                                           const DiffuseLight& diffuse, double altitude_m,
                                           const PanoramaSun& sun);

}  // namespace alpenglow::lut
