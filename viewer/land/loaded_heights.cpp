// SPDX-License-Identifier: MIT
#include "viewer/land/loaded_heights.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "renderer/terrain/cell_diagonal.h"

namespace alpenglow::viewer {
namespace {

constexpr float kNoHeight = std::numeric_limits<float>::quiet_NaN();

}  // namespace

SampleSize SampleSizeAt(const LandLattice& lattice, double latitude_rad) {
  const double within = std::clamp(
      latitude_rad, lattice.north_rad - lattice.last_row * lattice.step_lat_rad, lattice.north_rad);
  const double e2 = kWgs84.flattening * (2.0 - kWgs84.flattening);
  const double sine = std::sin(within);
  const double w2 = 1.0 - e2 * sine * sine;
  const double across = kWgs84.equatorial_radius_m / std::sqrt(w2);
  // On a pole a column's step is nothing; a hundredth of it still tells columns apart.
  const double cosine = std::max(std::cos(within), 0.01);
  return {lattice.step_lon_rad * across * cosine, lattice.step_lat_rad * across * (1.0 - e2) / w2};
}

HeightBlock LoadedHeights::Block(int level, int first_i, int first_j, int columns, int rows) const {
  const LandLattice& lattice = tiles_->lattice();
  HeightBlock block{first_i, first_j, columns, rows, {}};
  block.height_m.reserve(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  const LatticeBox box{lattice.ColumnOf(first_i, level), lattice.RowOf(first_j, level),
                       lattice.ColumnOf(first_i + columns - 1, level),
                       lattice.RowOf(first_j + rows - 1, level)};
  std::vector<const HeightPyramid*> near;
  for (const int tile : tiles_->Touching(box))
    if (heights_[static_cast<std::size_t>(tile)])
      near.push_back(heights_[static_cast<std::size_t>(tile)].get());
  for (int j = first_j; j < first_j + rows; ++j) {
    const int row = lattice.RowOf(j, level);
    for (int i = first_i; i < first_i + columns; ++i) {
      const int column = lattice.ColumnOf(i, level);
      float height = kNoHeight;
      for (const HeightPyramid* pyramid : near) {
        if (!std::isnan(height)) break;
        if (pyramid->box().Holds(column, row)) height = pyramid->At(level, column, row);
      }
      block.height_m.push_back(height);
    }
  }
  return block;
}

std::optional<double> LoadedHeights::HeightUnder(double latitude_rad, double longitude_rad) const {
  const LandLattice& lattice = tiles_->lattice();
  const LatticePlace at = lattice.At(latitude_rad, longitude_rad);
  constexpr double kRounding = 1e-6;  // samples: the rim itself belongs to the land
  if (!(at.column >= -kRounding && at.column <= lattice.last_column + kRounding &&
        at.row >= -kRounding && at.row <= lattice.last_row + kRounding))
    return std::nullopt;
  if (tiles_->tiles().empty()) return std::nullopt;
  const int i = std::clamp(static_cast<int>(at.column), 0, lattice.last_column - 1);
  const int j = std::clamp(static_cast<int>(at.row), 0, lattice.last_row - 1);
  const HeightBlock block = Block(0, i - 1, j - 1, 4, 4);
  CellHeights around{};
  std::copy(block.height_m.begin(), block.height_m.end(), around.begin());
  return HeightOnTriangles(around, std::clamp(at.column - i, 0.0, 1.0),
                           std::clamp(at.row - j, 0.0, 1.0));
}

std::optional<ElevationGrid> LoadedHeights::SampledGrid(const GeodeticPosition& place,
                                                        double half_width_m,
                                                        int most_samples) const {
  if (tiles_->tiles().empty()) return std::nullopt;
  const LandLattice& lattice = tiles_->lattice();
  const SampleSize size = SampleSizeAt(lattice, place.latitude_rad);
  const LatticePlace at = lattice.At(place.latitude_rad, place.longitude_rad);
  const double half_columns = half_width_m / size.column_m, half_rows = half_width_m / size.row_m;
  // Of the land that there is: the lattice may end before.
  const auto within = [](double middle, double half, int last_sample) {
    return std::min(middle + half, static_cast<double>(last_sample)) - std::max(middle - half, 0.0);
  };
  const double most = std::max(within(at.column, half_columns, lattice.last_column),
                               within(at.row, half_rows, lattice.last_row));
  int level = 0;
  while (most / (1 << level) + 1.0 > most_samples) ++level;
  const double step = 1 << level;
  const auto first = [&](double from) {
    return std::max(static_cast<int>(std::ceil(from / step)), 0);
  };
  const auto last = [&](double to, int last_sample) {
    return std::min(static_cast<int>(std::floor(to / step)), last_sample >> level);
  };
  int i0 = first(at.column - half_columns), j0 = first(at.row - half_rows);
  int i1 = last(at.column + half_columns, lattice.last_column);
  int j1 = last(at.row + half_rows, lattice.last_row);
  if (i1 <= i0 || j1 <= j0) return std::nullopt;
  if (std::max(lattice.last_column, lattice.last_row) < most_samples) {
    i0 = j0 = 0;
    i1 = lattice.last_column;
    j1 = lattice.last_row;
  }
  const GeodeticPosition corner = lattice.PlaceOf(i0 << level, j0 << level, 0.0);
  ElevationGrid grid;
  grid.west_rad = corner.longitude_rad;
  grid.north_rad = corner.latitude_rad;
  grid.step_lon_rad = step * lattice.step_lon_rad;
  grid.step_lat_rad = step * lattice.step_lat_rad;
  grid.columns = i1 - i0 + 1;
  grid.rows = j1 - j0 + 1;
  grid.height_m = Block(level, i0, j0, grid.columns, grid.rows).height_m;
  return grid;
}

}  // namespace alpenglow::viewer
