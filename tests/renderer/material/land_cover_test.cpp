// SPDX-License-Identifier: MIT
// A map of land cover or a picture that is draped over terrain, and what covers mountains in each
// season, compared with observations.
#include "renderer/material/land_cover.h"

#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/time_place/time.h"
#include "renderer/surface/colour_drape.h"
#include "renderer/surface/surface.h"
#include "tests/fixtures/class_map.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/luminance.h"
#include "tests/fixtures/rough_land.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::renderer {
namespace {

using testing::HasSubstr;
using LandCover = TemporaryFolder;

constexpr std::uint32_t kCoverSide = 16;  // pixels of 500 m
constexpr MountainCover kSummer{2100.0, 2900.0};

/// Returns a plain of 8 km x 8 km at 46 N, by default at 8 E.
SceneGround Plain(double longitude = 8.0) {
  SceneGround ground{LocalFrame(kWgs84, CheckedPlace({46.0, longitude, 0.0})), std::nullopt, 2.0,
                     "", true};
  ground.terrain.emplace(LandMesh([](double, double) { return 0.0; }, 33, 250.0));
  return ground;
}

/// Returns the ground of a map whose western half is one class and whose eastern half another.
GroundMaterial Halves(const std::filesystem::path& file, std::uint8_t west, std::uint8_t east) {
  std::vector<std::uint8_t> classes;
  for (std::uint32_t i = 0; i < kCoverSide * kCoverSide; ++i)
    classes.push_back(i % kCoverSide < kCoverSide / 2 ? west : east);
  tests::WriteClassMap(file, kCoverSide, classes);
  Scene scene;
  scene.terrain.land_cover = file;
  return {GroundCover{}, ColourDrape::Of(scene, Plain()), WavelengthSet(4)};
}

/// Returns the ground at 1000 m, by default so far away that no grain is seen.
GroundPatch PatchAt(const GroundMaterial& material, double east_m, const MountainCover& cover,
                    double footprint_m = 100.0) {
  return material.OfTerrain({east_m, 0.0, 1000.0, footprint_m}, {east_m, 0.0, 0.0}, 0.9,
                            MountainSurface(WavelengthSet(4), cover));
}

double AlbedoAt(const GroundMaterial& material, double east_m, const MountainCover& cover) {
  return static_cast<double>(PatchAt(material, east_m, cover).BodyAlbedo(1.0)[1]);
}

TEST_F(LandCover, ClassesDecideWhatCoversTheGround) {
  const auto trees_and_grass = Halves(folder_ / "a.tif", 10, 30);
  EXPECT_NEAR(AlbedoAt(trees_and_grass, -2000.0, kSummer), 0.05, 0.015) << "wood";
  EXPECT_NEAR(AlbedoAt(trees_and_grass, 2000.0, kSummer), 0.112, 0.025)
      << "grass, on a slope that would be wood";
  const auto bare_and_ice = Halves(folder_ / "b.tif", 60, 70);
  EXPECT_NEAR(AlbedoAt(bare_and_ice, -2000.0, kSummer), 0.17, 0.04) << "rock, under the tree line";
  EXPECT_GT(AlbedoAt(bare_and_ice, 2000.0, kSummer), 0.8) << "a glacier's tongue in summer";
}

TEST_F(LandCover, SnowLiesOnMeadowsAndNotOnWoods) {
  const auto material = Halves(folder_ / "a.tif", 10, 30);
  constexpr MountainCover kWinter{2100.0, 300.0};
  EXPECT_GT(AlbedoAt(material, 2000.0, kWinter), 0.8) << "meadow";
  EXPECT_LT(AlbedoAt(material, -2000.0, kWinter), 0.2) << "wood";
}

TEST_F(LandCover, LakesAreWaterUpToTheShoresOfTheMap) {
  for (const int shore : {10, 20, 30, 60, 70, 90}) {
    const auto material = Halves(folder_ / "lake.tif", 80, static_cast<std::uint8_t>(shore));
    EXPECT_TRUE(material.HasGloss());
    EXPECT_TRUE(PatchAt(material, -251.0, kSummer).IsWater()) << shore;
    EXPECT_FALSE(PatchAt(material, 251.0, kSummer).IsWater())
        << shore << ": classes are mixed between the middles of pixels of 500 m";
  }
}

TEST_F(LandCover, GroundWithoutDataIsAsWithoutAMap) {
  const auto material = Halves(folder_ / "a.tif", 0, 70);
  const GroundMaterial without(GroundCover{}, nullptr, WavelengthSet(4));
  EXPECT_EQ(AlbedoAt(material, -2000.0, kSummer), AlbedoAt(without, -2000.0, kSummer));
  EXPECT_FALSE(PatchAt(material, -2000.0, kSummer).IsWater());
}

TEST_F(LandCover, DistantGroundHasTheMeanAlbedo) {
  const auto material = Halves(folder_ / "a.tif", 10, 30);
  const double mean =
      static_cast<double>(PatchAt(material, 2000.0, kSummer, 1e6).BodyAlbedo(1.0)[1]);
  EXPECT_NEAR(mean, 0.5 * (0.05 + 0.112), 0.01);
}

constexpr int kPictureSide = 64;
using Bytes = std::vector<std::uint8_t>;

// Copies a band of one byte per pixel between a file and a list.
void CopyBand(GDALRasterBand& band, GDALRWFlag direction, Bytes& values) {
  values.resize(kPictureSide * kPictureSide);
  ASSERT_EQ(band.RasterIO(direction, 0, 0, kPictureSide, kPictureSide, values.data(), kPictureSide,
                          kPictureSide, GDT_Byte, 0, 0),
            CE_None);
}

// Writes a picture in which red grows eastwards and green southwards.
std::filesystem::path WritePicture(const std::filesystem::path& file,
                                   const std::array<double, 6>* transform = nullptr,
                                   const char* crs = "WGS84") {
  GDALRegister_GTiff();
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  GDALDataset* dataset =
      driver->Create(file.c_str(), kPictureSide, kPictureSide, 3, GDT_Byte, nullptr);
  for (int band = 0; band < 3; ++band) {
    Bytes values;
    for (int i = 0; i < kPictureSide * kPictureSide; ++i) {
      const std::array colour{3 * (i % kPictureSide), 3 * (i / kPictureSide), 90};
      values.push_back(static_cast<std::uint8_t>(colour[static_cast<std::size_t>(band)]));
    }
    CopyBand(*dataset->GetRasterBand(band + 1), GF_Write, values);
  }
  if (transform != nullptr) {
    std::array<double, 6> copy = *transform;
    dataset->SetGeoTransform(copy.data());
    OGRSpatialReference reference;
    reference.SetFromUserInput(crs);
    dataset->SetSpatialRef(&reference);
  }
  GDALClose(dataset);
  return file;
}

TEST_F(LandCover, FilesThatAreNoMapOrPictureAreRefused) {
  const auto fault_of = [](const std::filesystem::path& map, const std::filesystem::path& colour,
                           const SceneGround& ground) {
    Scene scene;
    scene.terrain.land_cover = map;
    scene.terrain.colour = colour;
    return tests::FaultOf([&] { return ColourDrape::Of(scene, ground); });
  };
  const SceneGround ground = Plain();
  EXPECT_EQ(ColourDrape::Of(Scene{}, ground), nullptr);
  EXPECT_THAT(tests::FaultOf([&] { return Halves(folder_ / "odd.tif", 10, 17); }),
              HasSubstr("has 17, which is no class of land cover"));
  EXPECT_THAT(fault_of(folder_ / "none.tif", "", ground), HasSubstr("there is no such file"));
  EXPECT_THAT(fault_of("", folder_ / "none.png", ground), HasSubstr("there is no such file"));
  WriteText(folder_ / "text.png", "not a picture");
  EXPECT_THAT(fault_of("", folder_ / "text.png", ground),
              HasSubstr("not a readable GeoTIFF or PNG"));
  SceneGround bare = Plain();
  bare.terrain.reset();
  EXPECT_NE(fault_of("", WritePicture(folder_ / "plain.tif"), bare), "no fault");
}

/// Expects the colours (red, green, blue) of a place in 255ths.
void ExpectColour(const std::optional<std::array<double, 3>>& found,
                  const std::array<int, 3>& codes, double relative = 0.0) {
  ASSERT_TRUE(found.has_value());
  for (std::size_t c = 0; c < 3; ++c)
    EXPECT_NEAR((*found)[c], tests::LightOfCode(codes[c] / 255.0),
                relative * tests::LightOfCode(codes[c] / 255.0) + 1e-4);
}

class DrapedColours : public TemporaryFolder {
 protected:
  [[nodiscard]] static auto Drape(const std::filesystem::path& file, double longitude = 8.0) {
    Scene scene;
    scene.terrain.colour = file;
    return ColourDrape::Of(scene, Plain(longitude));
  }
};

TEST(CoverOfClass, SharesOfLandSumToOneAtMost) {
  int classes = 0;
  for (int number = -1; number < 300; ++number) {
    const auto cover = CoverOfClass(number);
    if (!cover) continue;
    ++classes;
    const double sum = (*cover)[0] + (*cover)[1] + (*cover)[2];
    if (number == 0 || number == 80) {
      EXPECT_EQ(sum, 2.0) << "a corner that no mixture of land comes near";
    } else {
      EXPECT_LE(sum, 1.0) << number;
    }
  }
  EXPECT_EQ(classes, 12) << "eleven, and no data";
}

TEST_F(DrapedColours, AreTheSameForPointsOfAnotherFrame) {
  const auto drape = Drape(WritePicture(folder_ / "plain.tif"));
  const LocalFrame other(kWgs84, Place{46.02, 8.03, 0.0});
  const auto moved = drape->In(other);
  for (const double latitude : {45.98, 46.0, 46.03}) {
    Place place = CheckedPlace({latitude, 7.99, 300.0});
    const auto own = drape->At(Plain().frame.EnuFromGeodetic(place).xyz, 300.0, 1.0);
    const auto seen = moved->At(other.EnuFromGeodetic(place).xyz, 300.0, 1.0);
    ASSERT_TRUE(own && seen);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR((*own)[k], (*seen)[k], 1e-9) << latitude;
  }
}

TEST_F(DrapedColours, WithoutGeoreferenceCoverTheTerrainFromRimToRim) {
  const auto drape = Drape(WritePicture(folder_ / "plain.tif"));
  // The middle of pixel (16, 8) is a quarter of the way east and an eighth of the way south.
  const double pixel_m = 8000.0 / kPictureSide;
  ExpectColour(drape->At({-4000.0 + 16.5 * pixel_m, 4000.0 - 8.5 * pixel_m, 0.0}, 0.0, 1.0),
               {48, 24, 90});
}

// Writes a picture in which `cut` of its dataset leaves a square in the middle out.
template <typename Cut>
void WriteHole(const std::filesystem::path& file, const Cut& cut) {
  auto* dataset = static_cast<GDALDataset*>(GDALOpen(WritePicture(file).c_str(), GA_Update));
  Bytes there(kPictureSide * kPictureSide, 255);
  for (std::size_t i = 0; i < there.size(); ++i) {
    const auto inside = [](std::size_t k) { return k >= 16 && k < 48; };
    if (inside(i % kPictureSide) && inside(i / kPictureSide)) there[i] = 0;
  }
  cut(*dataset, there);
  GDALClose(dataset);
}

TEST_F(DrapedColours, TransparentPixelsShowNothing) {
  WriteHole(folder_ / "mask.tif", [](GDALDataset& dataset, Bytes& there) {
    ASSERT_EQ(dataset.CreateMaskBand(GMF_PER_DATASET), CE_None);
    CopyBand(*dataset.GetRasterBand(1)->GetMaskBand(), GF_Write, there);
  });
  WriteHole(folder_ / "nodata.tif", [](GDALDataset& dataset, Bytes& there) {
    for (int number = 1; number <= 3; ++number) {
      GDALRasterBand& band = *dataset.GetRasterBand(number);
      Bytes values;
      CopyBand(band, GF_Read, values);
      for (std::size_t i = 0; i < values.size(); ++i) {
        if (there[i] == 0) values[i] = 7;
      }
      CopyBand(band, GF_Write, values);
      band.SetNoDataValue(7.0);
    }
  });
  WriteHole(folder_ / "rgb.tif", [&](GDALDataset& dataset, Bytes& there) {
    GDALDataset* copy = GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
        (folder_ / "rgba.tif").c_str(), kPictureSide, kPictureSide, 4, GDT_Byte, nullptr);
    for (int number = 1; number <= 3; ++number) {
      Bytes values;
      CopyBand(*dataset.GetRasterBand(number), GF_Read, values);
      CopyBand(*copy->GetRasterBand(number), GF_Write, values);
    }
    copy->GetRasterBand(4)->SetColorInterpretation(GCI_AlphaBand);
    CopyBand(*copy->GetRasterBand(4), GF_Write, there);
    GDALClose(copy);
  });
  for (const char* name : {"mask.tif", "nodata.tif", "rgba.tif"}) {
    SCOPED_TRACE(name);
    const auto drape = Drape(folder_ / name);
    for (const double footprint_m : {1.0, 300.0, 1500.0}) {
      EXPECT_FALSE(drape->At({100.0, -200.0, 0.0}, 0.0, footprint_m).has_value()) << footprint_m;
      EXPECT_TRUE(drape->At({-3500.0, 3500.0, 0.0}, 0.0, footprint_m).has_value()) << footprint_m;
    }
    // Colours next to the hole are not mixed with what is stored in it.
    const auto beside = drape->At({-4000.0 + 15.9 * 125.0, 0.0, 0.0}, 0.0, 1.0);
    ASSERT_TRUE(beside.has_value());
    EXPECT_NEAR((*beside)[0], tests::LightOfCode(45 / 255.0), 1e-4);
  }
}

TEST_F(DrapedColours, LieWhereTheGeoreferenceSays) {
  constexpr double kStep = 0.001;  // degrees
  const std::array<double, 6> transform{7.97, kStep, 0.0, 46.03, 0.0, -kStep};
  const auto drape = Drape(WritePicture(folder_ / "placed.tif", &transform));
  for (const auto& [column, row] : {std::pair{40, 20}, {10, 50}, {25, 33}}) {
    const Place place =
        CheckedPlace({46.03 - kStep * (row + 0.5), 7.97 + kStep * (column + 0.5), 800.0});
    constexpr double kShift = 0.01;  // a hundredth of a pixel
    ExpectColour(drape->At(Plain().frame.EnuFromGeodetic(place).xyz, 800.0, 1.0),
                 {3 * column, 3 * row, 90}, kShift);
  }
  EXPECT_FALSE(drape->At({-3900.0, 0.0, 0.0}, 0.0, 1.0).has_value()) << "west of the picture";
}

TEST_F(DrapedColours, DoNotDependOnTheTurnOfLongitudes) {
  constexpr double kStep = 0.001;  // degrees
  // The picture begins 0.03 degrees west of the middle of the land.
  for (const auto& [land, west] : {std::pair{8.0, 367.97},
                                   {8.0, -352.03},
                                   {-8.0, 351.97},
                                   {180.0, 179.97},
                                   {180.0, -180.03}}) {
    SCOPED_TRACE(testing::Message() << "land at " << land << ", picture from " << west);
    const std::array<double, 6> transform{west, kStep, 0.0, 46.03, 0.0, -kStep};
    const auto drape = Drape(WritePicture(folder_ / "placed.tif", &transform), land);
    EXPECT_EQ(drape->note(), "");
    for (const auto& [column, row] : {std::pair{2, 20}, {28, 33}, {33, 33}, {60, 50}}) {
      const Place place =
          CheckedPlace({46.03 - kStep * (row + 0.5), land - 0.03 + kStep * (column + 0.5), 800.0});
      constexpr double kShift = 0.01;  // a hundredth of a pixel
      ExpectColour(drape->At(Plain(land).frame.EnuFromGeodetic(place).xyz, 800.0, 1.0),
                   {3 * column, 3 * row, 90}, kShift);
    }
  }
}

TEST_F(DrapedColours, OfTheWholeEarthCoverLandOverItsSeam) {
  constexpr double kWide = 360.0 / kPictureSide;
  const std::array<double, 6> transform{-180.0, kWide, 0.0, 90.0, 0.0, -0.5 * kWide};
  const auto drape = Drape(WritePicture(folder_ / "earth.tif", &transform), 180.0);
  // The land lies half a column or less from the seam, so that colours are those of a rim.
  for (const auto& [east_m, column] :
       {std::pair{-3000.0, 63}, {-10.0, 63}, {10.0, 0}, {3000.0, 0}}) {
    const auto seen = drape->At({east_m, 0.0, 0.0}, 0.0, 1.0);
    ASSERT_TRUE(seen.has_value()) << east_m;
    EXPECT_NEAR((*seen)[0], tests::LightOfCode(3 * column / 255.0), 1e-4) << east_m;
  }
}

TEST_F(DrapedColours, BesideTheLandAreReported) {
  const auto note = [&](const std::array<double, 6>& transform) {
    return Drape(WritePicture(folder_ / "placed.tif", &transform))->note();
  };
  EXPECT_EQ(note({8.0, 1e-5, 0.0, 46.0, 0.0, -1e-5}), "") << "a small picture";
  for (const double west : {20.0, -172.0, 188.0, 8.1})
    EXPECT_THAT(note({west, 0.001, 0.0, 46.03, 0.0, -0.001}), HasSubstr("beside the land")) << west;
  EXPECT_THAT(note({7.97, 0.001, 0.0, 48.0, 0.0, -0.001}), HasSubstr("beside the land"));
}

TEST_F(DrapedColours, OnNoMapOfTheEarthAreRefused) {
  const auto fault = [&](const std::array<double, 6>& transform, const char* crs) {
    const std::filesystem::path file = WritePicture(folder_ / "placed.tif", &transform, crs);
    return tests::FaultOf([&] { return Drape(file); });
  };
  const std::array<double, 6> transform{7.97, 0.001, 0.0, 46.03, 0.0, -0.001};
  EXPECT_THAT(fault(transform, "EPSG:4978"), HasSubstr("neither geographic nor projected"));
  EXPECT_THAT(fault(transform, "+proj=longlat +a=3396190 +b=3376200"),
              HasSubstr("it must be of the earth"));
  std::array<double, 6> unknown = transform;
  unknown[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(fault(unknown, "WGS84"), HasSubstr("geotransform"));
}

TEST_F(DrapedColours, DistantGroundHasTheMeanColour) {
  double mean = 0.0;
  for (int column = 0; column < kPictureSide; ++column)
    mean += tests::LightOfCode(3 * column / 255.0) / kPictureSide;
  const auto rgb = Drape(WritePicture(folder_ / "plain.tif"))->At({500.0, 500.0, 0.0}, 0.0, 1e6);
  ASSERT_TRUE(rgb.has_value());
  EXPECT_NEAR((*rgb)[0], mean, 1e-3 * mean) << "rounded to 16 bits at six levels";
}

TEST(BandsOfColour, AreTheAlbedosOfColours) {
  const std::vector<double> wavelengths = WavelengthSet(4);
  const BandsOfColour bands(wavelengths);
  for (const std::array<double, 3>& rgb :
       {std::array{0.2, 0.2, 0.2}, {0.1, 0.3, 0.2}, {0.5, 0.35, 0.3}}) {
    const std::vector<double> known = AlbedoFromLinearSrgb(rgb, wavelengths);
    const Spectrum albedo = bands.Albedo(rgb);
    for (std::size_t band = 0; band < known.size(); ++band)
      EXPECT_NEAR(static_cast<double>(albedo[band]), known[band], 1e-6);
  }
}

constexpr std::array kFuji{35.36, 138.73}, kOetztal{46.9, 10.9}, kOberland{46.5, 8.0};

MountainCover On(const char* day, const std::array<double, 2>& place) {
  return CoverInSeason(CheckedPlace({place[0], place[1], 0.0}),
                       ParseInstant(std::string(day) + "T12:00:00Z").modified_julian_day);
}
MountainClimate ClimateAt(double latitude, double longitude) {
  return MountainClimateAt(CheckedPlace({latitude, longitude, 0.0}));
}

/// Returns the albedo of gentle ground in the green, averaged over the wavering of its lines.
double GentleAlbedo(const MountainCover& cover, double altitude_m) {
  const MountainSurface surface(WavelengthSet(4), cover);
  double sum = 0.0;
  constexpr int kPlaces = 400;
  for (int i = 0; i < kPlaces; ++i) {
    const GroundPoint at{1e5 + 713.0 * i, 5e6 - 419.0 * i, altitude_m, 1.0};
    sum += static_cast<double>(surface.Albedo(at, 0.95)[1]);
  }
  return sum / kPlaces;
}

TEST(MountainCover, RainierInJulyIsWhiteFrom2500MetresAndNotBelow2000) {
  const MountainCover cover = On("2026-07-15", {46.85, -121.76});
  EXPECT_NEAR(cover.snow_line_m, 2150.0, 150.0) << "its glaciers are white from 2100 to 2500 m";
  EXPECT_GT(GentleAlbedo(cover, 2600.0), 0.7) << "snow is 0.84";
  EXPECT_LT(GentleAlbedo(cover, 1800.0), 0.25) << "meadow and rock";
}

TEST(MountainCover, FujiIsWhiteInMidNovemberAndBareInAugust) {
  const MountainCover november = On("2026-11-15", kFuji);
  EXPECT_NEAR(november.snow_line_m, 2500.0, 300.0);
  EXPECT_GT(GentleAlbedo(november, 3300.0), 0.75);
  EXPECT_LT(GentleAlbedo(november, 2000.0), 0.2);
  EXPECT_GT(On("2026-08-15", kFuji).snow_line_m, 3776.0 + 200.0) << "of its summit";
  EXPECT_LT(On("2026-10-04", kFuji).snow_line_m, 3776.0)
      << "its first snow is seen from Kofu about 2 October in the mean";
}

TEST(MountainCover, GlaciersOfTheOetztalAreWhiteInSeptember) {
  const MountainCover cover = On("2026-09-15", kOetztal);
  EXPECT_NEAR(cover.snow_line_m, 3000.0, 100.0);
  EXPECT_GT(GentleAlbedo(cover, 3500.0), 0.75);
  EXPECT_LT(GentleAlbedo(cover, 2500.0), 0.25);
}

// Koerner (1998), Oecologia 115, 445: from 70 to 50 degrees north tree lines rise by 75 m a degree,
// and from 30 north to 20 south they lie between 3500 and 4000 m. No massif is near these places.
TEST(MountainCover, TreeLinesRiseTowardsTheTropicsAsInKoerner1998) {
  EXPECT_NEAR((ClimateAt(50.0, 115.0).tree_line_m - ClimateAt(70.0, 115.0).tree_line_m) / 20.0,
              75.0, 10.0);
  for (const double latitude : {29.0, 20.0, 10.0, 0.0, -10.0, -20.0})
    EXPECT_NEAR(ClimateAt(latitude, -140.0).tree_line_m, 3750.0, 300.0) << latitude;
}

// Wikipedia's article on the tree line collects the values of lands; the others are of mountains.
TEST(MountainCover, TreeLinesAreThoseObserved) {
  struct Land {
    const char* name;
    double latitude, longitude, line_m, tolerance_m;
  };
  for (const Land& land : {Land{"Sweden", 68.0, 18.5, 800.0, 200.0},
                           {"Norway", 61.0, 8.5, 1100.0, 200.0},
                           {"Swiss Alps", 46.5, 8.0, 2100.0, 200.0},
                           {"Alps of Piedmont", 45.0, 7.0, 2100.0, 200.0},
                           {"Fuji", 35.36, 138.73, 2500.0, 60.0},
                           {"Alps, 2000 to 2200 m", 46.9, 10.9, 2100.0, 100.0},
                           {"Front Range", 40.0, -105.7, 3450.0, 100.0},
                           {"New Zealand", -44.0, 169.5, 1250.0, 100.0}}) {
    EXPECT_NEAR(On("2026-06-15", {land.latitude, land.longitude}).tree_line_m, land.line_m,
                land.tolerance_m)
        << land.name << ": outer and inner valleys of the Alps differ by 200 m";
  }
  EXPECT_LT(On("2026-06-15", {79.0, 12.0}).tree_line_m, -500.0) << "none on Svalbard";
}

// Glaciers of long series (World Glacier Monitoring Service), rounded to 50 m; none is a massif of
// the table, and all lie in valleys that are moister or drier than the massif.
TEST(MountainCover, SnowLastsAboveTheEquilibriumLinesOfGlaciers) {
  struct Glacier {
    const char* name;
    double latitude, longitude, line_m;
  };
  for (const Glacier& glacier : {Glacier{"Hintereisferner", 46.80, 10.77, 3000.0},
                                 {"Gries", 46.43, 8.33, 2900.0},
                                 {"Saint-Sorlin", 45.16, 6.16, 2900.0},
                                 {"Storglaciaeren", 67.90, 18.57, 1450.0},
                                 {"Nigardsbreen", 61.72, 7.13, 1550.0},
                                 {"South Cascade", 48.36, -121.06, 1950.0},
                                 {"Peyto", 51.67, -116.55, 2650.0},
                                 {"Gulkana", 63.28, -145.42, 1750.0},
                                 {"Tuyuksu", 43.05, 77.08, 3800.0},
                                 {"Djankuat", 43.20, 42.77, 3200.0},
                                 {"White", 79.45, -90.70, 950.0}}) {
    EXPECT_NEAR(ClimateAt(glacier.latitude, glacier.longitude).ice_line_m, glacier.line_m, 400.0)
        << glacier.name;
  }
}

TEST(MountainCover, AnObservedMassifHasItsObservedLines) {
  const MountainClimate alps = ClimateAt(46.9, 10.9);
  EXPECT_NEAR(alps.winter_line_m, 641.0, 60.0) << "Hantel, Maurer (2011); the bound of the header";
  EXPECT_NEAR(alps.ice_line_m, 3000.0, 60.0);
}

TEST(MountainCover, SnowComesFasterThanItGoes) {
  for (const auto& [day, line_m] : {std::pair{"2026-11-15", 1700.0},
                                    {"2026-02-15", 641.0},
                                    {"2026-04-15", 1500.0},
                                    {"2026-06-15", 2600.0}})
    EXPECT_NEAR(On(day, kOetztal).snow_line_m, line_m, 100.0) << day;
}

TEST(MountainCover, TheSouthHasItsWinterHalfAYearLater) {
  for (int day = 61000; day < 61366; day += 15) {
    EXPECT_NEAR(WinterShare(-0.7, day), WinterShare(0.7, day + 183), 0.02)
        << "half a year is 182.6 days, and a day is at most 0.012";
  }
}

TEST(MountainCover, TheTropicsHaveNoWinter) {
  const MountainClimate kenya = ClimateAt(-0.15, 37.3);
  EXPECT_LT(kenya.ice_line_m - kenya.winter_line_m, 200.0);
}

TEST(MountainCover, AntarcticaIsWhiteDownToTheSeaInItsSummer) {
  EXPECT_LT(On("2026-01-31", {-80.0, 30.0}).snow_line_m, -600.0) << "the line wavers by 400 m";
}

TEST(MountainCover, LinesDoNotJumpAroundTheWorld) {
  for (const double latitude : {-80.0, -43.0, 0.0, 35.4, 46.9, 67.0}) {
    MountainClimate before = ClimateAt(latitude, -180.0);
    for (double longitude = -179.5; longitude <= 180.0; longitude += 0.5) {
      const MountainClimate here = ClimateAt(latitude, longitude);
      EXPECT_NEAR(here.ice_line_m, before.ice_line_m, 250.0)
          << latitude << " " << longitude << ": half a degree is at most a seventh of a reach";
      before = here;
    }
  }
}

TEST(MountainCover, BeechesOfTheAlpsAreInLeafFromAprilToOctober) {
  EXPECT_LT(On("2026-04-10", kOberland).leaf_line_m, 500.0);
  EXPECT_NEAR(On("2026-04-25", kOberland).leaf_line_m, 500.0, 50.0) << "a day is 30 m";
  EXPECT_GT(On("2026-05-15", kOberland).leaf_line_m, 1000.0);
  EXPECT_GT(On("2026-10-20", kOberland).bare_line_m, 500.0);
  EXPECT_LT(On("2026-10-20", kOberland).leaf_line_m, 500.0) << "yellow between both";
  EXPECT_LT(On("2026-11-10", kOberland).bare_line_m, 500.0);
  EXPECT_LT(On("2026-02-10", kOberland).grass_line_m, -300.0) << "grass sleeps";
}

TEST(MountainCover, SpringRisesBy122MetresInFourDays) {
  const double here = On("2026-04-20", kOberland).leaf_line_m;
  EXPECT_NEAR(On("2026-04-24", kOberland).leaf_line_m - here, 122.0, 0.1);
  EXPECT_NEAR(On("2026-04-24", {47.5, 8.0}).leaf_line_m - here, 0.0, 0.1);
}

TEST(MountainCover, TheTropicsAreGreenAllTheYear) {
  for (int day = 61000; day < 61366; day += 10) {
    for (const double latitude : {-20.0, 0.0, 20.0}) {
      const MountainCover cover = CoverInSeason(CheckedPlace({latitude, 30.0, 0.0}), day);
      EXPECT_GT(cover.leaf_line_m, 500.0) << latitude << " " << day;
      EXPECT_GT(cover.grass_line_m, 500.0) << latitude << " " << day;
    }
  }
}

TEST(MountainCover, SnowLiesLowerOnSlopesAwayFromTheSun) {
  for (const double latitude : {46.5, -43.6}) {
    MountainCover cover = On("2026-01-15", {latitude, 10.0});
    cover.tree_line_m = -1000.0;
    cover.snow_line_m = 2000.0;
    const MountainSurface surface(WavelengthSet(4), cover);
    GroundPoint polewards{0.0, 0.0, 2050.0, 1e4};
    polewards.normal_north = latitude > 0.0 ? 0.4 : -0.4;
    GroundPoint sunwards = polewards;
    sunwards.normal_north = -polewards.normal_north;
    EXPECT_GT(surface.Albedo(polewards, 0.9)[1], 0.6F) << latitude;
    EXPECT_LT(surface.Albedo(sunwards, 0.9)[1], 0.4F) << latitude;
  }
}

TEST(MountainCover, MoreSnowIsSeenUnderBareTreesThanUnderConifers) {
  MountainCover winter{2150.0, 650.0, -2000.0, -2000.0, -2000.0};
  const GroundPoint at{0.0, 0.0, 1000.0, 1e4};
  const float conifers = MountainSurface(WavelengthSet(4), winter).Albedo(at, 0.88)[1];
  winter.broadleaf_line_m = 2000.0;
  const float leafless = MountainSurface(WavelengthSet(4), winter).Albedo(at, 0.88)[1];
  EXPECT_NEAR(conifers, 0.14F, 0.03F) << "Betts, Ball (1997): 0.13";
  EXPECT_NEAR(leafless, 0.21F, 0.03F) << "Betts, Ball (1997): 0.21 of aspen";
}

TEST(MountainCover, WoodHidesMostOfItsSnow) {
  MountainCover winter;
  winter.tree_line_m = 2150.0;
  winter.snow_line_m = 650.0;
  const MountainSurface surface(WavelengthSet(4), winter);
  const GroundPoint at{0.0, 0.0, 1300.0, 1e4};
  EXPECT_NEAR(static_cast<double>(surface.Albedo(at, 0.88)[1]), 0.14, 0.05)
      << "a slope of wood; Betts, Ball (1997) measured 0.13";
  EXPECT_GT(surface.Albedo({0.0, 0.0, 2900.0, 1e4}, 0.88)[1], 0.8F) << "over the trees";
}

}  // namespace
}  // namespace alpenglow::renderer
