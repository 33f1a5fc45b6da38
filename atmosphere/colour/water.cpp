// SPDX-License-Identifier: MIT
#include "atmosphere/colour/water.h"

#include <cmath>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "atmosphere/number/constants.h"
#include "atmosphere/text/embedded_table.h"

namespace alpenglow::atmosphere {
namespace {

SampledFunction Column(int column) {
  auto columns = atmosphere::ReadColumns("atmosphere/data/water_and_ice_10nm.csv", {0, column});
  return {std::move(columns[0]), std::move(columns[1])};
}

}  // namespace

double WaterAbsorption(double wavelength_nm) {
  static const SampledFunction table = Column(1);
  return table(wavelength_nm);
}

double SeaWaterScattering(double wavelength_nm) {
  return 0.00288 * std::pow(wavelength_nm / 500.0, -4.32);
}

double IceAbsorption(double wavelength_nm) {
  static const SampledFunction table = Column(2);
  return 4.0 * kPi * table(wavelength_nm) / (1e-9 * wavelength_nm);
}

}  // namespace alpenglow::atmosphere
