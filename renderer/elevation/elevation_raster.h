// SPDX-License-Identifier: MIT
// This header provides the steps of ReadElevation: reading a raster as stored in its file, filling
// voids, resampling to geographic WGS84.
#pragma once

#include <ogr_spatialref.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "renderer/elevation/elevation.h"
#include "renderer/elevation/gdal_file.h"

namespace alpenglow::renderer {

/// Largest number of samples of a model: 1 GiB of heights.
inline constexpr std::int64_t kMostElevationSamples = std::int64_t{1} << 28;

/// Heights [m] in the file's own coordinate system, north or south up.
struct ElevationRaster {
  int columns = 0;
  int rows = 0;
  std::array<double, 6> geotransform{};  // GDAL's: corner of the first pixel, no rotation
  OGRSpatialReference crs;               // x is east
  std::vector<float> height_m;           // rows x columns; NaN: void
  std::size_t voids = 0;
  std::string unit_note;  // note on the unit of the heights; empty: none

  [[nodiscard]] double CentreX(double column) const {
    return geotransform[0] + (column + 0.5) * geotransform[1];
  }
  [[nodiscard]] double CentreY(double row) const {
    return geotransform[3] + (row + 0.5) * geotransform[5];
  }
};

/// Reads and checks a file, or a window of it, which must lie within the file and may contain only
/// voids; throws InputError as ReadElevation does.
[[nodiscard]] ElevationRaster ReadElevationRaster(
    const std::filesystem::path& file, const std::optional<PixelWindow>& window = std::nullopt);

/// Reads and checks a file without its samples, which are neither read nor checked.
[[nodiscard]] ElevationRaster ReadElevationHeader(const std::filesystem::path& file);

/// Fills the NaN samples of a rows x columns raster with a membrane: Laplace's equation with the
/// rim as boundary (free at the raster's edge), so that a hole in a plane is filled by the plane.
/// At least one sample must be valid. Returns the number of filled samples.
std::size_t FillVoids(std::vector<float>& height, int rows, int columns);

/// Converts a raster to a grid of latitudes and longitudes of about equal spacing. Samples that
/// already lie on such a grid are copied; otherwise they are interpolated bilinearly, with NaN
/// outside the footprint. Throws InputError, naming `file`, for places that are not on the earth.
[[nodiscard]] ElevationGrid GeographicGrid(const ElevationRaster& raster, const std::string& file);

/// Returns the pixels of those samples of the raster's own grid; nullopt if its samples do not lie
/// on a grid of latitudes and longitudes or run westwards. The window may not run past the last
/// column.
[[nodiscard]] std::optional<PixelWindow> PixelsOf(const ElevationRaster& raster,
                                                  const GridWindow& window,
                                                  const std::string& file);

/// Returns the grid of GeographicGrid without heights; the raster may have none either.
[[nodiscard]] ElevationGrid GeographicExtent(const ElevationRaster& raster,
                                             const std::string& file);

}  // namespace alpenglow::renderer
