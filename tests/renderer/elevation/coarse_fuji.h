// SPDX-License-Identifier: MIT
// Real terrain for tests, with fewer samples than its file has: large meshes take seconds to build.
#pragma once

#include <filesystem>

#include "atmosphere/math/constants.h"
#include "renderer/elevation/elevation.h"
#include "tests/fixtures/places.h"
#include "tests/fixtures/raster_file.h"

namespace alpenglow::tests {

using namespace renderer;

/// The elevation model around Mount Fuji.
inline std::filesystem::path FujiModel() {
  return std::filesystem::path(kSharedFolder) / "dem" / "N35E138.hgt";
}

/// Writes every fourth sample of FujiModel, and returns the file.
inline std::filesystem::path CoarseFuji(const std::filesystem::path& folder) {
  constexpr int kEvery = 4;
  const ElevationGrid grid = ReadElevation(FujiModel(), VoidPolicy::kFill).grid;
  const double across = kEvery * grid.step_lon_rad / kRadiansPerDegree;
  const double down = kEvery * grid.step_lat_rad / kRadiansPerDegree;
  Raster raster;
  raster.columns = 1 + (grid.columns - 1) / kEvery;
  raster.rows = 1 + (grid.rows - 1) / kEvery;
  raster.geotransform = {grid.west_rad / kRadiansPerDegree - 0.5 * across, across, 0.0,
                         grid.north_rad / kRadiansPerDegree + 0.5 * down,  0.0,    -down};
  raster.height = [&](int row, int column) { return grid.at(kEvery * row, kEvery * column); };
  return WriteRaster(folder, raster);
}

}  // namespace alpenglow::tests
