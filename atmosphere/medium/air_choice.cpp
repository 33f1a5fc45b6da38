// SPDX-License-Identifier: MIT
#include "atmosphere/medium/air_choice.h"

#include <algorithm>
#include <cmath>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/medium/medium_presets.h"

namespace alpenglow::atmosphere {
namespace {

constexpr double kMostAerosol = 1000.0;

std::size_t BandOfGreen(const Medium& medium) {
  constexpr double kGreen_nm = 550.0;
  const auto& bands = medium.wavelengths_nm;
  const auto nearest = std::min_element(bands.begin(), bands.end(), [](double a, double b) {
    return std::abs(a - kGreen_nm) < std::abs(b - kGreen_nm);
  });
  return static_cast<std::size_t>(nearest - bands.begin());
}

}  // namespace

Medium Changed(Medium medium, const AirChoice& choice) {
  RequireInRange(choice.aerosol, 0.0, kMostAerosol, "aerosol");
  for (double& value : medium.mie_scattering_per_m) value *= choice.aerosol;
  for (double& value : medium.mie_extinction_per_m) value *= choice.aerosol;
  if (choice.ozone_du) {
    RequireInRange(*choice.ozone_du, 0.0, 10000.0, "ozone");
    for (std::size_t band = 0; band < medium.wavelengths_nm.size(); ++band) {
      medium.ozone_absorption_per_m[band] =
          OzoneAbsorptionAtPeak(*choice.ozone_du, medium.ozone, medium.wavelengths_nm[band]);
    }
  }
  if (choice.ground_albedo) {
    RequireInRange(*choice.ground_albedo, 0.0, 1.0, "ground albedo");
    std::fill(medium.ground_albedo.begin(), medium.ground_albedo.end(), *choice.ground_albedo);
  }
  Validate(medium);
  return medium;
}

double VisibilityOf(const Medium& medium) {
  const std::size_t band = BandOfGreen(medium);
  return kOpticalDepthOfVisibility /
         (medium.rayleigh_scattering_per_m[band] + medium.mie_extinction_per_m[band]);
}

double VisibilityAt(const Medium& medium, double altitude_m, double more_per_m) {
  const std::size_t band = BandOfGreen(medium);
  const double height_m = std::max(altitude_m, 0.0);
  const double per_m =
      MoleculeDensity(medium, height_m) * medium.rayleigh_scattering_per_m[band] +
      std::exp(-height_m / medium.mie_scale_height_m) * medium.mie_extinction_per_m[band] +
      more_per_m;
  return kOpticalDepthOfVisibility / per_m;
}

double AerosolForVisibility(const Medium& medium, double visibility_m) {
  const std::size_t band = BandOfGreen(medium);
  const double wanted_per_m =
      kOpticalDepthOfVisibility / visibility_m - medium.rayleigh_scattering_per_m[band];
  const double has_per_m = medium.mie_extinction_per_m[band];
  if (!(wanted_per_m > 0.0) || has_per_m == 0.0) return 0.0;
  return std::min(wanted_per_m / has_per_m, kMostAerosol);
}

double OzoneDobson(const Medium& medium) {
  double dobson = 0.0, most = 0.0;
  for (std::size_t band = 0; band < medium.wavelengths_nm.size(); ++band) {
    const double of_one = OzoneAbsorptionAtPeak(1.0, medium.ozone, medium.wavelengths_nm[band]);
    if (of_one <= most) continue;
    most = of_one;
    dobson = medium.ozone_absorption_per_m[band] / of_one;
  }
  return dobson;
}

}  // namespace alpenglow::atmosphere
