// SPDX-License-Identifier: MIT
// Steps of ReadElevation: a raster as its file has it, voids closed, resampled to geographic WGS84.
#pragma once

#include <cpl_error.h>
#include <ogr_spatialref.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "renderer/terrain/elevation.h"

namespace alpenglow::renderer {

/// The most samples of a model: 1 GiB of heights.
inline constexpr std::int64_t kMostElevationSamples = std::int64_t{1} << 28;

/// While it lives GDAL keeps its messages (CPLGetLastErrorMsg) instead of printing them.
class QuietGdal {
 public:
  QuietGdal() {
    CPLPushErrorHandler(CPLQuietErrorHandler);
    CPLErrorReset();
  }
  ~QuietGdal() { CPLPopErrorHandler(); }
  QuietGdal(const QuietGdal&) = delete;
  QuietGdal& operator=(const QuietGdal&) = delete;
};

/// Heights [m] in the file's own coordinate system, north or south up.
struct ElevationRaster {
  int columns = 0;
  int rows = 0;
  std::array<double, 6> geotransform{};  // GDAL's: corner of the first pixel, no rotation
  OGRSpatialReference crs;               // x is east
  std::vector<float> height_m;           // rows x columns; NaN: void
  std::size_t voids = 0;
  std::string unit_note;  // what is told about the unit of the heights; empty: nothing

  [[nodiscard]] double CentreX(double column) const {
    return geotransform[0] + (column + 0.5) * geotransform[1];
  }
  [[nodiscard]] double CentreY(double row) const {
    return geotransform[3] + (row + 0.5) * geotransform[5];
  }
};

/// Some of the pixels of a file.
struct PixelWindow {
  int column = 0, row = 0;
  int columns = 0, rows = 0;
};

/// Reads and checks a file, or a window of it, which must lie in it and may hold nothing but voids;
/// throws InputError as ReadElevation does.
[[nodiscard]] ElevationRaster ReadElevationRaster(
    const std::filesystem::path& file, const std::optional<PixelWindow>& window = std::nullopt);

/// The same without samples, which are not read and not checked.
[[nodiscard]] ElevationRaster ReadElevationHeader(const std::filesystem::path& file);

/// Closes the NaN samples of a rows x columns raster with a membrane: Laplace's equation with the
/// rim as boundary (free at the raster's edge), so that a hole in a plane is closed by the plane.
/// At least one sample must be valid. Returns how many were filled.
std::size_t FillVoids(std::vector<float>& height, int rows, int columns);

/// Brings a raster onto a grid of latitudes and longitudes of about the same spacing. Samples are
/// kept as they are where they lie on such a grid already; else bilinear, NaN outside the
/// footprint. Throws InputError, naming `file`, for places that are not on the earth.
[[nodiscard]] ElevationGrid GeographicGrid(const ElevationRaster& raster, const std::string& file);

/// The pixels that are those samples of the raster's own grid; nothing where its samples do not lie
/// on a grid of latitudes and longitudes or run westwards. The window may not run past the last
/// column.
[[nodiscard]] std::optional<PixelWindow> PixelsOf(const ElevationRaster& raster,
                                                  const GridWindow& window,
                                                  const std::string& file);

/// That grid without heights, from a raster that may have none either.
[[nodiscard]] ElevationGrid GeographicExtent(const ElevationRaster& raster,
                                             const std::string& file);

}  // namespace alpenglow::renderer
