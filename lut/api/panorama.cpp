// SPDX-License-Identifier: MIT
#include <alpenglow/panorama.h>

#include <alpenglow/errors.h>

#include "atmosphere/api/conversions.h"
#include "atmosphere/base/error.h"
#include "lut/api/conversions.h"
#include "lut/cli/program.h"
#include "lut/sky/panorama.h"

namespace alpenglow {

namespace {

lut::PanoramaOrientation OrientationOf(PanoramaCentre centre) {
  switch (centre) {
    case PanoramaCentre::kNorth:
      return lut::PanoramaOrientation::kNorth;
    case PanoramaCentre::kBlender:
      return lut::PanoramaOrientation::kBlender;
    case PanoramaCentre::kOpenExr:
      return lut::PanoramaOrientation::kOpenExr;
    case PanoramaCentre::kThreeJs:
      return lut::PanoramaOrientation::kThree;
    case PanoramaCentre::kUnity:
      return lut::PanoramaOrientation::kUnity;
    case PanoramaCentre::kGodot:
      return lut::PanoramaOrientation::kGodot;
  }
  throw InputError("centre is no PanoramaCentre");
}

// Throws InputError for an altitude out of range, and for wavelengths without colours.
void RequireVisible(const Sky& sky, double altitude_m) {
  atmosphere::RequireInRange(altitude_m, -12e3, 1e9, "altitude_m");
  atmosphere::Validate(sky.atmosphere().medium(), atmosphere::kForPictures);
}

}  // namespace

HdrImage RenderPanorama(const Sky& sky, const PanoramaOptions& options) {
  RequireVisible(sky, options.altitude_m);
  lut::PanoramaSettings settings;
  settings.width = options.width;
  settings.height = options.height;
  settings.altitude_m = options.altitude_m;
  RequireValid(options.sun);
  settings.sun = options.sun;
  settings.orientation = OrientationOf(options.centre);
  settings.sun_disk = options.draws_sun;
  HdrImage panorama = lut::RenderPanorama(sky.state().lookup.single_scattering(),
                                          sky.state().lookup.multiple_scattering(), settings);
  panorama.is_panorama = true;
  panorama.metadata = {{"Software", lut::ProducerText()},
                       {"alpenglow.unit", "cd/m^2, linear sRGB (Rec. 709 primaries, D65)"},
                       {"alpenglow.atmosphere", sky.atmosphere().name()},
                       {"alpenglow.orientation", lut::NameOf(settings.orientation)}};
  return panorama;
}

double HorizontalIlluminance(const Sky& sky, double altitude_m, const SunInSky& sun) {
  RequireVisible(sky, altitude_m);
  RequireValid(sun);
  return lut::HorizontalIlluminance(sky.state().lookup.single_scattering(),
                                    sky.state().lookup.multiple_scattering(), altitude_m, sun);
}

}  // namespace alpenglow
