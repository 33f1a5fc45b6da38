// SPDX-License-Identifier: MIT
#include "viewer/shade/heights_around.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/number/constants.h"
#include "atmosphere/text/error.h"

namespace alpenglow {
namespace {

constexpr int kStride = 16;  // nodes between places that are found exactly

/// Of a node: where its ground lies in the grid of elevations, and how far the ellipsoid under it
/// lies below the plane of the frame.
struct Place {
  double column, row, drop_m;

  friend Place operator+(const Place& a, const Place& b) {
    return {a.column + b.column, a.row + b.row, a.drop_m + b.drop_m};
  }
  friend Place operator*(double k, const Place& a) {
    return {k * a.column, k * a.row, k * a.drop_m};
  }
};

Place ExactPlace(const ElevationGrid& grid, const LocalFrame& frame, double x_m, double y_m) {
  // The vertical through the node meets the ellipsoid where a second look at its height says.
  double z_m = 0.0;
  GeodeticPosition at{};
  for (int look = 0; look < 2; ++look) {
    at = frame.GeodeticFromEnu({{x_m, y_m, z_m}});
    z_m -= at.height_m;
  }
  const double west = grid.west_rad + 0.5 * (grid.columns - 1) * grid.step_lon_rad;
  const double east_of_middle = std::remainder(at.longitude_rad - west, 2.0 * kPi);
  return {east_of_middle / grid.step_lon_rad + 0.5 * (grid.columns - 1),
          (grid.north_rad - at.latitude_rad) / grid.step_lat_rad, -z_m};
}

float HeightAt(const ElevationGrid& grid, const Place& place) {
  const double last_column = grid.columns - 1, last_row = grid.rows - 1;
  if (!(place.column >= 0.0 && place.column <= last_column && place.row >= 0.0 &&
        place.row <= last_row))
    return HeightRaster::kNothing;
  const int column = std::min(static_cast<int>(place.column), std::max(grid.columns - 2, 0));
  const int row = std::min(static_cast<int>(place.row), std::max(grid.rows - 2, 0));
  const auto x = static_cast<float>(place.column - column);
  const auto y = static_cast<float>(place.row - row);
  const int right = std::min(column + 1, grid.columns - 1);
  const int below = std::min(row + 1, grid.rows - 1);
  const float north = (1.0F - x) * grid.at(row, column) + x * grid.at(row, right);
  const float south = (1.0F - x) * grid.at(below, column) + x * grid.at(below, right);
  const float height = (1.0F - y) * north + y * south;
  return std::isnan(height) ? HeightRaster::kNothing : height - static_cast<float>(place.drop_m);
}

/// A coarse net of exact places.
struct Net {
  int side;
  std::vector<Place> places;

  [[nodiscard]] Place At(int column, int row) const {
    const double x = static_cast<double>(column % kStride) / kStride;
    const double y = static_cast<double>(row % kStride) / kStride;
    const Place* low = &places[static_cast<std::size_t>(row / kStride * side + column / kStride)];
    const Place* high = low + side;
    return (1.0 - y) * ((1.0 - x) * low[0] + x * low[1]) + y * ((1.0 - x) * high[0] + x * high[1]);
  }
};

}  // namespace

HeightRaster HeightsAround(const ElevationGrid& grid, const LocalFrame& frame, double half_m,
                           int side) {
  ALPENGLOW_ENSURE(side, >=, 2);
  HeightRaster raster;
  raster.first_x_m = raster.first_y_m = -half_m;
  raster.cell_m = 2.0 * half_m / (side - 1);
  raster.columns = raster.rows = side;
  Net net{(side - 1) / kStride + 2, {}};
  for (int row = 0; row < net.side; ++row) {
    for (int column = 0; column < net.side; ++column) {
      net.places.push_back(ExactPlace(grid, frame,
                                      raster.first_x_m + raster.cell_m * kStride * column,
                                      raster.first_y_m + raster.cell_m * kStride * row));
    }
  }
  raster.z_m.reserve(raster.index(0, side));
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column)
      raster.z_m.push_back(HeightAt(grid, net.At(column, row)));
  }
  return raster;
}

}  // namespace alpenglow
