// SPDX-License-Identifier: MIT
#include "atmosphere/ray/phase_nodes.h"

#include <algorithm>
#include <cmath>

#include "atmosphere/air/phase_table.h"
#include "atmosphere/number/constants.h"

namespace alpenglow::atmosphere {
namespace {

// PhaseTable::Position in float, by the sine of half the angle from the nearer end, which keeps small angles
// apart there.
float PositionOf(double nu) {
  const double nearer = std::clamp(0.5 - 0.5 * std::abs(nu), 0.0, 0.5);
  const float share =
      2.0F * static_cast<float>(1.0 / kPi) * std::asin(std::sqrt(static_cast<float>(nearer)));
  return std::cbrt(nu < 0.0 ? 1.0F - share : share) * static_cast<float>(PhaseTable::kNodes - 1);
}

}  // namespace

PhaseNodes::PhaseNodes(const Medium& medium) : bands_(medium.wavelengths_nm.size()) {
  value_.reserve(PhaseTable::kNodes * bands_);
  for (std::size_t node = 0; node < PhaseTable::kNodes; ++node) {
    for (std::size_t band = 0; band < bands_; ++band)
      value_.push_back(static_cast<float>(MiePhase(medium, band).table->nodes()[node]));
  }
}

Bands<float> PhaseNodes::At(double nu) const {
  const float position = PositionOf(nu);
  const auto cell = std::min(static_cast<std::size_t>(position), PhaseTable::kNodes - 2);
  const float share = position - static_cast<float>(cell);
  const float* low = &value_[cell * bands_];
  Bands<float> values;
  values.count = bands_;
  for (std::size_t band = 0; band < bands_; ++band)
    values[band] = low[band] + share * (low[bands_ + band] - low[band]);
  return values;
}

}  // namespace alpenglow::atmosphere
