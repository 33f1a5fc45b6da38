// SPDX-License-Identifier: MIT
#include "renderer/clouds/cloud_options.h"

#include <fmt/format.h>

#include <cmath>

#include "atmosphere/base/error.h"

namespace alpenglow::renderer {
namespace {

void RequireKey(const char* key, double value, double low, double high) {
  RequireInRange(value, low, high, fmt::format("clouds.{}", key));
}

void CheckPeriod(double period_m) {
  RequireKey("period", period_m, kPeriodStep_m, 32.0 * kPeriodStep_m);
  if (std::fmod(period_m, kPeriodStep_m) != 0.0) {
    throw InputError(
        fmt::format("clouds.period is {}; it must be a multiple of {}", period_m, kPeriodStep_m));
  }
}

}  // namespace

CloudOptions DefaultCloudOptions(CloudGenus genus) {
  CloudOptions options;
  options.genus = genus;
  switch (genus) {
    case CloudGenus::kCumulus:
      break;
    case CloudGenus::kStratocumulus:
      options.cover = 0.8;
      options.base_altitude_m = 900.0;
      options.depth_m = 350.0;
      options.droplet_number_per_cm3 = 100.0;
      break;
    case CloudGenus::kAltocumulus:
      options.cover = 0.6;
      options.base_altitude_m = 4000.0;
      options.depth_m = 200.0;
      options.droplet_number_per_cm3 = 80.0;
      break;
    case CloudGenus::kCirrus:
      options.cover = 0.4;
      options.base_altitude_m = 8000.0;
      options.depth_m = 1200.0;
      options.ice_mg_per_m3 = 40.0;
      break;
  }
  return options;
}

CloudGenus CloudGenusNamed(std::string_view name) {
  return kCloudGenusNames.Named(name, "clouds.genus is \"{0}\"; it must be {2}");
}

void CheckCloudOptions(const CloudOptions& options) {
  RequireKey("cover", options.cover, 0.0,
             options.genus == CloudGenus::kCumulus ? kMostCumulusCover : 1.0);
  RequireKey("base", options.base_altitude_m, 0.0, 15000.0);
  RequireKey("depth", options.depth_m, 100.0, 4000.0);
  if (options.genus == CloudGenus::kCirrus) {
    RequireKey("ice", options.ice_mg_per_m3, 1.0, 1000.0);
    RequireKey("crystal_radius", options.crystal_radius_um, 5.0, 200.0);
  } else {
    RequireKey("base", options.base_altitude_m, 0.0, 11000.0);
    RequireKey("droplets", options.droplet_number_per_cm3, 1.0, 5000.0);
  }
  RequireKey("wind.east", options.wind_m_per_s.x, -150.0, 150.0);
  RequireKey("wind.north", options.wind_m_per_s.y, -150.0, 150.0);
  CheckPeriod(options.period_m);
}

double CoveredOpticalDepth(CloudGenus genus) { return genus == CloudGenus::kCirrus ? 0.03 : 0.3; }

}  // namespace alpenglow::renderer
