// SPDX-License-Identifier: MIT
#include "renderer/terrain/land_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "atmosphere/base/error.h"
#include "renderer/procedural_mountains/procedural_mountains.h"
#include "renderer/scene/scene_options.h"
#include "renderer/surface/scene_ground.h"
#include "renderer/terrain/terrain.h"
#include "tests/fixtures/fault_of.h"
#include "tests/renderer/terrain/land_files.h"

namespace alpenglow::renderer {
namespace {

using namespace tests;
using ::testing::HasSubstr;

class LandSourceFiles : public LandFolder {};

void ExpectSameGrid(const ElevationGrid& extent, const ElevationGrid& grid) {
  EXPECT_TRUE(extent.height_m.empty());
  EXPECT_EQ(extent.columns, grid.columns);
  EXPECT_EQ(extent.rows, grid.rows);
  EXPECT_EQ(extent.west_rad, grid.west_rad);
  EXPECT_EQ(extent.north_rad, grid.north_rad);
  EXPECT_EQ(extent.step_lon_rad, grid.step_lon_rad);
  EXPECT_EQ(extent.step_lat_rad, grid.step_lat_rad);
}

TEST_F(LandSourceFiles, ExtentEqualsThatOfTheModel) {
  WriteTile(folder_ / "a.tif", 0, 0);
  ExpectSameGrid(ReadElevationExtent(folder_ / "a.tif"),
                 ReadElevation(folder_ / "a.tif", VoidPolicy::kFill).grid);
}

TEST(LandSourceRange, ExtentEqualsThatOfTheMountains) {
  for (const double latitude_deg : {46.5, 89.8, -89.9}) {
    SCOPED_TRACE(latitude_deg);
    const Place centre{latitude_deg, 8.0, 0.0};
    ExpectSameGrid(ProceduralMountainsExtent(centre), ProceduralMountains(centre));
  }
}

/// A tile that rises eastwards from 100 m to 2100 m.
void WriteRisingTile(const std::filesystem::path& file, const DegreeGrid& grid) {
  WriteModel(file, grid, [&](int column, int) {
    return 100.0F + 2000.0F * static_cast<float>(column) / static_cast<float>(grid.columns - 1);
  });
}

/// A smooth land, of degrees.
double HillHeight(double longitude_deg, double latitude_deg) {
  return 800.0 + 600.0 * std::sin(25.0 * longitude_deg) * std::cos(20.0 * latitude_deg);
}

/// A tile of a degree, without the samples of its eastern and southern rims: so are those of
/// Copernicus, whose columns thin out towards the poles.
void WriteOpenTile(const std::filesystem::path& file, int west_deg, int north_deg, int columns,
                   int rows) {
  const double across = 1.0 / columns, down = 1.0 / rows;
  const double west = west_deg, north = north_deg;
  WriteModel(file, {west, north, across, down, columns, rows}, [&](int column, int row) {
    return static_cast<float>(HillHeight(west + column * across, north - row * down));
  });
}

/// Every sample of the lattice in a range of degrees is land, about as high as the hills.
void ExpectHills(const LoadedHeights& heights, double west_deg, double east_deg, double south_deg,
                 double north_deg, double tolerance_m) {
  const LandLattice& lattice = heights.tiles().lattice();
  const LatticePlace first =
      lattice.At(north_deg * kRadiansPerDegree, west_deg * kRadiansPerDegree);
  const LatticePlace last = lattice.At(south_deg * kRadiansPerDegree, east_deg * kRadiansPerDegree);
  const int column = static_cast<int>(std::ceil(first.column));
  const int row = static_cast<int>(std::ceil(first.row));
  const int columns = static_cast<int>(std::floor(last.column)) - column + 1;
  const int rows = static_cast<int>(std::floor(last.row)) - row + 1;
  const HeightBlock block = heights.Block(0, column, row, columns, rows);
  double worst_m = 0.0;
  for (int j = row; j < row + rows; ++j) {
    for (int i = column; i < column + columns; ++i) {
      const Place place = lattice.PlaceOf(i, j, 0.0);
      const double error_m =
          static_cast<double>(block.at(i, j)) - HillHeight(place.longitude_deg, place.latitude_deg);
      ASSERT_FALSE(std::isnan(error_m)) << "a hole at column " << i << ", row " << j;
      worst_m = std::max(worst_m, std::abs(error_m));
    }
  }
  EXPECT_LT(worst_m, tolerance_m);
}

// North of 50 degrees the columns of these tiles are one and a half times as far apart.
TEST_F(LandSourceFiles, LandIsUnbrokenBetweenTilesThatDoNotOverlap) {
  for (const int west_deg : {9, 10}) {
    WriteOpenTile(folder_ / ("n49e" + std::to_string(west_deg) + ".tif"), west_deg, 50, 60, 60);
    WriteOpenTile(folder_ / ("n50e" + std::to_string(west_deg) + ".tif"), west_deg, 51, 40, 60);
  }
  const LoadedHeights heights = AllHeights({{folder_}, VoidPolicy::kFill, std::nullopt});
  // Between columns 1/40 of a degree apart a line is up to (25 / 40)^2 / 8 * 600 m = 29 m off.
  ExpectHills(heights, 9.0, 10.975, 49.02, 51.0, 30.0);
  const LandLattice& lattice = heights.tiles().lattice();
  EXPECT_EQ(lattice.last_column, 119) << "nothing goes on where there is no neighbour";
  EXPECT_EQ(lattice.last_row, 119);
}

TEST_F(LandSourceFiles, LandIsUnbrokenBetweenRowsOffTheLattice) {
  WriteOpenTile(folder_ / "south.tif", 9, 50, 60, 60);
  WriteOpenTile(folder_ / "north.tif", 9, 51, 60, 40);
  const LoadedHeights heights = AllHeights({{folder_}, VoidPolicy::kFill, std::nullopt});
  ExpectHills(heights, 9.0, 9.98, 49.02, 51.0, 30.0);
}

TEST_F(LandSourceFiles, FourCoarseTilesMeetBesideAFineOne) {
  WriteOpenTile(folder_ / "fine.tif", 9, 49, 60, 60);
  for (const int west_deg : {9, 10})
    for (const int north_deg : {50, 51})
      WriteOpenTile(folder_ / ("z" + std::to_string(north_deg) + std::to_string(west_deg) + ".tif"),
                    west_deg, north_deg, 25, 25);
  const LoadedHeights heights = AllHeights({{folder_}, VoidPolicy::kFill, std::nullopt});
  // Lines between the tile's samples, 1/25 of a degree apart, are up to ((25 / 25)^2 + (20 / 25)^2)
  // / 8 * 600 m off, those between its level's, every other one of the lattice, up to ((25 / 30)^2
  // + (20 / 30)^2) / 8 * 600 m more.
  ExpectHills(heights, 9.0, 10.96, 49.05, 51.0, 123.0 + 86.0);
}

TEST_F(LandSourceFiles, AMissingTileRemainsAHole) {
  WriteOpenTile(folder_ / "west.tif", 9, 50, 40, 60);
  WriteOpenTile(folder_ / "far.tif", 11, 50, 60, 60);
  const LoadedHeights heights = AllHeights({{folder_}, VoidPolicy::kFill, std::nullopt});
  EXPECT_FALSE(heights.HeightUnder(49.5 * kRadiansPerDegree, 10.5 * kRadiansPerDegree));
  EXPECT_FALSE(heights.HeightUnder(49.5 * kRadiansPerDegree, 9.99 * kRadiansPerDegree));
}

// Blocks that are not written take no room in the file.
TEST_F(LandSourceFiles, AModelOfTheWholeEarthIsReadInParts) {
  GDALRegister_GTiff();
  const char* const options[] = {"SPARSE_OK=TRUE", "TILED=YES", nullptr};
  GDALDataset* dataset = GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
      (folder_ / "earth.tif").c_str(), 21600, 10800, 1, GDT_Int16, const_cast<char**>(options));
  std::array<double, 6> corner{-180.0, 1.0 / 60.0, 0.0, 90.0, 0.0, -1.0 / 60.0};
  dataset->SetGeoTransform(corner.data());
  OGRSpatialReference crs;
  crs.importFromEPSG(4326);
  dataset->SetSpatialRef(&crs);
  std::vector<float> line(21600);
  for (std::size_t i = 0; i < line.size(); ++i) line[i] = static_cast<float>(i % 5000);
  ASSERT_EQ(dataset->GetRasterBand(1)->RasterIO(GF_Write, 0, 8192, 21600, 1, line.data(), 21600, 1,
                                                GDT_Float32, 0, 0, nullptr),
            CE_None);
  GDALClose(dataset);
  LandSource source;
  source.files = {folder_ / "earth.tif"};
  const LandTiles tiles(source);
  ASSERT_EQ(tiles.tiles().size(), 6U * 3U);
  EXPECT_EQ(tiles.lattice().last_column, 21600) << "it ends where it begins";
  EXPECT_EQ(tiles.lattice().last_row, 10799);
  const LandTile& last = tiles.tiles()[17];
  EXPECT_EQ(last.box.first_column, 20480);
  EXPECT_EQ(last.box.last_column, 21600);
  EXPECT_EQ(last.box.first_row, 8192);
  const ReadTile read = ReadLandTile(tiles, 17, 0);
  EXPECT_EQ(read.heights->At(0, 20481, 8192), 481.0F);
  EXPECT_EQ(read.heights->At(0, 21600, 8192), 0.0F) << "column 0";
  EXPECT_EQ(read.heights->At(0, 20481, 8193), 0.0F);
}

// Near the poles tiles are narrower than others: the last sample of the lattice may lie past the
// last one of the tile, by less than a hundredth of a step of the lattice.
TEST_F(LandSourceFiles, ATileOfAnotherAspectKeepsTheHeightOfItsRim) {
  constexpr double kSecond_deg = 1.0 / 3600.0;
  const double west_deg = 8.0 + 0.992 * 10.0 * kSecond_deg;
  WriteRisingTile(folder_ / "a.tif", {8.0, 47.0, 10.0 * kSecond_deg, kSecond_deg, 37, 361});
  WriteRisingTile(folder_ / "b.tif",
                  {west_deg, 46.5, 3.0 * kSecond_deg, 3.0 * kSecond_deg, 21, 21});
  LandSource source;
  source.files = {folder_ / "a.tif", folder_ / "b.tif"};
  const LandTiles tiles(source);
  const ReadTile tile = ReadLandTile(tiles, 1, 0);
  const LatticeBox& box = tiles.tiles()[1].box;
  for (int row = box.first_row; row <= box.last_row; ++row) {
    // 0.08" east of the first sample; the land rises 100 m in 3".
    EXPECT_NEAR(tile.heights->At(0, box.first_column, row), 100.0 + 100.0 * 0.08 / 3.0, 0.01);
    EXPECT_EQ(tile.heights->At(0, box.last_column, row), 2100.0F) << row;
  }
}

TEST_F(LandSourceFiles, EverySampleOfATileIsASampleOfTheLattice) {
  WriteTiles(2);
  const LoadedHeights heights = AllHeights({{folder_}, VoidPolicy::kFill, std::nullopt});
  const LandLattice& lattice = heights.tiles().lattice();
  ASSERT_EQ(lattice.last_column, 2 * (kTileSamples - 1));
  ASSERT_EQ(lattice.last_row, 2 * (kTileSamples - 1));
  const HeightBlock block = heights.Block(0, 0, 0, 2 * kTileSamples - 1, 2 * kTileSamples - 1);
  for (int row = 0; row <= lattice.last_row; ++row)
    for (int column = 0; column <= lattice.last_column; ++column)
      ASSERT_EQ(block.at(column, row), HeightOfSample(column, row)) << column << " " << row;
}

TEST_F(LandSourceFiles, TwoTilesAgreeOnTheirSharedSamplesAtEveryLevel) {
  WriteTile(folder_ / "west.tif", 0, 0);
  WriteTile(folder_ / "east.tif", kTileSamples - 1, 0);
  const LoadedHeights heights = AllHeights({{folder_}, VoidPolicy::kFill, std::nullopt});
  const auto& tiles = heights.heights();
  const int shared = kTileSamples - 1;
  for (int level = 0; level <= 4; ++level) {  // 240 is 15 times 2^4
    for (int row = 0; row < kTileSamples; row += 1 << level)
      ASSERT_EQ(tiles[0]->At(level, shared, row), tiles[1]->At(level, shared, row)) << level;
  }
}

TEST_F(LandSourceFiles, ALevelIsTheBinomialMeanOfTheFinerOne) {
  WriteTile(folder_ / "a.tif", 0, 0);
  const LoadedHeights heights = AllHeights({{folder_}, VoidPolicy::kFill, std::nullopt});
  const HeightPyramid& tile = *heights.heights()[0];
  for (int level = 1; level < 5; ++level) {
    const int step = 1 << (level - 1);
    for (const int at : {2 * step, 6 * step}) {
      double mean = 0.0;
      for (int row = -1; row <= 1; ++row)
        for (int column = -1; column <= 1; ++column)
          mean += (2 - std::abs(row)) * (2 - std::abs(column)) / 16.0 *
                  static_cast<double>(tile.At(level - 1, at + column * step, at + row * step));
      EXPECT_NEAR(static_cast<double>(tile.At(level, at, at)), mean, 1e-3) << "float of 1500 m";
    }
  }
}

TEST(LandHeightPyramid, FinerHeightsAreInterpolated) {
  std::vector<float> heights;
  for (int row = 0; row < kTileSamples; row += 4)
    for (int column = 0; column < kTileSamples; column += 4)
      heights.push_back(HeightOfSample(column, row));
  const HeightPyramid coarse({0, 0, kTileSamples - 1, kTileSamples - 1}, 2, heights);
  EXPECT_EQ(coarse.At(0, 8, 12), HeightOfSample(8, 12));
  EXPECT_FLOAT_EQ(coarse.At(0, 9, 12),
                  0.75F * HeightOfSample(8, 12) + 0.25F * HeightOfSample(12, 12));
  EXPECT_FLOAT_EQ(coarse.At(0, 8, 14), 0.5F * HeightOfSample(8, 12) + 0.5F * HeightOfSample(8, 16));
}

TEST_F(LandSourceFiles, TilesOfTwoSpacingsMeetOnTheFinerLattice) {
  WriteTile(folder_ / "a_fine.tif", 0, 0);
  WriteTile(folder_ / "b_coarse.tif", 240, 0, 61, 4);  // every fourth sample
  const LoadedHeights heights = AllHeights({{folder_}, VoidPolicy::kFill, std::nullopt});
  const LandTiles& tiles = heights.tiles();
  EXPECT_EQ(tiles.tiles()[0].level, 0);
  EXPECT_EQ(tiles.tiles()[1].level, 2);
  ASSERT_EQ(tiles.lattice().last_column, 480);
  const HeightBlock block = heights.Block(0, 236, 100, 12, 1);
  EXPECT_EQ(block.at(239, 100), HeightOfSample(239, 100));
  EXPECT_EQ(block.at(240, 100), HeightOfSample(240, 100));
  EXPECT_EQ(block.at(244, 100), HeightOfSample(244, 100));
  EXPECT_FLOAT_EQ(block.at(242, 100),
                  0.5F * HeightOfSample(240, 100) + 0.5F * HeightOfSample(244, 100));
}

TEST_F(LandSourceFiles, GroundUnderAPlaceIsWhereRaysMeetIt) {
  WriteTile(folder_ / "a.tif", 0, 0);
  const LoadedHeights heights = AllHeights({{folder_}, VoidPolicy::kFill, std::nullopt});
  const Place middle = PlaceOfSample(120.0, 120.0, 0.0);
  const LocalFrame frame(kWgs84, middle);
  const Terrain terrain(
      MeshFromElevation(ReadElevation(folder_ / "a.tif", VoidPolicy::kFill).grid, frame));
  for (int i = 0; i < 500; ++i) {
    const double column = 0.3 + 239.4 * std::fmod(0.754877666 * i, 1.0);
    const double row = 0.3 + 239.4 * std::fmod(0.569840296 * i, 1.0);
    const Place high = PlaceOfSample(column, row, 9000.0);
    const LocalFrame there(kWgs84, high);
    const glm::dvec3 down = frame.EnuFromEcef(there.EcefFromEnu(Vector<Enu>{{0.0, 0.0, -1.0}})).xyz;
    const auto hit = terrain.Intersect(frame.EnuFromGeodetic(high).xyz, down);
    const auto ground = heights.HeightUnder(high.latitude_rad(), high.longitude_rad());
    ASSERT_TRUE(hit && ground) << column << " " << row;
    ASSERT_NEAR(*ground, 9000.0 - hit->distance_m, 0.01)
        << "the renderer's vertices are floats: 1 mm at 10 km, more on a slope";
  }
  EXPECT_FALSE(heights.HeightUnder(0.0, 0.0)) << "far away is no ground";
}

TEST_F(LandSourceFiles, ASampledGridIsTheLandAroundAPlace) {
  WriteTiles(2);
  const LoadedHeights heights = AllHeights({{folder_}, VoidPolicy::kFill, std::nullopt});
  const Place place = PlaceOfSample(240.0, 240.0, 0.0);
  const auto near = heights.SampledGrid(place, 1000.0, 64);
  ASSERT_TRUE(near);
  EXPECT_LE(std::max(near->columns, near->rows), 64);
  EXPECT_NEAR(*near->HeightAt(place.latitude_rad(), place.longitude_rad()),
              static_cast<double>(HeightOfSample(240, 240)), 0.01)
      << "within 1 km every sample fits";
  const auto all = heights.SampledGrid(place, 30e3, 64);
  ASSERT_TRUE(all);
  EXPECT_LE(std::max(all->columns, all->rows), 64);
  EXPECT_GT(all->columns * all->step_lon_rad, 0.9 * 0.2 * kRadiansPerDegree);
  const auto whole = heights.SampledGrid(place, 1e6, 512);
  ASSERT_TRUE(whole);
  EXPECT_EQ(whole->columns, heights.tiles().lattice().last_column + 1)
      << "where the land ends before, its samples count";
  const auto small = heights.SampledGrid(place, 1000.0, 512);
  ASSERT_TRUE(small);
  EXPECT_EQ(small->columns, whole->columns) << "land of so few samples comes whole";
  EXPECT_FALSE(heights.SampledGrid({0.0, 0.0, 0.0}, 30e3, 64));
}

/// Land around a pole.
class PolarLand : public LandFolder, public ::testing::WithParamInterface<double> {
 protected:
  void SetUp() override {
    LandFolder::SetUp();
    WritePolarModel(folder_ / "pole.tif", GetParam());
  }
  [[nodiscard]] LoadedHeights Heights() const {
    return AllHeights({{folder_ / "pole.tif"}, VoidPolicy::kFill, std::nullopt});
  }
};
INSTANTIATE_TEST_SUITE_P(BothPoles, PolarLand, ::testing::Values(1.0, -1.0));

// Hard case 17.
TEST_P(PolarLand, ASampledGridHasTheLandOnAllSidesOfThePole) {
  const LoadedHeights heights = Heights();
  constexpr double kHalf_m = 150e3;
  for (const double from_pole : {0.0, 0.03, 0.3, 1.2}) {
    const auto place = CheckedPlace({GetParam() * (90.0 - from_pole), 50.0, 0.0});
    const auto grid = heights.SampledGrid(place, kHalf_m, 128);
    ASSERT_TRUE(grid) << from_pole;
    EXPECT_LE(std::max(grid->columns, grid->rows), 128);
    EXPECT_LE(std::max(std::abs(grid->north_rad), std::abs(grid->LatitudeOfRow(grid->rows - 1))),
              0.5 * kPi + 1e-12);
    const LocalFrame frame(kWgs84, place);
    for (int i = 0; i < 200; ++i) {
      const double turn = 2.4 * i, away_m = 0.9 * kHalf_m * std::sqrt((i + 0.5) / 200.0);
      const Place at =
          frame.GeodeticFromEnu({{away_m * std::cos(turn), away_m * std::sin(turn), 0.0}});
      const auto height = grid->HeightAt(at.latitude_rad(), at.longitude_rad());
      ASSERT_TRUE(height) << from_pole << ": no ground at " << at.latitude_deg << ", "
                          << at.longitude_deg;
      EXPECT_NEAR(*height, static_cast<double>(HeightNearPole(at.latitude_deg, at.longitude_deg)),
                  8.0)
          << "the wave is curved by 50 m a square degree, over steps of up to 0.3 degrees";
    }
    EXPECT_FALSE(MeshFromElevation(*grid, frame).triangles.empty());
  }
}

// Hard case 17.
TEST_P(PolarLand, ASampledGridCrossesTheDateLine) {
  const LoadedHeights heights = Heights();
  const auto place = CheckedPlace({GetParam() * 86.0, 179.9, 0.0});
  const auto grid = heights.SampledGrid(place, 50e3, 512);
  ASSERT_TRUE(grid);
  for (const double longitude : {176.0, 179.5, 179.9, -179.9, -179.0, -177.0}) {
    const auto height = grid->HeightAt(place.latitude_rad(), longitude * kRadiansPerDegree);
    ASSERT_TRUE(height) << longitude;
    EXPECT_NEAR(*height, static_cast<double>(HeightNearPole(GetParam() * 86.0, longitude)), 3.0)
        << "linear between samples 0.1 and 0.7 degrees apart";
  }
}

// Hard case 17.
TEST_P(PolarLand, TheGroundUnderAnEyeIsContinuousOverThePole) {
  const LoadedHeights heights = Heights();
  double before = 0.0;
  for (int i = -100; i <= 100; ++i) {
    const double along = 0.003 * i;  // degrees from the pole, on the date line and on longitude 0
    const auto ground = heights.HeightUnder(
        GetParam() * (90.0 - std::abs(along)) * kRadiansPerDegree, along < 0.0 ? kPi : 0.0);
    ASSERT_TRUE(ground) << along;
    EXPECT_NEAR(
        *ground,
        static_cast<double>(HeightNearPole(90.0 - std::abs(along), along < 0.0 ? 180.0 : 0.0)), 3.0)
        << along << ": a row is 0.1 degrees, the wave bends by 0.3 m over it";
    if (i > -100) {
      EXPECT_NEAR(*ground, before, 1.5) << "160 m a degree, 0.003 degrees apart";
    }
    before = *ground;
  }
}

TEST_F(LandSourceFiles, UnreadableFilesAreNamed) {
  const auto fault = [](const LandSource& source) {
    return FaultOf([&] { return LandTiles(source); });
  };
  EXPECT_THAT(fault({{folder_ / "none.tif"}, VoidPolicy::kFill, std::nullopt}),
              HasSubstr("none.tif"));
  EXPECT_THAT(fault({{folder_}, VoidPolicy::kFill, std::nullopt}),
              HasSubstr("no elevation model (.hgt, .tif, .tiff, .dem) in this folder"));
  WriteText(folder_ / "broken.tif", "this is no TIFF");
  EXPECT_THAT(fault({{folder_}, VoidPolicy::kFill, std::nullopt}),
              testing::AllOf(HasSubstr("no elevation model in this folder can be read"),
                             HasSubstr("broken.tif: not a readable GeoTIFF")));
  WriteTile(folder_ / "good.tif", 0, 0);
  const LandTiles tiles({{folder_}, VoidPolicy::kFill, std::nullopt});
  EXPECT_EQ(tiles.tiles().size(), 1U);
  ASSERT_EQ(tiles.notes().size(), 1U);
  EXPECT_THAT(tiles.notes()[0], HasSubstr("broken.tif"));
}

TEST_F(LandSourceFiles, AllModelsThatMayBeInSightAreRead) {
  WriteTiles(2);
  SceneOptions options;
  for (const char* name : {"tile00.tif", "tile01.tif", "tile10.tif", "tile11.tif"})
    options.dem.push_back((folder_ / name).string());
  const Place place = PlaceOfSample(300.0, 400.0, 0.0);
  options.latitude = place.latitude_deg;
  options.longitude = place.longitude_deg;
  const ModelInSight named = ReadModelInSight(SceneFromOptions(options));
  const ElevationGrid& grid = named.model.grid;
  ASSERT_EQ(grid.columns, 2 * kTileSamples - 1);
  ASSERT_EQ(grid.rows, 2 * kTileSamples - 1);
  for (int row = 0; row < grid.rows; row += 7)
    for (int column = 0; column < grid.columns; ++column)
      ASSERT_EQ(grid.at(row, column), HeightOfSample(column, row)) << column << ' ' << row;
  options.dem = {folder_.string()};
  EXPECT_EQ(ReadModelInSight(SceneFromOptions(options)).model.grid.height_m, grid.height_m);
  options.latitude = 10.0;
  EXPECT_THROW(static_cast<void>(ReadModelInSight(SceneFromOptions(options))), InputError);
}

}  // namespace
}  // namespace alpenglow::renderer
