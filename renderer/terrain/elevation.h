// SPDX-License-Identifier: MIT
// Heights of the ground over a regular grid of geodetic coordinates (WGS84), and files that hold
// them.
//
// Units: radians, metres above the ellipsoid. A void is a sample without data; it is NaN.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace alpenglow::renderer {

/// Heights over a regular grid of geodetic coordinates. Row 0 is the northernmost. Longitudes may
/// run past pi: column c lies at west_rad + c step_lon_rad, and places are compared modulo 2 pi.
struct ElevationGrid {
  double west_rad = 0.0;   // longitude of column 0
  double north_rad = 0.0;  // latitude of row 0
  double step_lon_rad = 0.0;
  double step_lat_rad = 0.0;  // positive: rows go south
  int columns = 0;
  int rows = 0;
  std::vector<float> height_m;  // rows x columns; NaN where there is no ground (a void left open)

  [[nodiscard]] std::size_t index(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  }
  [[nodiscard]] float at(int row, int column) const { return height_m[index(row, column)]; }
  [[nodiscard]] double LatitudeOfRow(int row) const { return north_rad - row * step_lat_rad; }
  [[nodiscard]] double LongitudeOfColumn(int column) const {
    return west_rad + column * step_lon_rad;
  }
  /// Whether the columns go once around the earth, so
  /// that the last one is the first one's neighbour.
  [[nodiscard]] bool ClosesAroundTheEarth() const;
  /// Whether a place lies among the samples, void or not.
  [[nodiscard]] bool Covers(double latitude_rad, double longitude_rad) const;
  /// Bilinear height [m] at a place; nothing outside the grid or beside a void.
  [[nodiscard]] std::optional<double> HeightAt(double latitude_rad, double longitude_rad) const;
};

/// Some of the samples of a grid. Around the earth its columns may run past the last one.
struct GridWindow {
  int first_column = 0, first_row = 0;
  int columns = 0, rows = 0;
};

enum class VoidPolicy { kFill, kLeaveOpen };

struct ElevationModel {
  ElevationGrid grid;
  std::size_t voids = 0;         // samples without data in the file
  std::size_t voids_filled = 0;  // of which were filled from their surroundings
  /// What the file declares its heights to count from, as "EGM96 height"; empty where it declares
  /// nothing, or the ellipsoid.
  std::string vertical_datum;
  std::string unit_note;  // what is told about the unit of the heights; empty: nothing
};

/// A line on voids, units and datum of a model, with the name of its file; empty without cause.
[[nodiscard]] std::string NoteOn(const ElevationModel& model, const std::string& file);

/// Reads a digital elevation model: GeoTIFF, SRTM .hgt, USGS DEM; any coordinate system of the
/// earth (resampled to geographic WGS84 unless its samples already lie on such a grid). Heights are
/// in metres or feet; without a unit they are in feet on a map in feet, else in metres, which is
/// noted where the map is not in metres. They are taken as above the ellipsoid, whatever vertical
/// datum is declared. Voids are the declared nodata value, samples that a mask or an alpha band
/// leaves out, NaN, and the values that are nodata by custom: -32768, -32767, -9999, the lowest
/// float. kFill closes them with a membrane (Laplace's equation) spanned over their rims; places
/// outside the footprint of a resampled file stay open. Throws InputError naming the file and the
/// fault for no or a foreign coordinate system, a rotated or missing geotransform, several bands of
/// heights, complex samples, latitudes over 90, one row or column, no valid sample, heights that no
/// ground on earth has, damaged or truncated files.
[[nodiscard]] ElevationModel ReadElevation(const std::filesystem::path& file, VoidPolicy voids);

/// Reads those samples alone: at least 2 x 2 of the grid that ReadElevationExtent gives, of a file
/// for which CanBeCut holds. They may be nothing but voids, which then stay open.
[[nodiscard]] ElevationModel ReadElevation(const std::filesystem::path& file, VoidPolicy voids,
                                           const GridWindow& window);

/// A part of a file can be read alone where its samples lie on a grid of latitudes and longitudes,
/// from west to east.
[[nodiscard]] bool CanBeCut(const std::filesystem::path& file);

/// The grid that ReadElevation makes of a file, without its heights, which are not read. Throws
/// InputError as ReadElevation does, as far as it can tell without them.
[[nodiscard]] ElevationGrid ReadElevationExtent(const std::filesystem::path& file);

}  // namespace alpenglow::renderer
