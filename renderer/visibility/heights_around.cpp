// SPDX-License-Identifier: MIT
#include "renderer/visibility/heights_around.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"

namespace alpenglow::renderer {
namespace {

constexpr int kStride = 16;  // nodes between exactly computed places

/// Position of a node's ground in the elevation grid, and depth of the ellipsoid under it below the
/// plane of the frame.
struct NodePlace {
  double column, row, drop_m;

  friend NodePlace operator+(const NodePlace& a, const NodePlace& b) {
    return {a.column + b.column, a.row + b.row, a.drop_m + b.drop_m};
  }
  friend NodePlace operator*(double k, const NodePlace& a) {
    return {k * a.column, k * a.row, k * a.drop_m};
  }
};

NodePlace ExactPlace(const ElevationGrid& grid, const LocalFrame& frame, double x_m, double y_m) {
  // Finds where the vertical through the node meets the ellipsoid, with two iterations.
  double z_m = 0.0;
  Place at{};
  for (int look = 0; look < 2; ++look) {
    at = frame.GeodeticFromEnu({{x_m, y_m, z_m}});
    z_m -= at.height_m;
  }
  const double west = grid.west_rad + 0.5 * (grid.columns - 1) * grid.step_lon_rad;
  const double east_of_middle = std::remainder(at.longitude_rad() - west, 2.0 * kPi);
  return {east_of_middle / grid.step_lon_rad + 0.5 * (grid.columns - 1),
          (grid.north_rad - at.latitude_rad()) / grid.step_lat_rad, -z_m};
}

/// The surface of the samples as triangles.
class Facets {
 public:
  explicit Facets(const ElevationGrid& grid) : grid_(grid), closes_(grid.ClosesAroundTheEarth()) {
    for (int row = 0; row + 1 < grid.rows; ++row) {
      for (int column = 0; column < columns(); ++column)
        falling_.push_back(FallingDiagonalFits(Around(row, column)));
    }
  }

  [[nodiscard]] float HeightAt(NodePlace place) const {
    if (closes_) {
      place.column -= grid_.columns * std::floor(place.column / grid_.columns);
      if (place.column >= grid_.columns) place.column = 0.0;  // a sum just below 0 has been rounded
    }
    if (!(place.column >= 0.0 && place.column < columns() && place.row >= 0.0 &&
          place.row < grid_.rows - 1))
      return HeightRaster::kNothing;
    const int column = static_cast<int>(place.column), row = static_cast<int>(place.row);
    const float height = Between(row, column, static_cast<float>(place.column - column),
                                 static_cast<float>(place.row - row));
    return std::isnan(height) ? HeightRaster::kNothing : height - static_cast<float>(place.drop_m);
  }

 private:
  // Returns the number of cells of a row.
  [[nodiscard]] int columns() const { return closes_ ? grid_.columns : grid_.columns - 1; }

  [[nodiscard]] CellHeights Around(int row, int column) const {
    CellHeights around{};
    for (int i = 0; i < 16; ++i) {
      const int beside = column + i % 4 - 1;
      around[static_cast<std::size_t>(i)] =
          static_cast<double>(grid_.at(std::clamp(row + i / 4 - 1, 0, grid_.rows - 1),
                                       closes_ ? (beside + grid_.columns) % grid_.columns
                                               : std::clamp(beside, 0, grid_.columns - 1)));
    }
    return around;
  }

  // Interpolates within a cell.
  // @param x, y  from the cell's north-western corner, east and south, in [0, 1].
  [[nodiscard]] float Between(int row, int column, float x, float y) const {
    const int east = (column + 1) % grid_.columns;
    const std::array<float, 2> north{grid_.at(row, column), grid_.at(row, east)};
    const std::array<float, 2> south{grid_.at(row + 1, column), grid_.at(row + 1, east)};
    const auto cell = static_cast<std::size_t>(row) * static_cast<std::size_t>(columns()) +
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
  bool closes_;
  std::vector<std::uint8_t> falling_;  // whether a cell is cut from north-west to south-east
};

/// A coarse grid of exact places, between which positions are interpolated.
struct Net {
  int side;
  std::vector<NodePlace> places;

  // Returns an interpolated place; nullopt where columns change so much within a cell of the net
  // that they cannot be interpolated: beside a pole, and where they begin again.
  [[nodiscard]] std::optional<NodePlace> At(int column, int row, double most_columns) const {
    const double x = static_cast<double>(column % kStride) / kStride;
    const double y = static_cast<double>(row % kStride) / kStride;
    const NodePlace* low =
        &places[static_cast<std::size_t>(row / kStride * side + column / kStride)];
    const NodePlace* high = low + side;
    const auto [least, most] =
        std::minmax({low[0].column, low[1].column, high[0].column, high[1].column});
    if (most - least > most_columns) return std::nullopt;
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
  // Over a smaller angle, positions on a meridian bend by less than 0.05^2 / 8 of their distance
  // from the pole.
  constexpr double kMostTurn_rad = 0.05;
  const Facets facets(grid);
  raster.z_m.reserve(raster.index(0, side));
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      const auto place = net.At(column, row, kMostTurn_rad / grid.step_lon_rad);
      raster.z_m.push_back(
          facets.HeightAt(place ? *place
                                : ExactPlace(grid, frame, raster.first_x_m + raster.cell_m * column,
                                             raster.first_y_m + raster.cell_m * row)));
    }
  }
  return raster;
}

}  // namespace alpenglow::renderer
