// SPDX-License-Identifier: MIT
// Trained sets of bands: their wavelengths, and the weights that compute colour from them.
//
//   X_c / X_c(sun) = sum_i share_ci f_i,    f_i = light at band i relative to the sun above the air
//
// The weights are in data/band_matrices.csv, which tests/bench/train_bands.cpp makes.
#pragma once

#include <array>
#include <span>
#include <vector>

namespace alpenglow::atmosphere {

struct TrainedBands {
  std::vector<double> wavelengths_nm;        // ascending
  std::array<std::vector<double>, 3> share;  // for X, Y, Z; each sums to 1
};

[[nodiscard]] const std::vector<TrainedBands>& TrainedBandSets();

/// Returns the trained set with exactly these wavelengths; null if there is none.
[[nodiscard]] const TrainedBands* FindTrainedBands(std::span<const double> wavelengths_nm);

}  // namespace alpenglow::atmosphere
