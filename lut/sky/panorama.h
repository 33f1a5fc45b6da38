// SPDX-License-Identifier: MIT
// Panoramas: the whole sphere around an observer as one latitude-longitude picture, for lighting,
// with Q and U along rows of one zenith angle.
//
// At one zenith angle Q and U are smooth in the azimuth from the sun's, Q an even and U an odd
// function of it: they are evaluated at uniform steps over half a turn and interpolated by cubics.
//
// Row 0 is the zenith, the last row the nadir; columns are azimuths, never mirrored: right in the
// picture is right for an observer who looks at its centre from inside. Programs differ in the
// direction of the centre. With east as +x in all of them (north +y in Blender, -z in OpenEXR,
// three.js and Godot, +z in Unity):
//
//                              up   centre            a quarter to the left   north is
//   geographic                      north             west
//   Blender, Cycles            +z   +x = east         +y = north              +y
//   three.js, glTF             +y   +x = east         -z = north              -z
//   Unity (left-handed)        +y   +x = east         +z = north              +z
//   OpenEXR latlong            +y   +z = south        +x = east               -z
//   Godot                      +y   +z = south        +x = east               -z
#pragma once

#include <alpenglow/panorama.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "atmosphere/ray/single_scattering.h"
#include "lut/image/image.h"
#include "lut/multiple_scattering/multiple_scattering.h"
#include "lut/multiple_scattering/polarised_scattering.h"
#include "lut/sky/sky_view.h"

namespace alpenglow::lut {

/// Q and U of light between an observer and the end of a view, all orders, per unit solar
/// irradiance [1/sr]; light of the ground is unpolarised. U is positive from the lower left to the
/// upper right, on both sides of the sun.
class PolarisedRow {
 public:
  /// `air` and `multiple_scattering` must have the same medium; no reference to them is kept.
  /// @param mu_s  cosine of the sun's zenith angle at the observer.
  PolarisedRow(const SingleScattering<float>& air, const MultipleScattering& multiple_scattering,
               double altitude_m, double mu_s, double zenith_angle_rad);

  /// Returns interpolated values, within 1e-3 of the radiance of a direct evaluation by day, 3e-3
  /// in twilight, up to 10 km.
  /// @param azimuth_rad  from the sun's, clockwise.
  [[nodiscard]] PolarisedLight At(double azimuth_rad) const;

 private:
  std::vector<PolarisedLight> nodes_;
};

/// Reads "north" (or "geographic"), "blender", "openexr", "three", "unity", "godot"; throws
/// InputError for another name.
[[nodiscard]] PanoramaCentre PanoramaCentreFromName(const std::string& name);
[[nodiscard]] std::string NameOf(PanoramaCentre centre);

/// Returns the azimuth, from north over east [rad], of the centre of a picture. Throws InputError
/// for a value that is none of the enumeration's.
[[nodiscard]] double CentreAzimuth(PanoramaCentre centre);

/// Renders linear sRGB in cd/m^2: the sky with all orders of scattering, and below the horizon the
/// medium's Lambertian ground lit by sun and sky, with the air in front of it. The sun's disk, if
/// requested, adds its whole light, distributed over the pixels that it touches. The result is the
/// same for any number of threads. Error of luminance against direct evaluation at pixel centres,
/// relative to it or to 1e-4 of the brightest pixel: rms below 0.1 % with the sun over 10 degrees,
/// below 0.3 % down to -10. Throws InputError for a size outside [1, kLargestImageSide] and an
/// unknown layer. Other members are checked by the function of the public header, which calls this
/// one.
/// @param row_done  called once per row, from any thread; an exception ends the work.
[[nodiscard]] HdrImage RenderPanorama(
    const SingleScattering<float>& air, const MultipleScattering& multiple_scattering,
    const PanoramaOptions& options, const std::function<void()>& row_done = [] {});

/// Returns the illuminance [lx] of a horizontal plane by sun and sky at the observer, with the
/// sun's disk cut by the horizon.
[[nodiscard]] double HorizontalIlluminance(const SingleScattering<float>& air,
                                           const MultipleScattering& multiple_scattering,
                                           double altitude_m, const SunInSky& sun);

}  // namespace alpenglow::lut
