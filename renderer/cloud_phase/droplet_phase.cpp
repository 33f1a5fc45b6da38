// SPDX-License-Identifier: MIT
#include "renderer/cloud_phase/droplet_phase.h"

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

/// Returns the effective size parameter of a column of the table.
double SizeParameter(std::size_t table) {
  return 25.0 * std::exp2(static_cast<double>(table) / 3.0);
}

/// Returns the phase functions by size parameter, which are made once.
const std::vector<PhaseFunction>& PhasesBySize() {
  static const std::vector<PhaseFunction> tables = [] {
    const auto columns = PhaseColumns("renderer/data/droplet_phase.csv", kSizes + 1);
    std::vector<PhaseFunction> made;
    for (std::size_t table = 1; table <= kSizes; ++table) {
      made.push_back({.kind = PhaseKind::kTable,
                      .table = std::make_shared<const PhaseTable>(columns[0], columns[table])});
    }
    return made;
  }();
  return tables;
}

}  // namespace

CloudPhases DropletPhases(double wavelength_nm) {
  RequireInRange(wavelength_nm, 300.0, 1000.0, "the wavelength of light in clouds [nm]");
  std::vector<double> radius_um;
  for (std::size_t table = 0; table < kSizes; ++table) {
    radius_um.push_back(SizeParameter(table) * wavelength_nm / (2000.0 * kPi));
  }
  return {std::move(radius_um), PhasesBySize()};
}

}  // namespace alpenglow::renderer
