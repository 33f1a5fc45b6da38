// SPDX-License-Identifier: MIT
#include "renderer/cloud_phase/droplet_phase.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/medium/phase_table.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {
namespace {

constexpr std::size_t kSizes = 14;
// Wavelengths of the refractive indices of the table.
constexpr std::array kIndexWavelengths_nm{400.0, 550.0, 700.0};

/// Returns the effective size parameter of a column of the table.
double SizeParameter(std::size_t table) {
  return 25.0 * std::exp2(static_cast<double>(table) / 3.0);
}

/// Returns the table: angles, then one phase function per index and size parameter.
const std::vector<std::vector<double>>& DropletColumns() {
  static const std::vector<std::vector<double>> columns =
      PhaseColumns("renderer/data/droplet_phase.csv", 1 + kSizes * kIndexWavelengths_nm.size());
  return columns;
}

}  // namespace

CloudPhases DropletPhases(double wavelength_nm) {
  RequireInRange(wavelength_nm, 300.0, 1000.0, "the wavelength of light in clouds [nm]");
  std::vector<double> radius_um;
  std::vector<PhaseFunction> phases;
  for (std::size_t table = 0; table < kSizes; ++table) {
    SpectralPhase of_size;
    of_size.wavelength_nm.assign(kIndexWavelengths_nm.begin(), kIndexWavelengths_nm.end());
    of_size.angle_deg = DropletColumns()[0];
    for (std::size_t index = 0; index < kIndexWavelengths_nm.size(); ++index) {
      of_size.per_sr.push_back(DropletColumns()[1 + index * kSizes + table]);
    }
    radius_um.push_back(SizeParameter(table) * wavelength_nm / (2000.0 * kPi));
    phases.push_back({.kind = PhaseKind::kTable,
                      .table = std::make_shared<const PhaseTable>(of_size.At(wavelength_nm))});
  }
  return {std::move(radius_um), std::move(phases)};
}

}  // namespace alpenglow::renderer
