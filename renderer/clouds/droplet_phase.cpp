// SPDX-License-Identifier: MIT
#include "renderer/clouds/droplet_phase.h"

#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "atmosphere/base/csv.h"
#include "atmosphere/base/error.h"
#include "atmosphere/base/parsing.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/medium/phase_table.h"
#include "renderer/embedded_text.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {
namespace {

constexpr std::size_t kSizes = 14;

/// Returns the effective size parameter of a column of the table.
double SizeParameter(std::size_t table) {
  return 25.0 * std::exp2(static_cast<double>(table) / 3.0);
}

/// Returns the columns of the table: angles, then phase functions.
std::vector<std::vector<double>> TableColumns() {
  std::vector<std::vector<double>> columns(kSizes + 1);
  atmosphere::VisitCsvRows(
      renderer::EmbeddedText("renderer/data/droplet_phase.csv"),
      [&](const atmosphere::CsvRecord& row) {
        for (std::size_t i = 0; i < columns.size(); ++i) {
          const std::optional<double> number = ParseNumber(row.fields.at(i));
          if (!number) throw InternalError("renderer/data/droplet_phase.csv is not a table");
          columns[i].push_back(*number);
        }
      });
  return columns;
}

/// Returns the phase functions by size parameter, which are made once.
const std::vector<PhaseFunction>& PhasesBySize() {
  static const std::vector<PhaseFunction> tables = [] {
    const auto columns = TableColumns();
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
