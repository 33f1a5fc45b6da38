// SPDX-License-Identifier: MIT
#include "renderer/elevation/elevation.h"

#include <fmt/format.h>
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
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "atmosphere/base/error.h"
#include "renderer/layer.h"
#include "tests/fixtures/comma_locale.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/places.h"
#include "tests/fixtures/raster_file.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::renderer {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using tests::Raster;

constexpr double kDegree = std::numbers::pi / 180.0;
const fs::path kDem = fs::path(tests::kSharedFolder) / "dem";
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

class ElevationFile : public TemporaryFolder {
 protected:
  [[nodiscard]] fs::path Write(const Raster& raster) const {
    return tests::WriteRaster(folder_, raster);
  }
  [[nodiscard]] ElevationModel Model(const Raster& raster,
                                     VoidPolicy policy = VoidPolicy::kFill) const {
    return ReadElevation(Write(raster), policy);
  }
  [[nodiscard]] ElevationGrid GridOf(const Raster& raster) const { return Model(raster).grid; }
};

void ExpectRefused(const fs::path& file, const std::string& fault) {
  tests::ExpectNames(tests::FaultOf([&] { return ReadElevation(file, VoidPolicy::kFill); }), file,
                     fault);
}

/// Expects a height [m] of a place in degrees.
void ExpectHeight(const ElevationGrid& grid, double latitude, double longitude, double height_m,
                  double tolerance_m) {
  const std::optional<double> found = grid.HeightAt(latitude * kDegree, longitude * kDegree);
  ASSERT_TRUE(found.has_value()) << latitude << " " << longitude;
  EXPECT_NEAR(*found, height_m, tolerance_m) << latitude << " " << longitude;
}

TEST_F(ElevationFile, ReportsTheVerticalDatumOfItsHeights) {
  Raster raster;
  EXPECT_EQ(Model(raster).vertical_datum, "");
  raster.epsg = 9707;  // WGS 84 with heights over EGM96
  EXPECT_EQ(Model(raster).vertical_datum, "EGM96 height");
  raster.epsg = 4979;  // WGS 84 with heights over the ellipsoid
  EXPECT_EQ(Model(raster).vertical_datum, "");
}

TEST_F(ElevationFile, SamplesLieAtThePixelCentres) {
  const ElevationModel model = Model({});
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
  const ElevationGrid grid = GridOf({});
  ExpectHeight(grid, 46.99625, 7.00375, 1000.0 + 10.0 * 3.25 + 3.25, 1e-6);
  ExpectHeight(grid, 46.9995, 367.0005, 1000.0, 1e-6);  // A longitude counts modulo 360 degrees.
  EXPECT_FALSE(grid.HeightAt(46.9995 * kDegree, 7.0 * kDegree).has_value());
  EXPECT_FALSE(grid.HeightAt(47.0 * kDegree, 7.005 * kDegree).has_value());
}

TEST_F(ElevationFile, SouthUpRastersBecomeNorthUp) {
  Raster raster;
  raster.geotransform = {7.0, 0.001, 0.0, 46.0, 0.0, 0.001};
  const ElevationGrid grid = GridOf(raster);
  EXPECT_NEAR(grid.north_rad, 46.0115 * kDegree, 1e-14);
  EXPECT_EQ(grid.at(0, 5), 1115.0F) << "the file's last row is the northernmost";
  ExpectHeight(grid, 46.0005, 7.0005, 1000.0, 1e-6);
}

TEST_F(ElevationFile, FeetBecomeMetres) {
  Raster raster;
  for (const auto& [unit, height_m] : {std::pair{"ft", 304.8}, {"US survey foot", 304.8006096}}) {
    raster.unit = unit;
    EXPECT_NEAR(static_cast<double>(GridOf(raster).at(0, 0)), height_m, 1e-4) << unit;
  }
  raster.unit = "furlong";
  ExpectRefused(Write(raster), "furlong");
}

// Returns samples 2 m apart on a map of New Mexico (State Plane, US survey feet) or elsewhere.
Raster PlaneOfFeet(int epsg) {
  Raster raster;
  raster.epsg = epsg;
  raster.geotransform = {1714733.97, 6.0, 0.0, 1673762.98, 0.0, -6.0};
  raster.height = [](int, int) { return 7000.0F; };
  return raster;
}

TEST_F(ElevationFile, HeightsWithoutAUnitHaveThatOfTheMap) {
  struct Case {
    int epsg;
    double height_m;
    const char* note;
  };
  for (const Case& map :
       {Case{6529, 7000.0 * 1200.0 / 3937.0, "the map is in US survey foot; they are taken in US"},
        {2222, 7000.0 * 0.3048, "the map is in foot; they are taken in foot"},
        {32613, 7000.0, ""},
        {4326, 7000.0, ""}}) {
    Raster raster = PlaneOfFeet(map.epsg);
    if (map.epsg == 32613) raster.geotransform = {4e5, 2.0, 0.0, 4e6, 0.0, -2.0};
    if (map.epsg == 4326) raster.geotransform = Raster{}.geotransform;
    const ElevationModel model = Model(raster, VoidPolicy::kLeaveOpen);
    EXPECT_NEAR(static_cast<double>(model.grid.at(5, 5)), map.height_m, 1e-3) << map.epsg;
    EXPECT_THAT(NoteOn(model, "dem.tif"), HasSubstr(map.note)) << map.epsg;
    EXPECT_EQ(model.unit_note.empty(), std::string(map.note).empty()) << map.epsg;
    raster.unit = "m";
    const ElevationModel declared = Model(raster, VoidPolicy::kLeaveOpen);
    EXPECT_NEAR(static_cast<double>(declared.grid.at(5, 5)), 7000.0, 1e-3) << map.epsg;
    EXPECT_EQ(declared.unit_note, "") << map.epsg;
  }
}

TEST_F(ElevationFile, AMapThatIsNotInMetresIsNoted) {
  Raster raster;
  const fs::path file = Write(raster);
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

/// Calls visit(row, column, latitude, longitude) for samples of a projected map; angles are in
/// degrees.
template <typename Visit>
void VisitSamples(int epsg, const std::array<double, 6>& transform, std::array<int, 3> rows,
                  std::array<int, 3> columns, const Visit& visit) {
  OGRSpatialReference map, wgs84;
  map.importFromEPSG(epsg);
  wgs84.importFromEPSG(4326);
  wgs84.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  auto* to_geographic = OGRCreateCoordinateTransformation(&map, &wgs84);
  for (int row = rows[0]; row < rows[1]; row += rows[2]) {
    for (int column = columns[0]; column < columns[1]; column += columns[2]) {
      double x = transform[0] + transform[1] * (column + 0.5);
      double y = transform[3] + transform[5] * (row + 0.5);
      ASSERT_TRUE(to_geographic->Transform(1, &x, &y));
      visit(row, column, y, x);
    }
  }
  OGRCoordinateTransformation::DestroyCT(to_geographic);
}

TEST_F(ElevationFile, AProjectedPlaneStaysAPlane) {
  Raster raster;
  raster.columns = 60;
  raster.rows = 50;
  raster.epsg = 32632;
  raster.geotransform = {400000.0, 30.0, 0.0, 5150000.0, 0.0, -30.0};
  const ElevationGrid grid = GridOf(raster);
  VisitSamples(raster.epsg, raster.geotransform, {5, 45, 7}, {5, 55, 7},
               [&](int row, int column, double latitude, double longitude) {
                 // Bilinear keeps a plane; float and the bend of the projection leave millimetres.
                 ExpectHeight(grid, latitude, longitude, 1000.0 + 10.0 * row + column, 0.01);
               });
}

// Hard case 17.
TEST_F(ElevationFile, AMapOfAPoleClosesAroundIt) {
  Raster raster;
  raster.columns = 101;
  raster.rows = 101;
  raster.epsg = 3413;
  raster.geotransform = {-5050.0, 100.0, 0.0, 5050.0, 0.0, -100.0};
  raster.height = [](int row, int column) {
    return static_cast<float>(100.0 + std::hypot(row - 50, column - 50));
  };
  const ElevationGrid grid = GridOf(raster);
  EXPECT_TRUE(grid.ClosesAroundTheEarth());
  for (double lon = -180.0; lon <= 180.0; lon += 7.5) {
    // On a cone level lines are circles; the scale of the map at the pole is 0.970.
    ExpectHeight(grid, 89.97, lon, 100.0 + 0.03 * 111694.0 * 0.97 / 100.0, 0.3);
  }
}

// Hard case 17.
TEST_F(ElevationFile, ARasterOverGreenwichStaysWhole) {
  for (const double west : {-0.005, 359.995}) {
    Raster raster;
    raster.geotransform = {west, 0.001, 0.0, 51.5, 0.0, -0.001};
    const ElevationGrid grid = GridOf(raster);
    EXPECT_EQ(grid.columns, 16);
    for (const double turn : {0.0, 360.0}) {
      ExpectHeight(grid, 51.4995, turn - 0.0005, 1004.0, 1e-6);
      ExpectHeight(grid, 51.4995, turn + 0.0005, 1005.0, 1e-6);
    }
  }
}

// Hard case 17.
TEST_F(ElevationFile, ARasterOverThe180thMeridianStaysWhole) {
  Raster raster;
  raster.geotransform = {179.995, 0.001, 0.0, -17.0, 0.0, -0.001};
  const ElevationGrid grid = GridOf(raster);
  EXPECT_EQ(grid.columns, 16);
  ExpectHeight(grid, -17.0005, 179.9995, 1004.0, 1e-6);
  ExpectHeight(grid, -17.0005, -179.9995, 1005.0, 1e-6);
}

TEST_F(ElevationFile, VoidsAreCountedAndFilledWithAMembrane) {
  Raster raster;
  raster.columns = 40;
  raster.rows = 40;
  raster.has_nodata = true;
  raster.nodata = -1.0;
  raster.height = [](int row, int column) {
    const bool is_void = row >= 10 && row < 25 && column >= 12 && column < 30;
    return is_void ? -1.0F : static_cast<float>(500 + 8 * row - 3 * column);
  };
  const ElevationModel filled = Model(raster);
  EXPECT_EQ(filled.voids, 15U * 18U);
  EXPECT_EQ(filled.voids_filled, 15U * 18U);
  for (int row = 10; row < 25; ++row) {
    for (int column = 12; column < 30; ++column) {
      EXPECT_NEAR(filled.grid.at(row, column), 500 + 8 * row - 3 * column, 0.1)
          << "a membrane over a hole in a plane is the plane";
    }
  }
  const ElevationModel open = Model(raster, VoidPolicy::kLeaveOpen);
  EXPECT_EQ(open.voids, 15U * 18U);
  EXPECT_EQ(open.voids_filled, 0U);
  EXPECT_TRUE(std::isnan(open.grid.at(15, 20)));
  EXPECT_FALSE(open.grid.HeightAt(open.grid.LatitudeOfRow(15), open.grid.LongitudeOfColumn(20)));
}

// Returns a file whose two western columns have no data; its raw samples there are 0.
Raster WesternSea() {
  Raster raster;
  raster.height = [](int, int column) { return column < 2 ? 0.0F : 700.0F; };
  return raster;
}

void ExpectTwoColumnsOpen(const fs::path& file) {
  const ElevationModel model = ReadElevation(file, VoidPolicy::kLeaveOpen);
  EXPECT_EQ(model.voids, 2U * 12U);
  EXPECT_TRUE(std::isnan(model.grid.at(5, 1)));
  EXPECT_EQ(model.grid.at(5, 2), 700.0F);
  const ElevationModel filled = ReadElevation(file, VoidPolicy::kFill);
  EXPECT_NEAR(static_cast<double>(filled.grid.at(5, 0)), 700.0, 1e-3);
}

// Writes 0 to the two western columns of a band of the file, and 255 to the others.
void LeaveColumnsOut(GDALRasterBand& band) {
  std::vector<float> mask(16 * 12, 255.0F);
  for (std::size_t i = 0; i < mask.size(); ++i) mask[i] = i % 16 < 2 ? 0.0F : 255.0F;
  tests::WriteSamples(band, {0, 0, 16, 12}, std::move(mask));
}

// Adds a mask of the whole file, inside the file or next to it.
void AddMask(const fs::path& file, const char* inside) {
  CPLSetThreadLocalConfigOption("GDAL_TIFF_INTERNAL_MASK", inside);
  auto* dataset = static_cast<GDALDataset*>(GDALOpen(file.c_str(), GA_Update));
  ASSERT_EQ(dataset->CreateMaskBand(GMF_PER_DATASET), CE_None);
  LeaveColumnsOut(*dataset->GetRasterBand(1)->GetMaskBand());
  GDALClose(dataset);
  CPLSetThreadLocalConfigOption("GDAL_TIFF_INTERNAL_MASK", nullptr);
}

/// Declarations of a band about its numbers.
struct BandDeclaration {
  GDALDataType type = GDT_Float32;
  double scale = 1.0, offset = 0.0;
  std::optional<double> nodata = std::nullopt;
  std::string unit = {};
  float elsewhere = 100.0F;  // the stored number of the other samples
};

// Writes 3 x 2 samples: this one at row 1, column 1.
template <typename Sample>
fs::path WriteStored(const fs::path& folder, const BandDeclaration& declared, Sample sample,
                     GDALDataType type_of_sample) {
  Raster raster;
  raster.columns = 3;
  raster.rows = 2;
  raster.type = declared.type;
  raster.unit = declared.unit;
  raster.height = [&](int, int) { return declared.elsewhere; };
  const fs::path file = tests::WriteRaster(folder, raster);
  fs::remove(file.string() + ".aux.xml");
  auto* dataset = static_cast<GDALDataset*>(GDALOpen(file.c_str(), GA_Update));
  GDALRasterBand& band = *dataset->GetRasterBand(1);
  band.SetScale(declared.scale);
  band.SetOffset(declared.offset);
  if (declared.nodata && declared.type == GDT_Int64) {
    band.SetNoDataValueAsInt64(static_cast<std::int64_t>(*declared.nodata));
  } else if (declared.nodata) {
    band.SetNoDataValue(*declared.nodata);
  }
  EXPECT_EQ(band.RasterIO(GF_Write, 1, 1, 1, 1, &sample, 1, 1, type_of_sample, 0, 0), CE_None);
  GDALClose(dataset);
  return file;
}

fs::path WriteStored(const fs::path& folder, const BandDeclaration& declared, double sample) {
  return WriteStored(folder, declared, sample, GDT_Float64);
}

// Returns the height of that sample; NaN for a void.
double HeightFromStored(const fs::path& file) {
  return static_cast<double>(ReadElevation(file, VoidPolicy::kLeaveOpen).grid.at(1, 1));
}

TEST_F(ElevationFile, DeclaredNodataValuesWinOverCustomaryOnes) {
  // A lake at 1000.1 m whose stored number is -9999.
  const BandDeclaration scaled{GDT_Int16, 0.1, 2000.0, -32768.0};
  EXPECT_NEAR(HeightFromStored(WriteStored(folder_, scaled, -9999.0)), 1000.1, 1e-4);
  EXPECT_TRUE(std::isnan(HeightFromStored(WriteStored(folder_, scaled, -32768.0))));
  // The floor of the Mariana Trench at -9999 m.
  for (const GDALDataType type : {GDT_Int16, GDT_Int32, GDT_Int64, GDT_Float32, GDT_Float64}) {
    SCOPED_TRACE(GDALGetDataTypeName(type));
    const BandDeclaration declared{type, 1.0, 0.0, -32768.0};
    EXPECT_EQ(HeightFromStored(WriteStored(folder_, declared, -9999.0)), -9999.0);
    EXPECT_TRUE(std::isnan(HeightFromStored(WriteStored(folder_, declared, -32768.0))));
    const BandDeclaration undeclared{type};
    EXPECT_TRUE(std::isnan(HeightFromStored(WriteStored(folder_, undeclared, -9999.0))));
    EXPECT_TRUE(std::isnan(HeightFromStored(WriteStored(folder_, undeclared, -32768.0))));
  }
}

TEST_F(ElevationFile, CustomaryVoidsAreHeightsAndNotStoredNumbers) {
  const BandDeclaration scaled{GDT_Int16, 0.1, 2000.0};
  EXPECT_NEAR(HeightFromStored(WriteStored(folder_, scaled, -9999.0)), 1000.1, 1e-4);
  EXPECT_NEAR(HeightFromStored(WriteStored(folder_, scaled, -32767.0)), -1276.7, 1e-3);
  EXPECT_TRUE(std::isnan(HeightFromStored(WriteStored(folder_, {GDT_Int32, 0.5}, -19998.0))));
  EXPECT_TRUE(std::isnan(
      HeightFromStored(WriteStored(folder_, {GDT_Float32, 1.0, 0.0, std::nullopt, "ft"}, -9999.0))))
      << "heights in the unit of the file";
}

TEST_F(ElevationFile, AMaskDeclaresWhatIsValid) {
  Raster raster = WesternSea();
  raster.height = [](int, int column) { return column < 2 ? 0.0F : -9999.0F; };
  const fs::path file = Write(raster);
  AddMask(file, "YES");
  const ElevationModel model = ReadElevation(file, VoidPolicy::kLeaveOpen);
  EXPECT_EQ(model.voids, 2U * 12U);
  EXPECT_EQ(model.grid.at(5, 5), -9999.0F);
}

TEST_F(ElevationFile, NodataOfEveryTypeIsRecognised) {
  constexpr double kLowestFloat = static_cast<double>(std::numeric_limits<float>::lowest());
  constexpr double kLowestDouble = std::numeric_limits<double>::lowest();
  const std::pair<GDALDataType, double> cases[] = {
      {GDT_Byte, 255.0},          {GDT_UInt16, 65535.0},        {GDT_UInt32, 4294967295.0},
      {GDT_Int32, -2147483648.0}, {GDT_Int64, -9999999999.0},   {GDT_Float32, kLowestFloat},
      {GDT_Float32, 1e20},        {GDT_Float64, kLowestDouble}, {GDT_Float64, 0.1}};
  for (const auto& [type, nodata] : cases) {
    SCOPED_TRACE(fmt::format("{} {}", GDALGetDataTypeName(type), nodata));
    const BandDeclaration declared{type, 1.0, 0.0, nodata};
    EXPECT_TRUE(std::isnan(HeightFromStored(WriteStored(folder_, declared, nodata))));
    EXPECT_EQ(HeightFromStored(WriteStored(folder_, declared, 200.0)), 200.0);
  }
  // Programs round this value as they write it as text.
  const BandDeclaration rounded{GDT_Float32, 1.0, 0.0, -3.40282e38};
  EXPECT_TRUE(std::isnan(HeightFromStored(WriteStored(folder_, rounded, kLowestFloat))));
  const BandDeclaration of_double{GDT_Float32, 1.0, 0.0, kLowestDouble};
  EXPECT_TRUE(std::isnan(HeightFromStored(WriteStored(folder_, of_double, kLowestFloat))));
  EXPECT_TRUE(std::isnan(HeightFromStored(WriteStored(folder_, {GDT_Float64}, kLowestDouble))));
  EXPECT_TRUE(std::isnan(HeightFromStored(WriteStored(folder_, {GDT_Float32}, kLowestFloat))));
}

TEST_F(ElevationFile, NodataBeyondAllHeightsIsOneValue) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  // Programs write them exactly, rounded to six, two and eight digits, as doubles, and infinite.
  const double values[] = {-3.4028234663852886e38,
                           -3.40282e38,
                           -3.4e38,
                           -3.4028235e38,
                           -3.5e38,
                           std::numeric_limits<double>::lowest(),
                           -kInfinity};
  for (const GDALDataType type : {GDT_Float32, GDT_Float64}) {
    for (const double side : {1.0, -1.0}) {
      for (const double declared : values) {
        SCOPED_TRACE(fmt::format("{} {}", GDALGetDataTypeName(type), side * declared));
        const BandDeclaration band{type, 1.0, 0.0, side * declared};
        for (const double stored : values)
          EXPECT_TRUE(std::isnan(HeightFromStored(WriteStored(folder_, band, side * stored))));
        EXPECT_EQ(HeightFromStored(WriteStored(folder_, band, 200.0)), 200.0);
        ExpectRefused(WriteStored(folder_, band, side * kInfinity), "row 1, column 1");
        ExpectRefused(WriteStored(folder_, band, side * -1e38), "row 1, column 1");
      }
    }
    const BandDeclaration of_nan{type, 1.0, 0.0, std::nan("")};
    EXPECT_TRUE(std::isnan(HeightFromStored(WriteStored(folder_, of_nan, std::nan("")))));
    EXPECT_EQ(HeightFromStored(WriteStored(folder_, of_nan, 200.0)), 200.0);
    ExpectRefused(WriteStored(folder_, of_nan, -kInfinity), "row 1, column 1");
  }
}

TEST_F(ElevationFile, LargeIntegersAreExact) {
  // Tenths of a millimetre: a float has 24 bits, and rounds to 4 of them.
  const BandDeclaration fine{GDT_Int32, 1e-4, 0.0, -2147483648.0};
  EXPECT_NEAR(HeightFromStored(WriteStored(folder_, fine, 88488600.0)), 8848.86, 1e-3);
  const BandDeclaration shifted{GDT_UInt32, 1.0, -4294960000.0, 0.0, "", 4294960007.0F};
  EXPECT_EQ(HeightFromStored(WriteStored(folder_, shifted, 4294960007.0)), 7.0);
  const BandDeclaration wide{GDT_Int64, 1e-9, 0.0, -1.0};
  EXPECT_NEAR(HeightFromStored(WriteStored(folder_, wide, std::int64_t{1234567890123}, GDT_Int64)),
              1234.568, 1e-3);
}

TEST_F(ElevationFile, SignedBytesHaveTheirSign) {
  Raster raster;
  raster.type = GDT_Byte;
  raster.height = [](int, int) { return 251.0F; };
  EXPECT_EQ(HeightFromStored(Write(raster)), 251.0);
  const fs::path file = folder_ / "signed.tif";
  const char* const options[] = {"PIXELTYPE=SIGNEDBYTE", nullptr};
  auto* source = static_cast<GDALDataset*>(GDALOpen(Write(raster).c_str(), GA_ReadOnly));
  GDALClose(GetGDALDriverManager()->GetDriverByName("GTiff")->CreateCopy(
      file.c_str(), source, FALSE, const_cast<char**>(options), nullptr, nullptr));
  GDALClose(source);
  EXPECT_EQ(HeightFromStored(file), -5.0);
}

TEST_F(ElevationFile, DeclaredScalesMustBeUsable) {
  ExpectRefused(WriteStored(folder_, {GDT_Int16, 0.0}, 7.0), "declares scale 0");
  ExpectRefused(WriteStored(folder_, {GDT_Int16, std::numeric_limits<double>::infinity()}, 7.0),
                "declares scale inf");
  ExpectRefused(WriteStored(folder_, {GDT_Float32, 1.0, std::nan("")}, 7.0), "offset nan");
}

TEST_F(ElevationFile, ImpossibleHeightsNameTheDeclaredNodata) {
  ExpectRefused(WriteStored(folder_, {GDT_Int16, 1.0, 0.0, 0.0}, -32768.0),
                "has the height -32768 m at row 1, column 1; the ground of the earth lies in "
                "[-12000, 9000] m, and 0 is the declared nodata value");
  ExpectRefused(WriteStored(folder_, {GDT_Float64}, -9e307), "no nodata value is declared");
}

TEST_F(ElevationFile, UnitsOfHeightsHaveTheirFactors) {
  for (const auto& [unit, metres] : {std::pair{"mm", 1e-3},
                                     {"cm", 0.01},
                                     {"Centimetre", 0.01},
                                     {"dm", 0.1},
                                     {"km", 1000.0},
                                     {"m ", 1.0},
                                     {" Metres", 1.0},
                                     {"m a.s.l.", 1.0},
                                     {"metres above sea level", 1.0},
                                     {"ftUS", 1200.0 / 3937.0},
                                     {"US_survey_foot", 1200.0 / 3937.0},
                                     {"Foot ", 0.3048}}) {
    const double stored = 7.0;
    EXPECT_NEAR(HeightFromStored(WriteStored(folder_, {GDT_Float32, 1e-3, 0.0, std::nullopt, unit},
                                             1e3 * stored)),
                stored * metres, 1e-3 * metres)
        << unit;
  }
}

TEST_F(ElevationFile, NumbersOfFilesDoNotFollowTheLocale) {
  const fs::path file = WriteStored(folder_, {GDT_Int16, 0.1, 2000.5, -32768.0, "cm"}, -9999.0);
  const double plain = HeightFromStored(file);
  const tests::CommaLocale locale(folder_);
  EXPECT_EQ(HeightFromStored(file), plain);
}

TEST_F(ElevationFile, OtherFormatsAreNamed) {
  for (const auto& [name, bytes, format] :
       {std::tuple{"a.hgt.gz", "\x1F\x8B\x08 and more", "this is gzip-compressed; "},
        {"N46E008.hgt", "PK\x03\x04 and more", "this is a zip archive"},
        {"a.asc", "ncols 3\nnrows 2\n", "this is an Arc/Info ASCII grid"},
        {"a.vrt", "<VRTDataset rasterXSize=\"2\"/>", "this is a virtual raster"},
        {"a.nc", "\x89HDF\r\n\x1A\n", "this is HDF5 or NetCDF-4"},
        {"a.img", "EHFA_HEADER_TAG", "this is ERDAS Imagine"}}) {
    WriteText(folder_ / name, bytes);
    ExpectRefused(folder_ / name, format);
    ExpectRefused(folder_ / name, "elevation models are read as GeoTIFF, SRTM .hgt or USGS DEM");
  }
  for (const char* name : {"N46E008 (1).hgt", "N46E8.hgt", "46N008E.hgt"}) {
    WriteText(folder_ / name, std::string(2 * 1201 * 1201, '\0'));
    ExpectRefused(folder_ / name, "its name must be the place of its south-western corner");
  }
}

TEST_F(ElevationFile, WhatAMaskOrAnAlphaBandLeavesOutIsAVoid) {
  const fs::path inside = Write(WesternSea());
  AddMask(inside, "YES");
  ExpectTwoColumnsOpen(inside);
  Raster other = WesternSea();
  other.name = "beside.tif";
  const fs::path beside = Write(other);
  AddMask(beside, "NO");
  ASSERT_TRUE(fs::exists(beside.string() + ".msk"));
  ExpectTwoColumnsOpen(beside);
  other.name = "alpha.tif";
  other.bands = 2;
  const fs::path alpha = Write(other);
  auto* dataset = static_cast<GDALDataset*>(GDALOpen(alpha.c_str(), GA_Update));
  dataset->GetRasterBand(2)->SetColorInterpretation(GCI_AlphaBand);
  LeaveColumnsOut(*dataset->GetRasterBand(2));
  GDALClose(dataset);
  ExpectTwoColumnsOpen(alpha);
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
  ExpectHeight(model.grid, -33.0, -71.0, 0.0, 1e-3);
  ExpectHeight(model.grid, -34.0, -70.0, 2400.0, 1e-3);
  fs::rename(tile, folder_ / "elsewhere.hgt");
  ExpectRefused(folder_ / "elsewhere.hgt", "not a readable");
}

TEST_F(ElevationFile, AUsgsDemIsRead) {
  Raster raster;
  raster.columns = 1201;
  raster.rows = 1201;
  raster.geotransform = {-76.0 - 0.5 * 0.25 / 1200, 0.25 / 1200, 0.0,
                         45.25 + 0.5 * 0.25 / 1200, 0.0,         -0.25 / 1200};
  raster.height = [](int row, int column) { return static_cast<float>(500 + row - column / 3); };
  const fs::path tif = Write(raster);
  GDALRegister_USGSDEM();
  auto* source = static_cast<GDALDataset*>(GDALOpen(tif.c_str(), GA_ReadOnly));
  const fs::path file = folder_ / "quad.dem";
  GDALDataset* copy = GetGDALDriverManager()->GetDriverByName("USGSDEM")->CreateCopy(
      file.c_str(), source, FALSE, nullptr, nullptr, nullptr);
  GDALClose(source);
  if (copy == nullptr) GTEST_SKIP() << "this GDAL writes no USGS DEM";
  GDALClose(copy);
  // The file holds whole metres.
  ExpectHeight(ReadElevation(file, VoidPolicy::kFill).grid, 45.1, -75.9, 500.0 + 720.0 - 160.0,
               1.5);
}

// Returns a raster in which the height of a sample encodes its column and row.
Raster Numbered() {
  Raster raster;
  raster.height = [](int row, int column) { return static_cast<float>(100 * row + column); };
  return raster;
}

TEST_F(ElevationFile, AWindowIsThatPartOfTheWhole) {
  Raster south_up = Numbered();
  south_up.name = "south.tif";
  south_up.geotransform = {7.0, 0.001, 0.0, 46.0, 0.0, 0.001};
  for (const Raster& raster : {Numbered(), south_up}) {
    const fs::path file = Write(raster);
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

TEST_F(ElevationFile, AWindowOfTheEarthContinuesAfterTheLastColumn) {
  Raster raster = Numbered();
  raster.columns = 36;
  raster.geotransform = {-180.0, 10.0, 0.0, 60.0, 0.0, -10.0};
  const ElevationGrid part = ReadElevation(Write(raster), VoidPolicy::kFill, {34, 2, 4, 3}).grid;
  ASSERT_EQ(part.columns, 4);
  EXPECT_NEAR(part.west_rad, 165.0 * kDegree, 1e-12);
  EXPECT_EQ(part.at(0, 1), 235.0F);
  EXPECT_EQ(part.at(0, 2), 200.0F);
  EXPECT_EQ(part.at(2, 3), 401.0F);
}

TEST_F(ElevationFile, AResampledModelCannotBeCut) {
  Raster raster;
  raster.epsg = 32632;
  raster.geotransform = {4e5, 30.0, 0.0, 5.2e6, 0.0, -30.0};
  EXPECT_FALSE(CanBeCut(Write(raster)));
}

// The model has the size of GEBCO's grid of 15 seconds, 3.7e9 samples. Blocks that are not written
// take no room in the file.
TEST_F(ElevationFile, AWindowOfAModelOfTheWholeEarthIsRead) {
  Raster earth;
  earth.columns = 86400;
  earth.rows = 43200;
  earth.type = GDT_Int16;
  earth.geotransform = {-180.0, 1.0 / 240.0, 0.0, 90.0, 0.0, -1.0 / 240.0};
  earth.window = {45120, 10440, 64, 32};
  earth.height = [](int row, int column) {
    return static_cast<float>(64 * (row - 10440) + column - 45120);
  };
  const fs::path file = Write(earth);
  EXPECT_EQ(ReadElevationExtent(file).columns, 86400);
  ASSERT_TRUE(CanBeCut(file));
  const ElevationGrid part = ReadElevation(file, VoidPolicy::kFill, {45110, 10430, 80, 50}).grid;
  EXPECT_EQ(part.height_m.size(), 80U * 50U);
  EXPECT_EQ(part.at(0, 0), 0.0F);
  EXPECT_EQ(part.at(10 + 5, 10 + 7), 64.0F * 5.0F + 7.0F);
  EXPECT_NEAR(part.west_rad, (-180.0 + 45110.5 / 240.0) * kDegree, 1e-12);
  ExpectRefused(file, "has 86400 x 43200 samples; at most 268435456 can be held");
}

TEST_F(ElevationFile, UndeclaredCustomaryNodataIsAVoid) {
  for (const float value :
       {kNan, -32768.0F, -32767.0F, -9999.0F, std::numeric_limits<float>::lowest()}) {
    Raster raster;
    raster.height = [&](int row, int column) { return row == 4 && column == 4 ? value : 700.0F; };
    const ElevationModel model = Model(raster);
    EXPECT_EQ(model.voids, 1U) << value;
    EXPECT_EQ(model.grid.at(4, 4), 700.0F);
  }
}

TEST_F(ElevationFile, ImpossibleHeightsAreRefusedByPlace) {
  for (const float value : {9001.0F, -12001.0F, 3.4e38F, std::numeric_limits<float>::infinity()}) {
    Raster raster;
    raster.height = [&](int row, int column) { return row == 4 && column == 5 ? value : 700.0F; };
    ExpectRefused(Write(raster), "row 4, column 5");
  }
}

TEST_F(ElevationFile, FilesThatAreNoElevationModelAreRefused) {
  struct Case {
    std::function<void(Raster&)> change;
    const char* fault;
  };
  for (const auto& [change, fault] : std::vector<Case>{
           {[](Raster& r) { r.height = [](int, int) { return kNan; }; }, "no valid sample"},
           {[](Raster& r) { r.epsg = 0; }, "no coordinate system"},
           {[](Raster& r) { r.bands = 3; }, "3 bands"},
           {[](Raster& r) { r.bands = 2; }, "2 bands"},
           {[](Raster& r) { r.type = GDT_CFloat32; }, "complex"},
           {[](Raster& r) { r.rows = 1; }, "16 x 1"},
           {[](Raster& r) { r.geotransform[2] = r.geotransform[4] = 0.0001; }, "rotated"},
           {[](Raster& r) { r.geotransform[3] = 90.01; }, "latitude"}}) {
    Raster raster;
    change(raster);
    ExpectRefused(Write(raster), fault);
  }
  ExpectRefused(folder_ / "missing.tif", "no such file");
  WriteText(folder_ / "N46E008.hgt", std::string(2000000, '\0'));
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

TEST(SharedElevation, BadFilesAreRefusedByNameAndFault) {
  if (!fs::exists(kDem / "bad")) GTEST_SKIP() << "no " << kDem / "bad";
  const std::pair<const char*, const char*> files[] = {
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

TEST(SharedElevation, ReadableFilesHaveTheirVoidsAndPlaces) {
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

TEST(SharedElevation, ProjectedFilesShowTheHillsOfTheGeographicOne) {
  if (!fs::exists(kDem / "bad")) GTEST_SKIP() << "no " << kDem / "bad";
  const ElevationGrid ok = ReadElevation(kDem / "bad" / "ok.tif", VoidPolicy::kFill).grid;
  struct Map {
    const char* name;
    int epsg;
    std::array<double, 6> transform;
  };
  for (const Map& map : {Map{"utm32.tif", 32632, {400000.0, 30.0, 0.0, 5150000.0, 0.0, -30.0}},
                         {"webmercator.tif", 3857, {834000.0, 30.0, 0.0, 5860000.0, 0.0, -30.0}}}) {
    SCOPED_TRACE(map.name);
    const ElevationGrid grid = ReadElevation(kDem / "bad" / map.name, VoidPolicy::kFill).grid;
    VisitSamples(map.epsg, map.transform, {2, 62, 1}, {2, 62, 1},
                 [&](int row, int column, double latitude, double longitude) {
                   // Hills of 300 m turn by 1/8 rad a sample; each of two bilinear steps loses up
                   // to 300 / 8^2 / 8 = 0.6 m in each dimension.
                   ExpectHeight(grid, latitude, longitude, static_cast<double>(ok.at(row, column)),
                                3.0);
                 });
  }
}

TEST(SharedElevation, FujiHasItsHeightAndPlace) {
  const fs::path tile = kDem / "N35E138.hgt";
  if (!fs::exists(tile)) GTEST_SKIP() << "no " << tile;
  const ElevationModel model = ReadElevation(tile, VoidPolicy::kFill);
  // A radar sample of 90 m cuts the rim of the crater.
  ExpectHeight(model.grid, 35.3606, 138.7274, 3776.0, 40.0);
  EXPECT_EQ(model.voids, 2437U);
  EXPECT_EQ(model.grid.columns, 1201);
  EXPECT_NEAR(model.grid.west_rad / kDegree, 138.0, 1e-9) << "samples of a tile lie on its degrees";
  EXPECT_NEAR(model.grid.north_rad / kDegree, 36.0, 1e-9);
}

TEST(SharedElevation, VoidsOfEverestAreFilledBetweenTheirRims) {
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
