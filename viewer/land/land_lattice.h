// SPDX-License-Identifier: MIT
// The lattice that all levels of detail stand on: latitudes and longitudes in even steps.
//
// Level k has every 2^k-th sample of both axes, from the lattice's north-west corner, and its last
// row and column whatever their numbers, so that every level ends at the same rim. A sample is
// named by its column and row of level 0, a vertex of level k by i and j: column min(i 2^k, last).
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "atmosphere/sun/geodesy.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// A rectangle of samples of level 0, both ends included.
struct LatticeBox {
  int first_column = 0, first_row = 0;
  int last_column = -1, last_row = -1;

  [[nodiscard]] bool Holds(int column, int row) const {
    return column >= first_column && column <= last_column && row >= first_row && row <= last_row;
  }
  [[nodiscard]] bool Touches(const LatticeBox& other) const {
    return first_column <= other.last_column && other.first_column <= last_column &&
           first_row <= other.last_row && other.first_row <= last_row;
  }
};

/// A place between the samples, in columns and rows of level 0.
struct LatticePlace {
  double column = 0.0, row = 0.0;
};

struct LandLattice {
  double west_rad = 0.0, north_rad = 0.0;  // of sample (0, 0)
  double step_lon_rad = 0.0, step_lat_rad = 0.0;
  int last_column = 0, last_row = 0;

  /// Of the vertices of a level.
  [[nodiscard]] int LastVertex(int last_sample, int level) const {
    return (last_sample + (1 << level) - 1) >> level;
  }
  [[nodiscard]] int LastI(int level) const { return LastVertex(last_column, level); }
  [[nodiscard]] int LastJ(int level) const { return LastVertex(last_row, level); }
  [[nodiscard]] int ColumnOf(int i, int level) const {
    return std::clamp(i * (1 << level), 0, last_column);
  }
  [[nodiscard]] int RowOf(int j, int level) const {
    return std::clamp(j * (1 << level), 0, last_row);
  }

  /// Where a sample lies; rows that a grid has beyond a pole lie on it.
  [[nodiscard]] GeodeticPosition PlaceOf(int column, int row, double height_m) const {
    constexpr double kPole = 0.5 * std::numbers::pi;
    return {std::clamp(north_rad - row * step_lat_rad, -kPole, kPole),
            west_rad + column * step_lon_rad, height_m};
  }

  /// The turn of the longitude that comes nearest to the lattice's middle.
  [[nodiscard]] LatticePlace At(double latitude_rad, double longitude_rad) const {
    const double middle = west_rad + 0.5 * last_column * step_lon_rad;
    const double east = std::remainder(longitude_rad - middle, 2.0 * std::numbers::pi);
    return {0.5 * last_column + east / step_lon_rad, (north_rad - latitude_rad) / step_lat_rad};
  }
};

}  // namespace alpenglow::viewer
