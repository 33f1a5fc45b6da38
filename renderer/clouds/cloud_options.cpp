// SPDX-License-Identifier: MIT
#include "renderer/clouds/cloud_options.h"

#include <fmt/format.h>

#include <cmath>

#include "atmosphere/base/error.h"

namespace alpenglow::renderer {
namespace {

void RequireKey(const char* key, double value, const std::pair<double, double>& range) {
  RequireInRange(value, range.first, range.second, fmt::format("clouds.{}", key));
}

void CheckPeriod(double period_m) {
  RequireKey("period", period_m, CloudRanges::kPeriod_m);
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
      options.wind_m_per_s = {6.0, 0.0};
      break;
    case CloudGenus::kStratocumulus:
      options.cover = 0.8;
      options.base_altitude_m = 900.0;
      options.depth_m = 350.0;
      options.droplet_number_per_cm3 = 100.0;
      options.wind_m_per_s = {8.0, 0.0};
      break;
    case CloudGenus::kAltocumulus:
      options.cover = 0.6;
      options.base_altitude_m = 4000.0;
      options.depth_m = 200.0;
      options.droplet_number_per_cm3 = 80.0;
      options.wind_m_per_s = {12.0, 0.0};
      break;
    case CloudGenus::kCirrus:
      options.cover = 0.4;
      options.base_altitude_m = 8000.0;
      options.depth_m = 1200.0;
      options.ice_mg_per_m3 = 40.0;
      options.wind_m_per_s = {25.0, 0.0};
      break;
    case CloudGenus::kStratus:
      options.cover = 1.0;
      options.base_altitude_m = 500.0;
      options.depth_m = 600.0;
      options.droplet_number_per_cm3 = 200.0;
      options.wind_m_per_s = {5.0, 0.0};
      break;
    case CloudGenus::kCirrostratus:
      options.cover = 1.0;
      options.base_altitude_m = 7500.0;
      options.depth_m = 1000.0;
      options.ice_mg_per_m3 = 15.0;
      options.wind_m_per_s = {25.0, 0.0};
      break;
  }
  return options;
}

CloudGenus CloudGenusNamed(std::string_view name) {
  return kCloudGenusNames.Named(name, "clouds.genus is \"{0}\"; it must be {2}");
}

void CheckCloudOptions(const CloudOptions& options) {
  using Ranges = CloudRanges;
  RequireKey("cover", options.cover, CoversOf(options.genus));
  RequireKey("base", options.base_altitude_m, Ranges::kBase_m);
  RequireKey("depth", options.depth_m, Ranges::kDepth_m);
  if (IsOfIce(options.genus)) {
    RequireKey("ice", options.ice_mg_per_m3, Ranges::kIce_mg_per_m3);
    RequireKey("crystal_radius", options.crystal_radius_um, Ranges::kCrystalRadius_um);
  } else {
    RequireKey("base", options.base_altitude_m, {Ranges::kBase_m.first, kHighestWaterBase_m});
    RequireKey("droplets", options.droplet_number_per_cm3, Ranges::kDroplets_per_cm3);
  }
  if (options.optical_depth) {
    RequireKey("optical_depth", *options.optical_depth, Ranges::kOpticalDepth);
    if (!IsPlaneParallel(options.genus))
      throw InputError("clouds.optical_depth is for stratus and cirrostratus");
  }
  RequireKey("wind.east", options.wind_m_per_s.x, Ranges::kWind_m_per_s);
  RequireKey("wind.north", options.wind_m_per_s.y, Ranges::kWind_m_per_s);
  CheckPeriod(options.period_m);
}

std::pair<double, double> CoversOf(CloudGenus genus) {
  if (IsPlaneParallel(genus)) return {1.0, 1.0};
  return {CloudRanges::kCover.first,
          genus == CloudGenus::kCumulus ? kMostCumulusCover : CloudRanges::kCover.second};
}

double CoveredOpticalDepth(CloudGenus genus) { return IsOfIce(genus) ? 0.03 : 0.3; }

}  // namespace alpenglow::renderer
