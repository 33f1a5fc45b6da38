// SPDX-License-Identifier: MIT
// A membrane over each void: Laplace's equation, from the coarsest pyramid level to the finest.
//
// Pulling averages the valid samples of 2 x 2 into one; pushing starts the voids of a level with
// the coarser level's values, interpolated, and relaxes them (Gauss-Seidel with over-relaxation).
// Long waves are settled where they are cheap, so a few sweeps a level are enough.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "atmosphere/text/error.h"
#include "renderer/layer.h"
#include "renderer/terrain/elevation_raster.h"

namespace alpenglow::renderer {
namespace {

constexpr int kSweeps = 40;
constexpr double kOverRelaxation = 1.7;

struct Level {
  int rows = 0;
  int columns = 0;
  std::vector<double> height;  // NaN: void, until pushed

  [[nodiscard]] std::size_t index(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  }
  [[nodiscard]] double clamped(int row, int column) const {
    return height[index(std::clamp(row, 0, rows - 1), std::clamp(column, 0, columns - 1))];
  }
};

double MeanOfValid(const Level& fine, int row, int column) {
  double sum = 0.0;
  int count = 0;
  for (int r = row; r < std::min(row + 2, fine.rows); ++r) {
    for (int c = column; c < std::min(column + 2, fine.columns); ++c) {
      const double height = fine.height[fine.index(r, c)];
      if (std::isnan(height)) continue;
      sum += height;
      ++count;
    }
  }
  return count == 0 ? std::numeric_limits<double>::quiet_NaN() : sum / count;
}

Level Pull(const Level& fine) {
  Level coarse{(fine.rows + 1) / 2, (fine.columns + 1) / 2, {}};
  coarse.height.reserve(static_cast<std::size_t>(coarse.rows) *
                        static_cast<std::size_t>(coarse.columns));
  for (int row = 0; row < coarse.rows; ++row) {
    for (int column = 0; column < coarse.columns; ++column) {
      coarse.height.push_back(MeanOfValid(fine, 2 * row, 2 * column));
    }
  }
  return coarse;
}

// Bilinear value of the coarse level at the centre of a fine sample.
double Interpolate(const Level& coarse, int fine_row, int fine_column) {
  const double row = 0.5 * fine_row - 0.25;
  const double column = 0.5 * fine_column - 0.25;
  const int r = static_cast<int>(std::floor(row));
  const int c = static_cast<int>(std::floor(column));
  const double fr = row - r;
  const double fc = column - c;
  return (1.0 - fr) * ((1.0 - fc) * coarse.clamped(r, c) + fc * coarse.clamped(r, c + 1)) +
         fr * ((1.0 - fc) * coarse.clamped(r + 1, c) + fc * coarse.clamped(r + 1, c + 1));
}

struct Sample {
  int row;
  int column;
};

std::vector<Sample> VoidsOf(const Level& level) {
  std::vector<Sample> voids;
  for (int row = 0; row < level.rows; ++row) {
    for (int column = 0; column < level.columns; ++column) {
      if (std::isnan(level.height[level.index(row, column)])) voids.push_back({row, column});
    }
  }
  return voids;
}

// The mean of the neighbours that exist: at the raster's edge the membrane is free.
double NeighbourMean(const Level& level, const Sample& at) {
  double sum = 0.0;
  int count = 0;
  const auto add = [&](int row, int column) {
    if (row < 0 || column < 0 || row >= level.rows || column >= level.columns) return;
    sum += level.height[level.index(row, column)];
    ++count;
  };
  add(at.row - 1, at.column);
  add(at.row + 1, at.column);
  add(at.row, at.column - 1);
  add(at.row, at.column + 1);
  return sum / count;
}

void Push(const Level& coarse, Level& fine) {
  const std::vector<Sample> voids = VoidsOf(fine);
  for (const Sample& at : voids) {
    fine.height[fine.index(at.row, at.column)] = Interpolate(coarse, at.row, at.column);
  }
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (const Sample& at : voids) {
      double& height = fine.height[fine.index(at.row, at.column)];
      height += kOverRelaxation * (NeighbourMean(fine, at) - height);
    }
  }
}

bool HasVoids(const Level& level) {
  return std::any_of(level.height.begin(), level.height.end(),
                     [](double height) { return std::isnan(height); });
}

}  // namespace

std::size_t FillVoids(std::vector<float>& height, int rows, int columns) {
  std::vector<Level> pyramid(1);
  pyramid[0] = {rows, columns, std::vector<double>(height.begin(), height.end())};
  while (HasVoids(pyramid.back())) {
    ALPENGLOW_ENSURE(pyramid.back().height.size(), >, std::size_t{1});
    pyramid.push_back(Pull(pyramid.back()));
  }
  for (std::size_t level = pyramid.size() - 1; level > 0; --level) {
    Push(pyramid[level], pyramid[level - 1]);
  }
  std::size_t filled = 0;
  for (std::size_t i = 0; i < height.size(); ++i) {
    if (!std::isnan(height[i])) continue;
    height[i] = static_cast<float>(pyramid[0].height[i]);
    ++filled;
  }
  return filled;
}

}  // namespace alpenglow::renderer
