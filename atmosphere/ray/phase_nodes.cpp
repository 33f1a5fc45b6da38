// SPDX-License-Identifier: MIT
#include "atmosphere/ray/phase_nodes.h"

#include <algorithm>

#include "atmosphere/air/phase_table.h"
#include "atmosphere/air/phase_text.h"

namespace alpenglow {

namespace {

// Where the nodes stand in every table.
std::vector<double> PositionsInTables() {
  std::vector<double> positions;
  for (std::size_t node = 0; node < PhaseNodes::kNodes; ++node) {
    const double half_sine = shared::PhaseHalfSine<double>(
        static_cast<double>(node) / static_cast<double>(PhaseNodes::kNodes - 1));
    positions.push_back(PhaseTable::Position(1.0 - 2.0 * half_sine * half_sine));
  }
  return positions;
}

}  // namespace

PhaseNodes::PhaseNodes(const Medium& medium) : bands_(medium.wavelengths_nm.size()) {
  static const std::vector<double> positions = PositionsInTables();
  value_.reserve(kNodes * bands_);
  for (const double position : positions) {
    for (std::size_t band = 0; band < bands_; ++band)
      value_.push_back(static_cast<float>(MiePhase(medium, band).table->At(position)));
  }
}

Bands<float> PhaseNodes::At(double nu) const {
  const auto half_sine_squared = static_cast<float>(std::clamp(0.5 - 0.5 * nu, 0.0, 1.0));
  const float position =
      shared::PhaseNode<float>(half_sine_squared) * static_cast<float>(kNodes - 1);
  const auto cell = std::min(static_cast<std::size_t>(position), kNodes - 2);
  const float share = position - static_cast<float>(cell);
  const float* low = &value_[cell * bands_];
  Bands<float> values;
  values.count = bands_;
  for (std::size_t band = 0; band < bands_; ++band)
    values[band] = low[band] + share * (low[bands_ + band] - low[band]);
  return values;
}

}  // namespace alpenglow
