// SPDX-License-Identifier: MIT
// This header provides rasters of heights as stored in their files, and fills their voids.
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

/// Heights [m] in the file's own coordinate system, north or south up. ReadElevation makes an
/// ElevationGrid of it, which has angles as axes.
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

}  // namespace alpenglow::renderer
