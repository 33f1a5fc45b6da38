// SPDX-License-Identifier: MIT
#include "atmosphere/colour/trained_bands.h"

#include <algorithm>

#include "atmosphere/text/embedded_table.h"

namespace alpenglow::atmosphere {
namespace {

// The file has seven decimals.
void ScaleToOne(std::vector<double>& share) {
  double sum = 0.0;
  for (const double value : share) sum += value;
  for (double& value : share) value /= sum;
}

std::vector<TrainedBands> ReadSets() {
  const auto columns =
      atmosphere::ReadColumns("atmosphere/data/band_matrices.csv", {0, 1, 2, 3, 4});
  std::vector<TrainedBands> sets;
  for (std::size_t row = 0; row < columns[0].size(); ++row) {
    if (row == 0 || columns[0][row] != columns[0][row - 1]) sets.emplace_back();
    sets.back().wavelengths_nm.push_back(columns[1][row]);
    for (std::size_t c = 0; c < 3; ++c) sets.back().share[c].push_back(columns[2 + c][row]);
  }
  for (TrainedBands& set : sets) {
    for (std::vector<double>& share : set.share) ScaleToOne(share);
  }
  return sets;
}

}  // namespace

const std::vector<TrainedBands>& TrainedBandSets() {
  static const std::vector<TrainedBands> sets = ReadSets();
  return sets;
}

const TrainedBands* FindTrainedBands(std::span<const double> wavelengths_nm) {
  for (const TrainedBands& set : TrainedBandSets()) {
    if (std::equal(set.wavelengths_nm.begin(), set.wavelengths_nm.end(), wavelengths_nm.begin(),
                   wavelengths_nm.end())) {
      return &set;
    }
  }
  return nullptr;
}

}  // namespace alpenglow::atmosphere
