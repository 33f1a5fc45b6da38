// SPDX-License-Identifier: MIT
#include "renderer/terrain/land.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "renderer/terrain/lattice_noise.h"

namespace alpenglow::renderer {
namespace {

std::array<double, 4> CubicWeights(double t) {
  return {((-0.5 * t + 1.0) * t - 0.5) * t, (1.5 * t - 2.5) * t * t + 1.0,
          ((-1.5 * t + 2.0) * t + 0.5) * t, (0.5 * t - 0.5) * t * t};
}

double Slope(const Land& land, int row, int column) {
  const double east = static_cast<double>(land.at(row, column + 1) - land.at(row, column - 1));
  const double south = static_cast<double>(land.at(row + 1, column) - land.at(row - 1, column));
  return std::sqrt(east * east + south * south) / (2.0 * land.spacing_m);
}

double BinomialMean(const Land& land, int row, int column) {
  double sum = 0.0;
  for (int r = -1; r <= 1; ++r) {
    for (int c = -1; c <= 1; ++c) {
      sum +=
          (2 - std::abs(r)) * (2 - std::abs(c)) * static_cast<double>(land.at(row + r, column + c));
    }
  }
  return sum / 16.0;
}

// Visits every sample off the rim: visit(row, column). Many threads.
template <typename Visit>
void ForInside(int size, const Visit& visit) {
  tbb::parallel_for(1, std::max(size - 1, 1), [&](int row) {
    for (int column = 1; column < size - 1; ++column) visit(row, column);
  });
}

}  // namespace

float CubicHeight(const Land& land, double row, double column) {
  const int r = static_cast<int>(std::floor(row));
  const int c = static_cast<int>(std::floor(column));
  const auto row_weights = CubicWeights(row - r);
  const auto column_weights = CubicWeights(column - c);
  double sum = 0.0;
  for (int i = 0; i < 4; ++i) {
    const int at_row = std::clamp(r + i - 1, 0, land.size - 1);
    double line = 0.0;
    for (int j = 0; j < 4; ++j) {
      const int at_column = std::clamp(c + j - 1, 0, land.size - 1);
      line += column_weights[static_cast<std::size_t>(j)] *
              static_cast<double>(land.at(at_row, at_column));
    }
    sum += row_weights[static_cast<std::size_t>(i)] * line;
  }
  return static_cast<float>(sum);
}

Land Refined(const Land& coarse, double roughness_m, std::uint32_t seed) {
  Land fine{2 * coarse.size, 0.5 * coarse.spacing_m, {}};
  fine.height_m.resize(4 * coarse.height_m.size(), 0.0F);
  ForInside(fine.size, [&](int row, int column) {
    fine.height_m[fine.index(row, column)] =
        CubicHeight(coarse, 0.5 * row - 0.25, 0.5 * column - 0.25) +
        static_cast<float>(roughness_m * (LatticeUniform(column, row, seed) - 0.5));
  });
  return fine;
}

Land WithRibs(const Land& land, double height_m, double wavelength_km, std::uint32_t seed) {
  Land ribbed = land;
  ForInside(land.size, [&](int row, int column) {
    const double slope = Slope(land, row, column);
    const double strength = height_m * std::min(1.0, slope * slope);
    if (strength < 0.01 * height_m) return;
    const auto [x, y] = land.PlaceOf(row, column);
    const double ribs = RidgedNoise(x / wavelength_km, y / wavelength_km, 2, seed) - 0.5;
    ribbed.height_m[land.index(row, column)] += static_cast<float>(strength * ribs);
  });
  return ribbed;
}

Land Softened(const Land& land, const std::vector<float>& weight) {
  Land soft = land;
  ForInside(land.size, [&](int row, int column) {
    const std::size_t sample = land.index(row, column);
    if (weight[sample] == 0.0F) return;
    const auto mean = static_cast<float>(BinomialMean(land, row, column));
    soft.height_m[sample] += weight[sample] * (mean - land.height_m[sample]);
  });
  return soft;
}

Land Bent(const Land& land, double samples, double wavelength_km, std::uint32_t seed) {
  Land bent = land;
  ForInside(land.size, [&](int row, int column) {
    const auto [x, y] = land.PlaceOf(row, column);
    const double u = x / wavelength_km;
    const double v = y / wavelength_km;
    bent.height_m[land.index(row, column)] =
        CubicHeight(land, row + samples * FractalNoise(u, v, 3, seed),
                    column + samples * FractalNoise(u, v, 3, seed + 10));
  });
  return bent;
}

}  // namespace alpenglow::renderer
