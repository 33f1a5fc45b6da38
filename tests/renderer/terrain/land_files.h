// SPDX-License-Identifier: MIT
// Elevation models for tests: tiles of mountains of noise.
#pragma once

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "atmosphere/math/constants.h"
#include "renderer/terrain/land_source.h"
#include "renderer/terrain/loaded_heights.h"
#include "tests/fixtures/rough_land.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::tests {

using namespace renderer;

inline constexpr double kTileStep_deg = 1.0 / 2400.0;  // 46 m
inline constexpr int kTileSamples = 241;               // a side: a tenth of a degree
inline constexpr double kWest_deg = 8.0, kNorth_deg = 46.7;

/// Whole metres.
inline float HeightOfSample(int column, int row) {
  return static_cast<float>(std::round(RoughLand(32.0 * column, -46.0 * row)));
}

/// Samples of a file in degrees, from the north-western one on.
struct DegreeGrid {
  double west_deg, north_deg, step_lon_deg, step_lat_deg;
  int columns, rows;
};

/// Writes an elevation model of floats.
/// @param height  [m] of a sample of the file.
inline void WriteModel(const std::filesystem::path& file, const DegreeGrid& grid,
                       const std::function<float(int column, int row)>& height) {
  GDALRegister_GTiff();
  GDALDataset* const dataset = GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
      file.c_str(), grid.columns, grid.rows, 1, GDT_Float32, nullptr);
  std::array<double, 6> corner{grid.west_deg - 0.5 * grid.step_lon_deg,
                               grid.step_lon_deg,
                               0.0,
                               grid.north_deg + 0.5 * grid.step_lat_deg,
                               0.0,
                               -grid.step_lat_deg};
  dataset->SetGeoTransform(corner.data());
  OGRSpatialReference crs;
  crs.importFromEPSG(4326);
  dataset->SetSpatialRef(&crs);
  std::vector<float> heights;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) heights.push_back(height(column, row));
  EXPECT_EQ(
      dataset->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, grid.columns, grid.rows, heights.data(),
                                          grid.columns, grid.rows, GDT_Float32, 0, 0, nullptr),
      CE_None);
  GDALClose(dataset);
}

/// Writes a tile of every `stride`-th sample from sample (column, row) of the land on.
/// @param height  [m] of a sample.
inline void WriteTile(const std::filesystem::path& file, int first_column, int first_row,
                      int samples = kTileSamples, int stride = 1,
                      const std::function<float(int column, int row)>& height = HeightOfSample) {
  const double step_deg = stride * kTileStep_deg;
  WriteModel(file,
             {kWest_deg + first_column * kTileStep_deg, kNorth_deg - first_row * kTileStep_deg,
              step_deg, step_deg, samples, samples},
             [&](int column, int row) {
               return height(first_column + stride * column, first_row + stride * row);
             });
}

/// Height [m] of smooth land around a pole: a plane, seen from the pole, and a wave.
inline float HeightNearPole(double latitude_deg, double longitude_deg) {
  const double from_pole = 90.0 - std::abs(latitude_deg), turn = longitude_deg * kRadiansPerDegree;
  const double x = from_pole * std::cos(turn), y = from_pole * std::sin(turn);
  return static_cast<float>(1500.0 + 60.0 * x - 40.0 * y + 200.0 * std::sin(0.5 * x + 0.2));
}

/// Writes a model around a pole with 512 columns and 64 rows. Its rim is half a row from the pole.
/// @param hemisphere  1: north, -1: south.
inline void WritePolarModel(const std::filesystem::path& file, double hemisphere,
                            double row_deg = 0.1) {
  constexpr int kColumns = 512, kRows = 64;
  constexpr double kColumn_deg = 360.0 / kColumns;
  const double first = 90.0 - 0.5 * row_deg;
  const double north = hemisphere > 0.0 ? first : -first + (kRows - 1) * row_deg;
  WriteModel(file, {-180.0, north, kColumn_deg, row_deg, kColumns, kRows},
             [&](int column, int row) {
               return HeightNearPole(north - row * row_deg, -180.0 + column * kColumn_deg);
             });
}

/// A folder of side x side tiles.
class LandFolder : public TemporaryFolder {
 protected:
  void WriteTiles(int side) const {
    for (int row = 0; row < side; ++row)
      for (int column = 0; column < side; ++column)
        WriteTile(folder_ / ("tile" + std::to_string(row) + std::to_string(column) + ".tif"),
                  (kTileSamples - 1) * column, (kTileSamples - 1) * row);
  }
};

/// All tiles of a source, whole.
inline LoadedHeights AllHeights(const LandSource& source) {
  const auto tiles = std::make_shared<const LandTiles>(source);
  std::vector<std::shared_ptr<const HeightPyramid>> heights;
  for (std::size_t tile = 0; tile < tiles->tiles().size(); ++tile)
    heights.push_back(ReadLandTile(*tiles, static_cast<int>(tile), 0).heights);
  return {tiles, heights};
}

/// A place on the land, in samples.
inline Place PlaceOfSample(double column, double row, double height_m) {
  return {kNorth_deg - row * kTileStep_deg, kWest_deg + column * kTileStep_deg, height_m};
}

}  // namespace alpenglow::tests
