// SPDX-License-Identifier: MIT
// This header provides heights of the ground over a regular grid of geodetic coordinates (WGS84),
// and reads them from files.
//
// Units: radians, metres above the ellipsoid. A void is a sample without data; it is NaN.
//
// Heights of the ground have these types, because their axes differ:
//
//   ElevationGrid     angles, equal steps: what readers of files and the built-in range return
//   ElevationRaster   as in a file, mostly metres of a map projection (elevation_raster.h)
//   HeightPyramid     a tile at all levels of detail on the lattice of all tiles (land_source.h)
//   LoadedHeights     the tiles that are in memory (loaded_heights.h)
//   HeightRaster      metres in the plane of a mesh's frame, from the lower left (mesh.h)
//   MeshHeights       no grid: exact heights on the triangles of a mesh (mesh.h)
//   Land              the built-in range before it lies on the earth: squares of metres (land.h)
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
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
  std::vector<float> height_m;  // rows x columns; NaN where there is no ground (an unfilled void)

  [[nodiscard]] std::size_t index(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  }
  [[nodiscard]] float at(int row, int column) const { return height_m[index(row, column)]; }
  [[nodiscard]] double LatitudeOfRow(int row) const { return north_rad - row * step_lat_rad; }
  [[nodiscard]] double LongitudeOfColumn(int column) const {
    return west_rad + column * step_lon_rad;
  }
  /// Returns whether the columns go once around the earth, so that the last one is the first one's
  /// neighbour.
  [[nodiscard]] bool ClosesAroundTheEarth() const;
  /// Returns whether a place lies among the samples, void or not.
  [[nodiscard]] bool Covers(double latitude_rad, double longitude_rad) const;
  /// Returns the bilinear height [m] at a place; nullopt outside the grid or beside a void.
  [[nodiscard]] std::optional<double> HeightAt(double latitude_rad, double longitude_rad) const;
};

/// A part of the samples of a grid. If the grid goes around the earth, the columns may run past the
/// last one.
struct GridWindow {
  int first_column = 0, first_row = 0;
  int columns = 0, rows = 0;
};

enum class VoidPolicy { kFill, kLeaveOpen };

/// A grid with what its file says about it.
struct ElevationModel {
  ElevationGrid grid;
  std::size_t voids = 0;         // samples without data in the file
  std::size_t voids_filled = 0;  // voids that were filled from their surroundings
  /// Vertical datum that the file declares for its heights, as "EGM96 height"; empty if it declares
  /// none, or the ellipsoid.
  std::string vertical_datum;
  std::string unit_note;  // note on the unit of the heights; empty: none
};

/// Returns a line on voids, units and datum of a model, with the name of its file; empty if there
/// is nothing to report.
[[nodiscard]] std::string NoteOn(const ElevationModel& model, const std::string& file);

/// Returns the extensions of elevation models, with the point. They select the files of a folder;
/// a file that is named is read whatever its extension is.
[[nodiscard]] std::span<const char* const> ElevationExtensions();

/// Reads a digital elevation model: GeoTIFF, SRTM .hgt, USGS DEM; any coordinate system of the
/// earth (resampled to geographic WGS84 unless its samples already lie on such a grid). Heights are
/// in metres (also mm, cm, dm, km) or feet, with the declared scale and offset. Without a unit they
/// are in feet on a map in feet, else in metres; unit_note reports this if the map is not in
/// metres. They are interpreted as above the ellipsoid, whatever vertical datum is declared. Voids
/// are NaN, the declared nodata value, and samples that a mask or an alpha band excludes; declared
/// values at the largest float, which texts round, and beyond it are one value. In a file that
/// declares neither they are the heights -32768, -32767, -9999, the lowest float and the
/// lowest double, in its unit. kFill fills them with a membrane (Laplace's equation) spanned over
/// their rims; places outside the footprint of a resampled file stay open. Throws InputError naming
/// the file and the fault for a coordinate system that is missing or not of the earth, a rotated or
/// missing geotransform, several bands of heights, complex samples, a scale of 0, latitudes over
/// 90, one row or column, no valid sample, heights that no ground on earth has, damaged or
/// truncated files.
[[nodiscard]] ElevationModel ReadElevation(const std::filesystem::path& file, VoidPolicy voids);

/// Reads only the samples of `window`: at least 2 x 2 of the grid of ReadElevationExtent, from a
/// file for which CanBeCut is true. They may all be voids, which then stay open.
[[nodiscard]] ElevationModel ReadElevation(const std::filesystem::path& file, VoidPolicy voids,
                                           const GridWindow& window);

/// Returns whether a part of the file can be read separately: its samples must lie on a grid of
/// latitudes and longitudes, from west to east.
[[nodiscard]] bool CanBeCut(const std::filesystem::path& file);

/// Returns the grid of ReadElevation without its heights, which are not read. Throws the
/// InputErrors of ReadElevation that can be detected without heights.
[[nodiscard]] ElevationGrid ReadElevationExtent(const std::filesystem::path& file);

}  // namespace alpenglow::renderer
