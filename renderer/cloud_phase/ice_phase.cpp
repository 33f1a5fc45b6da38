// SPDX-License-Identifier: MIT
#include "renderer/cloud_phase/ice_phase.h"

#include <array>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/medium/phase_table.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {
namespace {

constexpr std::array kCrystalRadii_um{10.0, 20.0, 40.0, 80.0};
constexpr std::array kIceWavelengths_nm{400.0, 450.0, 500.0, 550.0, 600.0, 700.0};

/// Returns the table: angles, then one phase function per radius and wavelength.
const std::vector<std::vector<double>>& IceColumns() {
  static const std::vector<std::vector<double>> columns = PhaseColumns(
      "renderer/data/ice_phase.csv", 1 + kCrystalRadii_um.size() * kIceWavelengths_nm.size());
  return columns;
}

}  // namespace

CloudPhases IcePhases(double wavelength_nm) {
  RequireInRange(wavelength_nm, 300.0, 1000.0, "the wavelength of light in clouds [nm]");
  std::vector<PhaseFunction> phases;
  for (std::size_t radius = 0; radius < kCrystalRadii_um.size(); ++radius) {
    SpectralPhase of_radius;
    of_radius.wavelength_nm.assign(kIceWavelengths_nm.begin(), kIceWavelengths_nm.end());
    of_radius.angle_deg = IceColumns()[0];
    for (std::size_t band = 0; band < kIceWavelengths_nm.size(); ++band) {
      of_radius.per_sr.push_back(IceColumns()[1 + radius * kIceWavelengths_nm.size() + band]);
    }
    phases.push_back({.kind = PhaseKind::kTable,
                      .table = std::make_shared<const PhaseTable>(of_radius.At(wavelength_nm))});
  }
  return {{kCrystalRadii_um.begin(), kCrystalRadii_um.end()}, std::move(phases)};
}

}  // namespace alpenglow::renderer
