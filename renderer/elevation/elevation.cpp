// SPDX-License-Identifier: MIT
#include "renderer/elevation/elevation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "atmosphere/base/error.h"
#include "renderer/elevation/elevation_raster.h"
#include "renderer/elevation/geographic_grid.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

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
  const double turn = 2.0 * std::numbers::pi / grid.step_lon_rad;  // columns in a full turn
  double column = (longitude_rad - grid.west_rad) / grid.step_lon_rad;
  column -= turn * std::floor(column / turn);
  const double row = (grid.north_rad - latitude_rad) / grid.step_lat_rad;
  const bool closed = grid.ClosesAroundTheEarth();
  // Rounding may give a place on the first column a whole turn minus an ulp.
  if (!closed && column > turn - 1e-6) column = 0.0;
  const double last_column = closed ? grid.columns : grid.columns - 1;
  constexpr double kRounding = 1e-6;  // samples: the rim itself belongs to the grid
  const bool is_inside =
      row >= -kRounding && row <= grid.rows - 1 + kRounding && column <= last_column + kRounding;
  return {row, column, is_inside};
}

// Returns the vertical datum, if one is declared and it is not the ellipsoid.
std::string VerticalDatumOf(const OGRSpatialReference& crs) {
  const char* const name = crs.GetAttrValue("VERT_CS");
  if (name == nullptr) return "";
  return std::string(name).find("llipsoid") == std::string::npos ? name : "";
}

ElevationModel ModelOf(ElevationRaster raster, VoidPolicy voids, const std::string& file) {
  ElevationModel model;
  model.voids = raster.voids;
  if (voids == VoidPolicy::kFill && raster.voids > 0 && raster.voids < raster.height_m.size()) {
    model.voids_filled = FillVoids(raster.height_m, raster.rows, raster.columns);
  }
  model.vertical_datum = VerticalDatumOf(raster.crs);
  model.unit_note = raster.unit_note;
  model.grid = GeographicGrid(raster, file);
  return model;
}

// Returns the parts of a window on both sides of the last column of a grid around the earth.
std::vector<GridWindow> PartsOf(const GridWindow& window, int all_columns) {
  GridWindow before = window;
  before.columns = std::min(window.columns, all_columns - window.first_column);
  if (before.columns == window.columns) return {window};
  GridWindow after = window;
  after.first_column = 0;
  after.columns = window.columns - before.columns;
  return {before, after};
}

// Joins two rasters with equal numbers of rows side by side.
void Append(ElevationRaster& west, const ElevationRaster& east) {
  std::vector<float> height_m;
  const auto row_of = [](const ElevationRaster& of, int row) {
    return of.height_m.begin() + static_cast<std::ptrdiff_t>(row) * of.columns;
  };
  for (int row = 0; row < west.rows; ++row) {
    height_m.insert(height_m.end(), row_of(west, row), row_of(west, row + 1));
    height_m.insert(height_m.end(), row_of(east, row), row_of(east, row + 1));
  }
  west.height_m = std::move(height_m);
  west.columns += east.columns;
  west.voids += east.voids;
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
  return ModelOf(ReadElevationRaster(file), voids, file.string());
}

ElevationModel ReadElevation(const std::filesystem::path& file, VoidPolicy voids,
                             const GridWindow& window) {
  const QuietGdal quiet;
  const ElevationRaster header = ReadElevationHeader(file);
  std::optional<ElevationRaster> whole;
  for (const GridWindow& part : PartsOf(window, header.columns)) {
    const std::optional<PixelWindow> pixels = PixelsOf(header, part, file.string());
    if (!pixels) throw InternalError(file.string() + ": a window of a grid that was resampled");
    ElevationRaster raster = ReadElevationRaster(file, pixels);
    if (whole) {
      Append(*whole, raster);
    } else {
      whole = std::move(raster);
    }
  }
  return ModelOf(std::move(*whole), voids, file.string());
}

bool CanBeCut(const std::filesystem::path& file) {
  const QuietGdal quiet;
  const ElevationRaster header = ReadElevationHeader(file);
  return PixelsOf(header, {0, 0, header.columns, header.rows}, file.string()).has_value();
}

std::string NoteOn(const ElevationModel& model, const std::string& file) {
  std::vector<std::string> notes;
  if (model.voids > 0) {
    notes.push_back(
        fmt::format("{} samples without data, {} filled", model.voids, model.voids_filled));
  }
  if (!model.unit_note.empty()) notes.push_back(model.unit_note);
  if (!model.vertical_datum.empty()) {
    notes.push_back(
        fmt::format("heights are declared as {}; they are taken as over the ellipsoid, "
                    "which may lie a hundred metres off",
                    model.vertical_datum));
  }
  return notes.empty() ? "" : fmt::format("{}: {}", file, fmt::join(notes, "; "));
}

ElevationGrid ReadElevationExtent(const std::filesystem::path& file) {
  const QuietGdal quiet;
  return GeographicExtent(ReadElevationHeader(file), file.string());
}

}  // namespace alpenglow::renderer
