// SPDX-License-Identifier: MIT
#include <alpenglow/panorama.h>

#include <alpenglow/errors.h>
#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

#include "atmosphere/api/conversions.h"
#include "atmosphere/base/error.h"
#include "lut/api/conversions.h"
#include "lut/api/sky_parts.h"
#include "lut/cli/program.h"
#include "lut/cli/terminal.h"
#include "lut/sky/panorama.h"

namespace alpenglow {
namespace {

// Throws InputError for an altitude out of range, and for wavelengths without colours.
void RequireVisible(const Sky& sky, double altitude_m) {
  atmosphere::RequireInRange(altitude_m, -12e3, 1e9, "altitude_m");
  atmosphere::Validate(sky.atmosphere().medium(), atmosphere::kForPictures);
}

void RequireValid(const PanoramaOptions& options) {
  RequireValid(options.sun);
  static_cast<void>(lut::CentreAzimuth(options.centre));
  static_cast<void>(lut::StokesLayersFromNames(options.layers));
}

Metadata MetadataOf(const Sky& sky, const PanoramaOptions& options) {
  Metadata metadata{
      {"Software", lut::ProducerText()},
      {"alpenglow.unit", "cd/m^2, linear sRGB (Rec. 709 primaries, D65)"},
      {"alpenglow.atmosphere", sky.atmosphere().name()},
      {"alpenglow.atmosphere_hash", fmt::format("{:016x}", sky.atmosphere().hash())},
      {"alpenglow.altitude_m", fmt::format("{}", options.altitude_m)},
      {"alpenglow.sun_elevation_deg", fmt::format("{:.6f}", options.sun.elevation_deg)},
      {"alpenglow.sun_azimuth_deg", lut::DirectionText(options.sun.azimuth_deg, 6)},
      {"alpenglow.sun_distance", fmt::format("{:.6f}", options.sun.distance_au)},
      {"alpenglow.sun_disk", options.draws_sun ? "drawn" : "left out"},
      {"alpenglow.orientation", lut::NameOf(options.centre)},
      {"alpenglow.centre_azimuth_deg",
       lut::DirectionText(lut::CentreAzimuth(options.centre) / atmosphere::kRadiansPerDegree, 6)}};
  if (options.draws_compass) metadata["alpenglow.compass"] = "painted";
  std::vector<std::string> layers;
  for (const lut::StokesLayer layer : lut::StokesLayersFromNames(options.layers))
    layers.push_back(lut::NameOf(layer));
  if (!layers.empty()) metadata["alpenglow.layers"] = fmt::format("{}", fmt::join(layers, ","));
  return metadata;
}

}  // namespace

HdrImage RenderPanorama(const Sky& sky, const PanoramaOptions& options,
                        const ProgressFunction& progress) {
  RequireVisible(sky, options.altitude_m);
  RequireValid(options);
  const lut::TableLookup& lookup = SkyParts::LookupOf(sky);
  HdrImage panorama =
      lut::RenderPanorama(lookup.single_scattering(), lookup.multiple_scattering(), options,
                          PartDone(progress, static_cast<std::size_t>(options.height)));
  panorama.metadata = MetadataOf(sky, options);
  return panorama;
}

double HorizontalIlluminance(const Sky& sky, double altitude_m, const SunInSky& sun) {
  RequireVisible(sky, altitude_m);
  RequireValid(sun);
  const lut::TableLookup& lookup = SkyParts::LookupOf(sky);
  return lut::HorizontalIlluminance(lookup.single_scattering(), lookup.multiple_scattering(),
                                    altitude_m, sun);
}

}  // namespace alpenglow
