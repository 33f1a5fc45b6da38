// SPDX-License-Identifier: MIT
#include "renderer/terrain/elevation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "renderer/terrain/elevation_raster.h"

namespace alpenglow {

bool ElevationGrid::ClosesAroundTheEarth() const {
  const double turn = columns * step_lon_rad;
  return std::abs(turn - 2.0 * std::numbers::pi) < 1e-3 * step_lon_rad;
}

std::optional<double> ElevationGrid::HeightAt(double latitude_rad, double longitude_rad) const {
  const double turn = 2.0 * std::numbers::pi / step_lon_rad;  // columns once around
  double column = (longitude_rad - west_rad) / step_lon_rad;
  column -= turn * std::floor(column / turn);
  const double row = (north_rad - latitude_rad) / step_lat_rad;
  const bool closed = ClosesAroundTheEarth();
  // A place on the first column may come out as one turn less an ulp.
  if (!closed && column > turn - 1e-6) column = 0.0;
  const double last_column = closed ? columns : columns - 1;
  constexpr double kRounding = 1e-6;  // samples: the rim itself belongs to the grid
  if (!(row >= -kRounding && row <= rows - 1 + kRounding && column <= last_column + kRounding)) {
    return std::nullopt;
  }
  const int r = std::clamp(static_cast<int>(row), 0, rows - 2);
  const int c = std::clamp(static_cast<int>(column), 0, closed ? columns - 1 : columns - 2);
  const int next = (c + 1) % columns;
  const double fr = std::clamp(row - r, 0.0, 1.0);
  const double fc = std::clamp(column - c, 0.0, 1.0);
  const double upper =
      (1.0 - fc) * static_cast<double>(at(r, c)) + fc * static_cast<double>(at(r, next));
  const double lower =
      (1.0 - fc) * static_cast<double>(at(r + 1, c)) + fc * static_cast<double>(at(r + 1, next));
  const double height = (1.0 - fr) * upper + fr * lower;
  if (std::isnan(height)) return std::nullopt;
  return height;
}

ElevationModel ReadElevation(const std::filesystem::path& file, VoidPolicy voids) {
  const QuietGdal quiet;
  ElevationRaster raster = ReadElevationRaster(file);
  ElevationModel model;
  model.voids = raster.voids;
  if (voids == VoidPolicy::kFill && raster.voids > 0) {
    model.voids_filled = FillVoids(raster.height_m, raster.rows, raster.columns);
  }
  model.grid = GeographicGrid(raster, file.string());
  return model;
}

}  // namespace alpenglow
