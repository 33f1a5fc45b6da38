// SPDX-License-Identifier: MIT
#include "renderer/terrain/elevation.h"

#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "atmosphere/base/error.h"
#include "renderer/layer.h"
#include "tests/fixtures/places.h"

namespace alpenglow::renderer {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr double kDegree = std::numbers::pi / 180.0;
const fs::path kDem = fs::path(tests::kSharedFolder) / "dem";
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// What a raster file is made of.
struct Recipe {
  std::string name = "dem.tif";
  int columns = 16;
  int rows = 12;
  std::array<double, 6> geotransform{7.0, 0.001, 0.0, 47.0, 0.0, -0.001};
  int epsg = 4326;
  int bands = 1;
  GDALDataType type = GDT_Float32;
  std::string unit;
  bool has_nodata = false;
  double nodata = 0.0;
  // Height of a sample by row and column.
  std::function<float(int, int)> height = [](int row, int column) {
    return static_cast<float>(1000 + 10 * row + column);
  };
};

class ElevationFile : public ::testing::Test {
 protected:
  ElevationFile() { fs::create_directories(folder_); }
  ~ElevationFile() override { fs::remove_all(folder_); }

  fs::path Write(const Recipe& recipe) const {
    GDALRegister_GTiff();
    const fs::path file = folder_ / recipe.name;
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
    GDALDataset* dataset = driver->Create(file.c_str(), recipe.columns, recipe.rows, recipe.bands,
                                          recipe.type, nullptr);
    std::array<double, 6> transform = recipe.geotransform;
    dataset->SetGeoTransform(transform.data());
    if (recipe.epsg != 0) {
      OGRSpatialReference crs;
      crs.importFromEPSG(recipe.epsg);
      dataset->SetSpatialRef(&crs);
    }
    GDALRasterBand* band = dataset->GetRasterBand(1);
    if (recipe.has_nodata) band->SetNoDataValue(recipe.nodata);
    if (!recipe.unit.empty()) band->SetUnitType(recipe.unit.c_str());
    std::vector<float> samples;
    for (int row = 0; row < recipe.rows; ++row) {
      for (int column = 0; column < recipe.columns; ++column) {
        samples.push_back(recipe.height(row, column));
      }
    }
    EXPECT_EQ(band->RasterIO(GF_Write, 0, 0, recipe.columns, recipe.rows, samples.data(),
                             recipe.columns, recipe.rows, GDT_Float32, 0, 0, nullptr),
              CE_None);
    GDALClose(dataset);
    return file;
  }

  fs::path folder_ =
      fs::path(::testing::TempDir()) /
      ("elevation_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
};

void ExpectRefused(const fs::path& file, const std::string& fault) {
  try {
    static_cast<void>(ReadElevation(file, VoidPolicy::kFill));
    ADD_FAILURE() << file << " was read";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr(file.filename().string()));
    EXPECT_THAT(error.what(), HasSubstr(fault));
    EXPECT_THAT(error.what(), Not(HasSubstr("\n"))) << "a message is one line";
  }
}

TEST_F(ElevationFile, SaysWhichVerticalDatumItsHeightsCountFrom) {
  Recipe recipe;
  EXPECT_EQ(ReadElevation(Write(recipe), VoidPolicy::kFill).vertical_datum, "");
  recipe.epsg = 9707;  // WGS 84 with heights over EGM96
  EXPECT_EQ(ReadElevation(Write(recipe), VoidPolicy::kFill).vertical_datum, "EGM96 height");
  recipe.epsg = 4979;  // WGS 84 with heights over the ellipsoid
  EXPECT_EQ(ReadElevation(Write(recipe), VoidPolicy::kFill).vertical_datum, "");
}

TEST_F(ElevationFile, SamplesLieAtThePixelCentres) {
  const ElevationModel model = ReadElevation(Write({}), VoidPolicy::kFill);
  const ElevationGrid& grid = model.grid;
  ASSERT_EQ(grid.columns, 16);
  ASSERT_EQ(grid.rows, 12);
  EXPECT_NEAR(grid.west_rad, 7.0005 * kDegree, 1e-14);
  EXPECT_NEAR(grid.north_rad, 46.9995 * kDegree, 1e-14);
  EXPECT_NEAR(grid.step_lon_rad, 0.001 * kDegree, 1e-16);
  EXPECT_NEAR(grid.step_lat_rad, 0.001 * kDegree, 1e-16);
  EXPECT_EQ(grid.at(3, 5), 1035.0F);
  EXPECT_EQ(model.voids, 0U);
}

TEST_F(ElevationFile, HeightBetweenSamplesIsBilinear) {
  const ElevationGrid grid = ReadElevation(Write({}), VoidPolicy::kFill).grid;
  const std::optional<double> height = grid.HeightAt(46.99625 * kDegree, 7.00375 * kDegree);
  ASSERT_TRUE(height.has_value());
  EXPECT_NEAR(*height, 1000.0 + 10.0 * 3.25 + 3.25, 1e-6);
  EXPECT_NEAR(*grid.HeightAt(46.9995 * kDegree, 367.0005 * kDegree), 1000.0, 1e-6)
      << "a longitude counts modulo 360 degrees";
  EXPECT_FALSE(grid.HeightAt(46.9995 * kDegree, 7.0 * kDegree).has_value());
  EXPECT_FALSE(grid.HeightAt(47.0 * kDegree, 7.005 * kDegree).has_value());
}

TEST_F(ElevationFile, SouthUpComesOutNorthUp) {
  Recipe recipe;
  recipe.geotransform = {7.0, 0.001, 0.0, 46.0, 0.0, 0.001};
  const ElevationGrid grid = ReadElevation(Write(recipe), VoidPolicy::kFill).grid;
  EXPECT_NEAR(grid.north_rad, 46.0115 * kDegree, 1e-14);
  EXPECT_EQ(grid.at(0, 5), 1115.0F) << "the file's last row is the northernmost";
  EXPECT_NEAR(*grid.HeightAt(46.0005 * kDegree, 7.0005 * kDegree), 1000.0, 1e-6);
}

TEST_F(ElevationFile, FeetBecomeMetres) {
  Recipe recipe;
  recipe.unit = "ft";
  EXPECT_NEAR(static_cast<double>(ReadElevation(Write(recipe), VoidPolicy::kFill).grid.at(0, 0)),
              304.8, 1e-4);
  recipe.unit = "US survey foot";
  EXPECT_NEAR(static_cast<double>(ReadElevation(Write(recipe), VoidPolicy::kFill).grid.at(0, 0)),
              304.8006096, 1e-4);
  recipe.unit = "furlong";
  ExpectRefused(Write(recipe), "furlong");
}

// 2 m apart on a map of New Mexico (State Plane, US survey feet), or of a place elsewhere.
Recipe PlaneOfFeet(int epsg) {
  Recipe recipe;
  recipe.epsg = epsg;
  recipe.geotransform = {1714733.97, 6.0, 0.0, 1673762.98, 0.0, -6.0};
  recipe.height = [](int, int) { return 7000.0F; };
  return recipe;
}

TEST_F(ElevationFile, HeightsWithoutAUnitAreInFeetOnAMapInFeet) {
  struct Case {
    int epsg;
    double height_m;
    const char* note;
  };
  for (const Case& map : std::vector<Case>{
           {6529, 7000.0 * 1200.0 / 3937.0, "the map is in US survey foot; they are taken in US"},
           {2222, 7000.0 * 0.3048, "the map is in foot; they are taken in foot"},
           {32613, 7000.0, ""},
           {4326, 7000.0, ""}}) {
    Recipe recipe = PlaneOfFeet(map.epsg);
    if (map.epsg == 32613) recipe.geotransform = {4e5, 2.0, 0.0, 4e6, 0.0, -2.0};
    if (map.epsg == 4326) recipe.geotransform = Recipe{}.geotransform;
    const ElevationModel model = ReadElevation(Write(recipe), VoidPolicy::kLeaveOpen);
    EXPECT_NEAR(static_cast<double>(model.grid.at(5, 5)), map.height_m, 1e-3) << map.epsg;
    EXPECT_THAT(NoteOn(model, "dem.tif"), HasSubstr(map.note)) << map.epsg;
    EXPECT_EQ(model.unit_note.empty(), std::string(map.note).empty()) << map.epsg;
    recipe.unit = "m";
    const ElevationModel declared = ReadElevation(Write(recipe), VoidPolicy::kLeaveOpen);
    EXPECT_NEAR(static_cast<double>(declared.grid.at(5, 5)), 7000.0, 1e-3) << map.epsg;
    EXPECT_EQ(declared.unit_note, "") << map.epsg;
  }
}

TEST_F(ElevationFile, AMapThatIsNotInMetresIsNoted) {
  Recipe recipe;
  const fs::path file = Write(recipe);
  auto* dataset = static_cast<GDALDataset*>(GDALOpen(file.c_str(), GA_Update));
  OGRSpatialReference kilometres;
  kilometres.SetUTM(32);
  kilometres.SetWellKnownGeogCS("WGS84");
  kilometres.SetLinearUnitsAndUpdateParameters("kilometre", 1000.0);
  std::array<double, 6> transform{400.0, 0.1, 0.0, 5200.0, 0.0, -0.1};
  dataset->SetSpatialRef(&kilometres);
  dataset->SetGeoTransform(transform.data());
  GDALClose(dataset);
  const ElevationModel model = ReadElevation(file, VoidPolicy::kLeaveOpen);
  EXPECT_THAT(NoteOn(model, "a.tif"),
              HasSubstr("a.tif: heights have no unit, and the map is in kilometre; they are taken "
                        "in metre"));
}

TEST_F(ElevationFile, AProjectedPlaneIsStillThatPlane) {
  Recipe recipe;
  recipe.columns = 60;
  recipe.rows = 50;
  recipe.epsg = 32632;
  recipe.geotransform = {400000.0, 30.0, 0.0, 5150000.0, 0.0, -30.0};
  const ElevationGrid grid = ReadElevation(Write(recipe), VoidPolicy::kFill).grid;
  OGRSpatialReference utm;
  OGRSpatialReference wgs84;
  utm.importFromEPSG(32632);
  wgs84.importFromEPSG(4326);
  wgs84.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  auto* to_geographic = OGRCreateCoordinateTransformation(&utm, &wgs84);
  for (int row = 5; row < 45; row += 7) {
    for (int column = 5; column < 55; column += 7) {
      double x = 400000.0 + 30.0 * (column + 0.5);
      double y = 5150000.0 - 30.0 * (row + 0.5);
      ASSERT_TRUE(to_geographic->Transform(1, &x, &y));
      const std::optional<double> height = grid.HeightAt(y * kDegree, x * kDegree);
      ASSERT_TRUE(height.has_value()) << row << " " << column;
      EXPECT_NEAR(*height, 1000.0 + 10.0 * row + column, 0.01)
          << "bilinear keeps a plane; float and the bend of the projection leave millimetres";
    }
  }
  OGRCoordinateTransformation::DestroyCT(to_geographic);
}

// Hard case 17.
TEST_F(ElevationFile, AMapAroundThePoleClosesAroundThePole) {
  Recipe recipe;
  recipe.columns = 101;
  recipe.rows = 101;
  recipe.epsg = 3413;
  recipe.geotransform = {-5050.0, 100.0, 0.0, 5050.0, 0.0, -100.0};
  recipe.height = [](int row, int column) {
    return static_cast<float>(100.0 + std::hypot(row - 50, column - 50));
  };
  const ElevationGrid grid = ReadElevation(Write(recipe), VoidPolicy::kFill).grid;
  EXPECT_TRUE(grid.ClosesAroundTheEarth());
  for (double lon = -180.0; lon <= 180.0; lon += 7.5) {
    const std::optional<double> height = grid.HeightAt(89.97 * kDegree, lon * kDegree);
    ASSERT_TRUE(height.has_value()) << lon;
    EXPECT_NEAR(*height, 100.0 + 0.03 * 111694.0 * 0.97 / 100.0, 0.3)
        << "a cone: its level lines are circles; scale of the map at the pole 0.970";
  }
}

// Hard case 17.
TEST_F(ElevationFile, ARasterOverTheMeridianOfGreenwichStaysWholeHoweverLongitudesAreCounted) {
  for (const double west : {-0.005, 359.995}) {
    Recipe recipe;
    recipe.geotransform = {west, 0.001, 0.0, 51.5, 0.0, -0.001};
    const ElevationGrid grid = ReadElevation(Write(recipe), VoidPolicy::kFill).grid;
    EXPECT_EQ(grid.columns, 16);
    for (const double turn : {0.0, 360.0}) {
      EXPECT_NEAR(*grid.HeightAt(51.4995 * kDegree, (turn - 0.0005) * kDegree), 1004.0, 1e-6);
      EXPECT_NEAR(*grid.HeightAt(51.4995 * kDegree, (turn + 0.0005) * kDegree), 1005.0, 1e-6);
    }
  }
}

// Hard case 17.
TEST_F(ElevationFile, ARasterOverThe180thMeridianStaysWhole) {
  Recipe recipe;
  recipe.geotransform = {179.995, 0.001, 0.0, -17.0, 0.0, -0.001};
  const ElevationGrid grid = ReadElevation(Write(recipe), VoidPolicy::kFill).grid;
  EXPECT_EQ(grid.columns, 16);
  EXPECT_NEAR(*grid.HeightAt(-17.0005 * kDegree, 179.9995 * kDegree), 1004.0, 1e-6);
  EXPECT_NEAR(*grid.HeightAt(-17.0005 * kDegree, -179.9995 * kDegree), 1005.0, 1e-6);
}

TEST_F(ElevationFile, VoidsAreCountedAndFilledWithAMembrane) {
  Recipe recipe;
  recipe.columns = 40;
  recipe.rows = 40;
  recipe.has_nodata = true;
  recipe.nodata = -1.0;
  recipe.height = [](int row, int column) {
    const bool is_void = row >= 10 && row < 25 && column >= 12 && column < 30;
    return is_void ? -1.0F : static_cast<float>(500 + 8 * row - 3 * column);
  };
  const ElevationModel filled = ReadElevation(Write(recipe), VoidPolicy::kFill);
  EXPECT_EQ(filled.voids, 15U * 18U);
  EXPECT_EQ(filled.voids_filled, 15U * 18U);
  for (int row = 10; row < 25; ++row) {
    for (int column = 12; column < 30; ++column) {
      EXPECT_NEAR(filled.grid.at(row, column), 500 + 8 * row - 3 * column, 0.1)
          << "a membrane over a hole in a plane is the plane";
    }
  }
  const ElevationModel open = ReadElevation(Write(recipe), VoidPolicy::kLeaveOpen);
  EXPECT_EQ(open.voids, 15U * 18U);
  EXPECT_EQ(open.voids_filled, 0U);
  EXPECT_TRUE(std::isnan(open.grid.at(15, 20)));
  EXPECT_FALSE(open.grid.HeightAt(open.grid.LatitudeOfRow(15), open.grid.LongitudeOfColumn(20)));
}

// The two western columns of a file have no data; its raw samples there are 0.
Recipe WesternSea() {
  Recipe recipe;
  recipe.height = [](int, int column) { return column < 2 ? 0.0F : 700.0F; };
  return recipe;
}

void ExpectTwoColumnsOpen(const fs::path& file) {
  const ElevationModel model = ReadElevation(file, VoidPolicy::kLeaveOpen);
  EXPECT_EQ(model.voids, 2U * 12U);
  EXPECT_TRUE(std::isnan(model.grid.at(5, 1)));
  EXPECT_EQ(model.grid.at(5, 2), 700.0F);
  const ElevationModel filled = ReadElevation(file, VoidPolicy::kFill);
  EXPECT_NEAR(static_cast<double>(filled.grid.at(5, 0)), 700.0, 1e-3);
}

// Adds a mask of the whole file, inside it or beside it.
void AddMask(const fs::path& file, const char* inside) {
  CPLSetThreadLocalConfigOption("GDAL_TIFF_INTERNAL_MASK", inside);
  auto* dataset = static_cast<GDALDataset*>(GDALOpen(file.c_str(), GA_Update));
  ASSERT_EQ(dataset->CreateMaskBand(GMF_PER_DATASET), CE_None);
  std::vector<std::uint8_t> mask(16 * 12, 255);
  for (std::size_t i = 0; i < mask.size(); ++i) mask[i] = i % 16 < 2 ? 0 : 255;
  ASSERT_EQ(dataset->GetRasterBand(1)->GetMaskBand()->RasterIO(GF_Write, 0, 0, 16, 12, mask.data(),
                                                               16, 12, GDT_Byte, 0, 0, nullptr),
            CE_None);
  GDALClose(dataset);
  CPLSetThreadLocalConfigOption("GDAL_TIFF_INTERNAL_MASK", nullptr);
}

TEST_F(ElevationFile, WhatAMaskLeavesOutIsAVoid) {
  const fs::path inside = Write(WesternSea());
  AddMask(inside, "YES");
  ExpectTwoColumnsOpen(inside);
  Recipe other = WesternSea();
  other.name = "beside.tif";
  const fs::path beside = Write(other);
  AddMask(beside, "NO");
  ASSERT_TRUE(fs::exists(beside.string() + ".msk"));
  ExpectTwoColumnsOpen(beside);
}

TEST_F(ElevationFile, WhatAnAlphaBandLeavesOutIsAVoid) {
  Recipe recipe = WesternSea();
  recipe.bands = 2;
  const fs::path file = Write(recipe);
  auto* dataset = static_cast<GDALDataset*>(GDALOpen(file.c_str(), GA_Update));
  dataset->GetRasterBand(2)->SetColorInterpretation(GCI_AlphaBand);
  std::vector<float> alpha(16 * 12, 255.0F);
  for (std::size_t i = 0; i < alpha.size(); ++i) alpha[i] = i % 16 < 2 ? 0.0F : 255.0F;
  ASSERT_EQ(dataset->GetRasterBand(2)->RasterIO(GF_Write, 0, 0, 16, 12, alpha.data(), 16, 12,
                                                GDT_Float32, 0, 0, nullptr),
            CE_None);
  GDALClose(dataset);
  ExpectTwoColumnsOpen(file);
}

TEST_F(ElevationFile, AnSrtmTileLiesOnTheDegreesOfItsName) {
  const fs::path tile = folder_ / "S34W071.hgt";
  std::ofstream stream(tile, std::ios::binary);
  for (int row = 0; row < 1201; ++row) {
    for (int column = 0; column < 1201; ++column) {
      const int height = row == 0 && column == 3 ? -32768 : row + column;
      stream.put(static_cast<char>((height >> 8) & 0xff)).put(static_cast<char>(height & 0xff));
    }
  }
  stream.close();
  const ElevationModel model = ReadElevation(tile, VoidPolicy::kFill);
  EXPECT_EQ(model.voids, 1U);
  EXPECT_NEAR(*model.grid.HeightAt(-33.0 * kDegree, -71.0 * kDegree), 0.0, 1e-3);
  EXPECT_NEAR(*model.grid.HeightAt(-34.0 * kDegree, -70.0 * kDegree), 2400.0, 1e-3);
  fs::rename(tile, folder_ / "elsewhere.hgt");
  ExpectRefused(folder_ / "elsewhere.hgt", "not a readable");
}

TEST_F(ElevationFile, AUsgsDemIsRead) {
  Recipe recipe;
  recipe.columns = 1201;
  recipe.rows = 1201;
  recipe.geotransform = {-76.0 - 0.5 * 0.25 / 1200, 0.25 / 1200, 0.0,
                         45.25 + 0.5 * 0.25 / 1200, 0.0,         -0.25 / 1200};
  recipe.height = [](int row, int column) { return static_cast<float>(500 + row - column / 3); };
  const fs::path tif = Write(recipe);
  GDALRegister_USGSDEM();
  auto* source = static_cast<GDALDataset*>(GDALOpen(tif.c_str(), GA_ReadOnly));
  const fs::path file = folder_ / "quad.dem";
  GDALDataset* copy = GetGDALDriverManager()->GetDriverByName("USGSDEM")->CreateCopy(
      file.c_str(), source, FALSE, nullptr, nullptr, nullptr);
  GDALClose(source);
  if (copy == nullptr) GTEST_SKIP() << "this GDAL writes no USGS DEM";
  GDALClose(copy);
  const ElevationGrid grid = ReadElevation(file, VoidPolicy::kFill).grid;
  const std::optional<double> height = grid.HeightAt(45.1 * kDegree, -75.9 * kDegree);
  ASSERT_TRUE(height.has_value());
  EXPECT_NEAR(*height, 500.0 + 720.0 - 160.0, 1.5) << "the file holds whole metres";
}

// The height at each sample tells its column and row.
Recipe Numbered() {
  Recipe recipe;
  recipe.height = [](int row, int column) { return static_cast<float>(100 * row + column); };
  return recipe;
}

TEST_F(ElevationFile, AWindowIsThatPartOfTheWhole) {
  Recipe south_up = Numbered();
  south_up.name = "south.tif";
  south_up.geotransform = {7.0, 0.001, 0.0, 46.0, 0.0, 0.001};
  for (const Recipe& recipe : {Numbered(), south_up}) {
    const fs::path file = Write(recipe);
    ASSERT_TRUE(CanBeCut(file));
    const ElevationGrid whole = ReadElevation(file, VoidPolicy::kFill).grid;
    const ElevationGrid part = ReadElevation(file, VoidPolicy::kFill, {5, 3, 6, 2}).grid;
    ASSERT_EQ(part.columns, 6);
    ASSERT_EQ(part.rows, 2);
    EXPECT_NEAR(part.west_rad, whole.LongitudeOfColumn(5), 1e-14);
    EXPECT_NEAR(part.north_rad, whole.LatitudeOfRow(3), 1e-14);
    for (int row = 0; row < 2; ++row) {
      for (int column = 0; column < 6; ++column) {
        EXPECT_EQ(part.at(row, column), whole.at(row + 3, column + 5)) << row << " " << column;
      }
    }
  }
}

TEST_F(ElevationFile, AWindowOfTheEarthGoesOnAfterTheLastColumn) {
  Recipe recipe = Numbered();
  recipe.columns = 36;
  recipe.geotransform = {-180.0, 10.0, 0.0, 60.0, 0.0, -10.0};
  const fs::path file = Write(recipe);
  const ElevationGrid part = ReadElevation(file, VoidPolicy::kFill, {34, 2, 4, 3}).grid;
  ASSERT_EQ(part.columns, 4);
  EXPECT_NEAR(part.west_rad, 165.0 * kDegree, 1e-12);
  EXPECT_EQ(part.at(0, 1), 235.0F);
  EXPECT_EQ(part.at(0, 2), 200.0F);
  EXPECT_EQ(part.at(2, 3), 401.0F);
}

TEST_F(ElevationFile, AResampledModelCannotBeCut) {
  Recipe recipe;
  recipe.epsg = 32632;
  recipe.geotransform = {4e5, 30.0, 0.0, 5.2e6, 0.0, -30.0};
  EXPECT_FALSE(CanBeCut(Write(recipe)));
}

// The model has the size of GEBCO's grid of 15 seconds, 3.7e9 samples. Blocks that are not written take
// no room in the file.
TEST_F(ElevationFile, OfAModelOfTheWholeEarthAWindowIsRead) {
  GDALRegister_GTiff();
  const fs::path file = folder_ / "earth.tif";
  const char* const options[] = {"SPARSE_OK=TRUE", "TILED=YES", nullptr};
  GDALDataset* dataset = GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
      file.c_str(), 86400, 43200, 1, GDT_Int16, const_cast<char**>(options));
  std::array<double, 6> transform{-180.0, 1.0 / 240.0, 0.0, 90.0, 0.0, -1.0 / 240.0};
  dataset->SetGeoTransform(transform.data());
  OGRSpatialReference crs;
  crs.importFromEPSG(4326);
  dataset->SetSpatialRef(&crs);
  std::vector<float> heights(64 * 32);
  for (std::size_t i = 0; i < heights.size(); ++i) heights[i] = static_cast<float>(i);
  ASSERT_EQ(dataset->GetRasterBand(1)->RasterIO(GF_Write, 45120, 10440, 64, 32, heights.data(), 64,
                                                32, GDT_Float32, 0, 0, nullptr),
            CE_None);
  GDALClose(dataset);
  const ElevationGrid extent = ReadElevationExtent(file);
  EXPECT_EQ(extent.columns, 86400);
  ASSERT_TRUE(CanBeCut(file));
  const ElevationGrid part = ReadElevation(file, VoidPolicy::kFill, {45110, 10430, 80, 50}).grid;
  EXPECT_EQ(part.height_m.size(), 80U * 50U);
  EXPECT_EQ(part.at(0, 0), 0.0F);
  EXPECT_EQ(part.at(10 + 5, 10 + 7), 64.0F * 5.0F + 7.0F);
  EXPECT_NEAR(part.west_rad, (-180.0 + 45110.5 / 240.0) * kDegree, 1e-12);
  ExpectRefused(file, "has 86400 x 43200 samples; at most 268435456 can be held");
}

TEST_F(ElevationFile, CustomaryNodataIsAVoidThoughUndeclared) {
  for (const float value :
       {kNan, -32768.0F, -32767.0F, -9999.0F, std::numeric_limits<float>::lowest()}) {
    Recipe recipe;
    recipe.height = [&](int row, int column) { return row == 4 && column == 4 ? value : 700.0F; };
    const ElevationModel model = ReadElevation(Write(recipe), VoidPolicy::kFill);
    EXPECT_EQ(model.voids, 1U) << value;
    EXPECT_EQ(model.grid.at(4, 4), 700.0F);
  }
}

TEST_F(ElevationFile, HeightsThatNoGroundHasAreRefusedByPlace) {
  for (const float value : {9001.0F, -12001.0F, 3.4e38F, std::numeric_limits<float>::infinity()}) {
    Recipe recipe;
    recipe.height = [&](int row, int column) { return row == 4 && column == 5 ? value : 700.0F; };
    ExpectRefused(Write(recipe), "row 4, column 5");
  }
}

TEST_F(ElevationFile, WhatIsNoElevationModelIsRefused) {
  Recipe recipe;
  recipe.height = [](int, int) { return kNan; };
  ExpectRefused(Write(recipe), "no valid sample");
  recipe = {};
  recipe.epsg = 0;
  ExpectRefused(Write(recipe), "no coordinate system");
  recipe = {};
  recipe.bands = 3;
  ExpectRefused(Write(recipe), "3 bands");
  recipe.bands = 2;
  ExpectRefused(Write(recipe), "2 bands");
  recipe = {};
  recipe.type = GDT_CFloat32;
  ExpectRefused(Write(recipe), "complex");
  recipe = {};
  recipe.rows = 1;
  ExpectRefused(Write(recipe), "16 x 1");
  recipe = {};
  recipe.geotransform = {7.0, 0.001, 0.0001, 47.0, 0.0001, -0.001};
  ExpectRefused(Write(recipe), "rotated");
  recipe = {};
  recipe.geotransform = {7.0, 0.001, 0.0, 90.01, 0.0, -0.001};
  ExpectRefused(Write(recipe), "latitude");
  ExpectRefused(folder_ / "missing.tif", "no such file");
  std::ofstream(folder_ / "N46E008.hgt") << std::string(2000000, '\0');
  ExpectRefused(folder_ / "N46E008.hgt", "not a readable");
}

TEST_F(ElevationFile, EveryTruncationIsRefused) {
  const fs::path whole = Write({});
  const auto size = fs::file_size(whole);
  for (std::uintmax_t length = 0; length + 1 < size; length += 61) {
    const fs::path cut = folder_ / "cut.tif";
    fs::copy_file(whole, cut, fs::copy_options::overwrite_existing);
    fs::resize_file(cut, length);
    EXPECT_THROW(static_cast<void>(ReadElevation(cut, VoidPolicy::kFill)), InputError) << length;
  }
}

// ---- Files that others made ----

struct BadFile {
  const char* name;
  const char* fault;
};

TEST(SharedElevation, BadFilesAreRefusedByNameAndFault) {
  if (!fs::exists(kDem / "bad")) GTEST_SKIP() << "no " << kDem / "bad";
  const BadFile files[] = {
      {"N46E008.hgt", "not a readable"},
      {"all_nodata.tif", "no valid sample"},
      {"complex.tif", "complex"},
      {"corrupt_bytes.tif", "damaged"},
      {"empty.tif", "not a readable"},
      {"huge.tif", "m at row"},
      {"inf.tif", "inf m at row"},
      {"lat_over_90.tif", "latitude 90."},
      {"mars_crs.tif", "3396190"},
      {"no_crs.tif", "no coordinate system"},
      {"no_geotransform.tif", "no geotransform"},
      {"one_by_one.tif", "1 x 1"},
      {"one_row.tif", "64 x 1"},
      {"rgb_u8.tif", "3 bands"},
      {"rotated.tif", "rotated"},
      {"text.tif", "not a readable"},
      {"truncated_half.tif", "damaged or cut short"},
      {"truncated_header.tif", "not a readable"},
  };
  for (const auto& [name, fault] : files) ExpectRefused(kDem / "bad" / name, fault);
}

struct ReadableFile {
  const char* name;
  std::size_t voids;
  double north_deg;  // of the first sample, after mirroring or resampling
  double west_deg;
};

TEST(SharedElevation, ReadableOnesAmongThemComeOutRight) {
  if (!fs::exists(kDem / "bad")) GTEST_SKIP() << "no " << kDem / "bad";
  constexpr double kHalf = 0.5 / 1200.0;  // half a pixel
  const ReadableFile files[] = {
      {"ok.tif", 0, 46.5 - kHalf, 7.5 + kHalf},
      {"deflate.tif", 0, 46.5 - kHalf, 7.5 + kHalf},
      {"feet_vertical.tif", 0, 46.5 - kHalf, 7.5 + kHalf},
      {"south_up.tif", 0, 46.0 + 127 * kHalf, 7.5 + kHalf},
      {"dateline.tif", 0, -17.0 - kHalf, 179.98 + kHalf},
      {"pole.tif", 0, 90.0 - kHalf, 2.8125},
      {"nan.tif", 100, 46.5 - kHalf, 7.5 + kHalf},
      {"voids_i16.tif", 100, 46.5 - kHalf, 7.5 + kHalf},
      {"nodata_undeclared.tif", 100, 46.5 - kHalf, 7.5 + kHalf},
  };
  for (const ReadableFile& file : files) {
    const ElevationModel model = ReadElevation(kDem / "bad" / file.name, VoidPolicy::kFill);
    EXPECT_EQ(model.voids, file.voids) << file.name;
    EXPECT_EQ(model.voids_filled, file.voids) << file.name;
    EXPECT_NEAR(model.grid.north_rad / kDegree, file.north_deg, 1e-9) << file.name;
    EXPECT_NEAR(model.grid.west_rad / kDegree, file.west_deg, 1e-9) << file.name;
    EXPECT_EQ(model.grid.columns, 64) << file.name;
    EXPECT_EQ(model.grid.rows, 64) << file.name;
  }
}

TEST(SharedElevation, ProjectedOnesShowTheSameHillsAsTheGeographicOne) {
  if (!fs::exists(kDem / "bad")) GTEST_SKIP() << "no " << kDem / "bad";
  const ElevationGrid ok = ReadElevation(kDem / "bad" / "ok.tif", VoidPolicy::kFill).grid;
  const std::pair<const char*, int> files[] = {{"utm32.tif", 32632}, {"webmercator.tif", 3857}};
  const std::array<double, 6> transforms[] = {{400000.0, 30.0, 0.0, 5150000.0, 0.0, -30.0},
                                              {834000.0, 30.0, 0.0, 5860000.0, 0.0, -30.0}};
  for (int which = 0; which < 2; ++which) {
    const auto& [name, epsg] = files[which];
    const ElevationGrid grid = ReadElevation(kDem / "bad" / name, VoidPolicy::kFill).grid;
    OGRSpatialReference crs;
    OGRSpatialReference wgs84;
    crs.importFromEPSG(epsg);
    wgs84.importFromEPSG(4326);
    wgs84.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    auto* to_geographic = OGRCreateCoordinateTransformation(&crs, &wgs84);
    double worst = 0.0;
    for (int row = 2; row < 62; ++row) {
      for (int column = 2; column < 62; ++column) {
        double x = transforms[which][0] + 30.0 * (column + 0.5);
        double y = transforms[which][3] - 30.0 * (row + 0.5);
        ASSERT_TRUE(to_geographic->Transform(1, &x, &y));
        const std::optional<double> height = grid.HeightAt(y * kDegree, x * kDegree);
        ASSERT_TRUE(height.has_value());
        worst = std::max(worst, std::abs(*height - static_cast<double>(ok.at(row, column))));
      }
    }
    EXPECT_LT(worst, 3.0)
        << name
        << ": hills of 300 m turn by 1/8 rad a sample; each of two bilinear steps loses up to "
           "300 / 8^2 / 8 = 0.6 m a dimension";
    OGRCoordinateTransformation::DestroyCT(to_geographic);
  }
}

TEST(SharedElevation, FujiStandsWhereItStands) {
  const fs::path tile = kDem / "N35E138.hgt";
  if (!fs::exists(tile)) GTEST_SKIP() << "no " << tile;
  const ElevationModel model = ReadElevation(tile, VoidPolicy::kFill);
  const std::optional<double> summit = model.grid.HeightAt(35.3606 * kDegree, 138.7274 * kDegree);
  ASSERT_TRUE(summit.has_value());
  EXPECT_NEAR(*summit, 3776.0, 40.0) << "a radar sample of 90 m cuts the rim of the crater";
  EXPECT_EQ(model.voids, 2437U);
  EXPECT_EQ(model.grid.columns, 1201);
  EXPECT_NEAR(model.grid.west_rad / kDegree, 138.0, 1e-9) << "samples of a tile lie on its degrees";
  EXPECT_NEAR(model.grid.north_rad / kDegree, 36.0, 1e-9);
}

TEST(SharedElevation, VoidsOfEverestAreCountedAndFilledBetweenTheirRims) {
  const fs::path file = kDem / "everest_srtm3_voids.tif";
  if (!fs::exists(file)) GTEST_SKIP() << "no " << file;
  const ElevationModel model = ReadElevation(file, VoidPolicy::kFill);
  EXPECT_EQ(model.voids, 130953U);
  EXPECT_EQ(model.voids_filled, 130953U);
  float lowest = 1e9F;
  float highest = -1e9F;
  for (const float height : model.grid.height_m) {
    ASSERT_TRUE(std::isfinite(height));
    lowest = std::min(lowest, height);
    highest = std::max(highest, height);
  }
  EXPECT_GE(lowest, 192.0F) << "a membrane has no extremes of its own";
  EXPECT_LE(highest, 8642.0F);
}

}  // namespace
}  // namespace alpenglow::renderer
