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

namespace {

/// A place in rows and columns of a grid.
struct GridPlace {
  double row, column;
  bool is_inside;
};

GridPlace PlaceIn(const ElevationGrid& grid, double latitude_rad, double longitude_rad) {
  const double turn = 2.0 * std::numbers::pi / grid.step_lon_rad;  // columns once around
  double column = (longitude_rad - grid.west_rad) / grid.step_lon_rad;
  column -= turn * std::floor(column / turn);
  const double row = (grid.north_rad - latitude_rad) / grid.step_lat_rad;
  const bool closed = grid.ClosesAroundTheEarth();
  // A place on the first column may come out as one turn less an ulp.
  if (!closed && column > turn - 1e-6) column = 0.0;
  const double last_column = closed ? grid.columns : grid.columns - 1;
  constexpr double kRounding = 1e-6;  // samples: the rim itself belongs to the grid
  const bool is_inside =
      row >= -kRounding && row <= grid.rows - 1 + kRounding && column <= last_column + kRounding;
  return {row, column, is_inside};
}

// What the heights count from, if that is declared and not the ellipsoid.
std::string VerticalDatumOf(const OGRSpatialReference& crs) {
  const char* const name = crs.GetAttrValue("VERT_CS");
  if (name == nullptr) return "";
  return std::string(name).find("llipsoid") == std::string::npos ? name : "";
}

}  // namespace

bool ElevationGrid::Covers(double latitude_rad, double longitude_rad) const {
  return PlaceIn(*this, latitude_rad, longitude_rad).is_inside;
}

std::optional<double> ElevationGrid::HeightAt(double latitude_rad, double longitude_rad) const {
  const auto [row, column, is_inside] = PlaceIn(*this, latitude_rad, longitude_rad);
  if (!is_inside) return std::nullopt;
  const int r = std::clamp(static_cast<int>(row), 0, rows - 2);
  const int c =
      std::clamp(static_cast<int>(column), 0, ClosesAroundTheEarth() ? columns - 1 : columns - 2);
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
  model.vertical_datum = VerticalDatumOf(raster.crs);
  model.grid = GeographicGrid(raster, file.string());
  return model;
}

ElevationGrid ReadElevationExtent(const std::filesystem::path& file) {
  const QuietGdal quiet;
  return GeographicExtent(ReadElevationHeader(file), file.string());
}

}  // namespace alpenglow
