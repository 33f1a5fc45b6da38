// SPDX-License-Identifier: MIT
// This header resamples a raster of any projection to a grid of latitudes and longitudes (WGS84).
#pragma once

#include <optional>
#include <string>

#include "renderer/elevation/elevation_raster.h"

namespace alpenglow::renderer {

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
