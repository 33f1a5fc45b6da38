// SPDX-License-Identifier: MIT
#include "viewer/paint/bent_disk.h"

#include <algorithm>
#include <cmath>

#include "atmosphere/number/constants.h"
#include "atmosphere/ray/bent_view.h"

namespace alpenglow::viewer {
namespace {

/// Nodes reach so many radii from the middle of the disk, which may move by the rest.
constexpr double kReach = 1.25;
constexpr double kMostWay_rad = 1.0 / 60.0 * kRadiansPerDegree;

}  // namespace

double BentDisk::Change() const {
  double between_bands = 0.0;
  for (int band = 1; band < 4; ++band)
    between_bands =
        std::max(between_bands, std::abs(double{lift_rad.front()[band] - lift_rad.front()[0]}));
  const double flatter = double{lift_rad.front().x} - double{lift_rad[kNodes / 2].x};
  return std::max(flatter, between_bands);
}

BentDisk BentDiskOf(const Medium& medium, double height_m, double elevation_rad,
                    double radius_rad) {
  const BendingAir air = GentleAirOf(medium);
  const double horizon_rad = GrazingElevation(air, height_m);
  // Below the horizon nothing is seen of a disk.
  const double first_rad = std::max(elevation_rad - kReach * radius_rad, horizon_rad);
  const double last_rad =
      std::max(elevation_rad + kReach * radius_rad, horizon_rad + 0.1 * radius_rad);
  BentDisk disk{first_rad, (last_rad - first_rad) / (BentDisk::kNodes - 1), {}, {}};
  for (std::size_t node = 0; node < BentDisk::kNodes; ++node) {
    const double at_rad = first_rad + static_cast<double>(node) * disk.step_rad;
    const BentLight light = BentLightOf(medium, air, at_rad, std::max(height_m, 0.0));
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

const BentDisk* BentDiskFollower::Follow(const std::shared_ptr<const SolvedAir>& air,
                                         double height_m, double elevation_rad, double radius_rad,
                                         double half_pixel_rad) {
  constexpr double kLow_rad = 10.0 * kRadiansPerDegree;
  const double horizon_rad = GrazingElevation(GentleAirOf(air->medium), height_m);
  if (elevation_rad > kLow_rad || elevation_rad < horizon_rad - 2.0 * radius_rad) return nullptr;
  // The horizon's own change counts: on it the air is thickest.
  const double height_step_m = 0.002 * std::max(height_m, 1.0);
  const bool suits = made_ && made_->air == air &&
                     std::abs(made_->height_m - height_m) < height_step_m &&
                     std::abs(made_->elevation_rad - elevation_rad) < kMostWay_rad;
  if (!suits)
    made_ = {air, height_m, elevation_rad,
             BentDiskOf(air->medium, height_m, elevation_rad, radius_rad)};
  return made_->disk.Change() > half_pixel_rad ? &made_->disk : nullptr;
}

}  // namespace alpenglow::viewer
