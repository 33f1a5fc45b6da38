// SPDX-License-Identifier: MIT
// Provides grids of heights for tests, whose extent is given in degrees.
#pragma once

#include <array>
#include <functional>

#include "atmosphere/math/constants.h"
#include "atmosphere/time_place/geodesy.h"
#include "renderer/elevation/elevation.h"
#include "renderer/layer.h"

namespace alpenglow::tests {

using namespace renderer;

/// Returns the frame of a place at height 0.
inline LocalFrame FrameAt(double latitude_deg, double longitude_deg) {
  return LocalFrame(kWgs84, CheckedPlace({latitude_deg, longitude_deg, 0.0}));
}

/// Returns a grid whose heights [m] are a function of row and column.
/// @param step_deg  of latitude and longitude.
inline ElevationGrid GridInDegrees(double north_deg, double west_deg,
                                   std::array<double, 2> step_deg, int rows, int columns,
                                   const std::function<double(int, int)>& height) {
  ElevationGrid grid;
  grid.north_rad = north_deg * kRadiansPerDegree;
  grid.west_rad = west_deg * kRadiansPerDegree;
  grid.step_lat_rad = step_deg[0] * kRadiansPerDegree;
  grid.step_lon_rad = step_deg[1] * kRadiansPerDegree;
  grid.rows = rows;
  grid.columns = columns;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column)
      grid.height_m.push_back(static_cast<float>(height(row, column)));
  }
  return grid;
}

}  // namespace alpenglow::tests
