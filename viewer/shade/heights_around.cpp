// SPDX-License-Identifier: MIT
#include "viewer/shade/heights_around.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "atmosphere/number/constants.h"
#include "atmosphere/text/error.h"
#include "renderer/terrain/cell_diagonal.h"

namespace alpenglow::viewer {
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

/// The samples as triangles.
class Facets {
 public:
  explicit Facets(const ElevationGrid& grid) : grid_(grid) {
    for (int row = 0; row + 1 < grid.rows; ++row) {
      for (int column = 0; column + 1 < grid.columns; ++column)
        falling_.push_back(FallingDiagonalFits(Around(row, column)));
    }
  }

  [[nodiscard]] float HeightAt(const Place& place) const {
    if (!(place.column >= 0.0 && place.column < grid_.columns - 1 && place.row >= 0.0 &&
          place.row < grid_.rows - 1))
      return HeightRaster::kNothing;
    const int column = static_cast<int>(place.column), row = static_cast<int>(place.row);
    const float height = Between(row, column, static_cast<float>(place.column - column),
                                 static_cast<float>(place.row - row));
    return std::isnan(height) ? HeightRaster::kNothing : height - static_cast<float>(place.drop_m);
  }

 private:
  [[nodiscard]] CellHeights Around(int row, int column) const {
    CellHeights around{};
    for (int i = 0; i < 16; ++i) {
      around[static_cast<std::size_t>(i)] =
          static_cast<double>(grid_.at(std::clamp(row + i / 4 - 1, 0, grid_.rows - 1),
                                       std::clamp(column + i % 4 - 1, 0, grid_.columns - 1)));
    }
    return around;
  }

  // @param x, y  from the cell's north-western corner, east and south, in [0, 1].
  [[nodiscard]] float Between(int row, int column, float x, float y) const {
    const float* north = &grid_.height_m[grid_.index(row, column)];
    const float* south = north + grid_.columns;
    const auto cell = static_cast<std::size_t>(row) * static_cast<std::size_t>(grid_.columns - 1) +
                      static_cast<std::size_t>(column);
    if (falling_[cell]) {
      return x > y ? north[0] + x * (north[1] - north[0]) + y * (south[1] - north[1])
                   : north[0] + x * (south[1] - south[0]) + y * (south[0] - north[0]);
    }
    return x + y < 1.0F
               ? north[0] + x * (north[1] - north[0]) + y * (south[0] - north[0])
               : south[1] + (1.0F - x) * (south[0] - south[1]) + (1.0F - y) * (north[1] - south[1]);
  }

  const ElevationGrid& grid_;
  std::vector<std::uint8_t> falling_;  // whether a cell is cut from north-west to south-east
};

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
  const Facets facets(grid);
  raster.z_m.reserve(raster.index(0, side));
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column)
      raster.z_m.push_back(facets.HeightAt(net.At(column, row)));
  }
  return raster;
}

}  // namespace alpenglow::viewer
