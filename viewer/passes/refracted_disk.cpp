// SPDX-License-Identifier: MIT
#include "viewer/passes/refracted_disk.h"

#include <algorithm>
#include <cmath>

#include "atmosphere/math/constants.h"
#include "atmosphere/refraction/refracted_view.h"

namespace alpenglow::viewer {
namespace {

// The nodes extend to this many radii from the centre of the disk. The disk may move by most of
// the remainder.
constexpr double kReach = 1.25, kMostDiskTurn_radii = 0.2;

}  // namespace

double RefractedDisk::Change() const {
  double between_bands = 0.0;
  for (int band = 1; band < 4; ++band)
    between_bands =
        std::max(between_bands, std::abs(double{lift_rad.front()[band] - lift_rad.front()[0]}));
  const double flatter = double{lift_rad.front().x} - double{lift_rad[kNodes / 2].x};
  return std::max(flatter, between_bands);
}

RefractedDisk RefractedDiskOf(const Medium& medium, double height_m, double elevation_rad,
                              double radius_rad) {
  const BendingAir air = GentleAirOf(medium);
  const double horizon_rad = GrazingElevation(air, height_m);
  // No part of a disk is visible below the horizon.
  const double first_rad = std::max(elevation_rad - kReach * radius_rad, horizon_rad);
  const double last_rad =
      std::max(elevation_rad + kReach * radius_rad, horizon_rad + 0.1 * radius_rad);
  RefractedDisk disk{first_rad, (last_rad - first_rad) / (RefractedDisk::kNodes - 1), {}, {}};
  for (std::size_t node = 0; node < RefractedDisk::kNodes; ++node) {
    const double at_rad = first_rad + static_cast<double>(node) * disk.step_rad;
    const RefractedLight light = RefractedLightOf(medium, air, at_rad, std::max(height_m, 0.0));
    for (std::size_t band = 0; band < medium.wavelengths_nm.size(); ++band) {
      const double more = RefractivityAtSeaLevel(medium.wavelengths_nm[band]) /
                              RefractivityAtSeaLevel(kHorizonWavelength_nm) -
                          1.0;
      const auto component = static_cast<glm::length_t>(band);
      disk.lift_rad[node][component] = static_cast<float>(
          light.refraction_rad + more * air.refractivity * light.per_refractivity_rad);
      disk.more_depth[node][component] =
          static_cast<float>(medium.rayleigh_scattering_per_m[band] * light.molecules_m +
                             medium.mie_extinction_per_m[band] * light.aerosol_m);
    }
  }
  return disk;
}

const RefractedDisk* RefractedDiskFollower::Follow(const std::shared_ptr<const SolvedAir>& air,
                                                   double height_m, double elevation_rad,
                                                   double radius_rad, double half_pixel_rad) {
  constexpr double kLow_rad = 10.0 * kRadiansPerDegree;
  const double horizon_rad = GrazingElevation(GentleAirOf(air->medium()), height_m);
  if (elevation_rad > kLow_rad || elevation_rad < horizon_rad - 2.0 * radius_rad) return nullptr;
  // The horizon changes with the eye's height as well. The air is densest there.
  const double height_step_m = 0.002 * std::max(height_m, 1.0);
  const bool suits =
      made_ && made_->air == air && std::abs(made_->height_m - height_m) < height_step_m &&
      std::abs(made_->elevation_rad - elevation_rad) < kMostDiskTurn_radii * radius_rad;
  if (!suits)
    made_ = {air, height_m, elevation_rad,
             RefractedDiskOf(air->medium(), height_m, elevation_rad, radius_rad)};
  return made_->disk.Change() > half_pixel_rad ? &made_->disk : nullptr;
}

}  // namespace alpenglow::viewer
