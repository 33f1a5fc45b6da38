// SPDX-License-Identifier: MIT
#include "renderer/surface/colour_drape.h"

#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/constants.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/rough_land.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::renderer {
namespace {

using testing::HasSubstr;
using DrapedColours = TemporaryFolder;

constexpr int kSide = 64;

// Red grows eastwards, green southwards.
std::array<std::uint8_t, 3> ColourAt(int column, int row) {
  return {static_cast<std::uint8_t>(3 * column), static_cast<std::uint8_t>(3 * row), 90};
}

void WritePicture(const std::filesystem::path& file, const std::array<double, 6>* transform) {
  constexpr int bands = 3;
  GDALRegister_GTiff();
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  GDALDataset* dataset = driver->Create(file.c_str(), kSide, kSide, bands, GDT_Byte, nullptr);
  for (int band = 0; band < bands; ++band) {
    for (int row = 0; row < kSide; ++row) {
      std::array<std::uint8_t, kSide> line;
      for (int column = 0; column < kSide; ++column)
        line[static_cast<std::size_t>(column)] =
            ColourAt(column, row)[static_cast<std::size_t>(band)];
      ASSERT_EQ(dataset->GetRasterBand(band + 1)->RasterIO(GF_Write, 0, row, kSide, 1, line.data(),
                                                           kSide, 1, GDT_Byte, 0, 0),
                CE_None);
    }
  }
  if (transform != nullptr) {
    std::array<double, 6> copy = *transform;
    dataset->SetGeoTransform(copy.data());
    OGRSpatialReference wgs84;
    wgs84.SetWellKnownGeogCS("WGS84");
    dataset->SetSpatialRef(&wgs84);
  }
  GDALClose(dataset);
}

double Linear(int code) {
  const double encoded = code / 255.0;
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

/// 8 km x 8 km of plain at 46 N 8 E.
SceneGround Plain() {
  const LocalFrame frame(kWgs84, PlaceFromDegrees(46.0, 8.0, 0.0));
  SceneGround ground{frame, std::nullopt, 2.0, "", true};
  ground.terrain.emplace(LandMesh([](double, double) { return 0.0; }, 33, 250.0));
  return ground;
}

Scene DrapedWith(const std::filesystem::path& file) {
  Scene scene;
  scene.terrain.colour = file;
  return scene;
}

TEST_F(DrapedColours, AreTheSameForPointsOfAnotherFrame) {
  const auto file = folder_ / "plain.tif";
  WritePicture(file, nullptr);
  const SceneGround ground = Plain();
  const auto drape = ColourDrape::Of(DrapedWith(file), ground);
  const LocalFrame other(kWgs84, PlaceFromDegrees(46.02, 8.03, 0.0));
  const auto moved = drape->In(other);
  for (const double latitude : {45.98, 46.0, 46.03}) {
    GeodeticPosition place = PlaceFromDegrees(latitude, 7.99, 300.0);
    const auto own = drape->At(ground.frame.EnuFromGeodetic(place).xyz, 300.0, 1.0);
    const auto seen = moved->At(other.EnuFromGeodetic(place).xyz, 300.0, 1.0);
    ASSERT_TRUE(own && seen);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR((*own)[k], (*seen)[k], 1e-9) << latitude;
  }
}

TEST_F(DrapedColours, WithoutAPlaceOfItsOwnCoversTheTerrainFromRimToRim) {
  const auto file = folder_ / "plain.tif";
  WritePicture(file, nullptr);
  const SceneGround ground = Plain();
  const auto drape = ColourDrape::Of(DrapedWith(file), ground);
  // The middle of pixel (16, 8): a quarter of the way east, an eighth of the way south.
  const double pixel_m = 8000.0 / kSide;
  const auto rgb = drape->At({-4000.0 + 16.5 * pixel_m, 4000.0 - 8.5 * pixel_m, 0.0}, 0.0, 1.0);
  ASSERT_TRUE(rgb.has_value());
  EXPECT_NEAR((*rgb)[0], Linear(48), 1e-4);
  EXPECT_NEAR((*rgb)[1], Linear(24), 1e-4);
  EXPECT_NEAR((*rgb)[2], Linear(90), 1e-4);
}

// A picture in which a square in the middle is left out, by `cut` of its dataset.
template <typename Cut>
void WriteHole(const std::filesystem::path& file, const Cut& cut) {
  WritePicture(file, nullptr);
  auto* dataset = static_cast<GDALDataset*>(GDALOpen(file.c_str(), GA_Update));
  std::vector<std::uint8_t> there(kSide * kSide, 255);
  for (std::size_t i = 0; i < there.size(); ++i) {
    const auto inside = [](std::size_t k) { return k >= 16 && k < 48; };
    if (inside(i % kSide) && inside(i / kSide)) there[i] = 0;
  }
  cut(*dataset, there);
  GDALClose(dataset);
}

void ExpectHole(const std::filesystem::path& file) {
  const SceneGround ground = Plain();
  const auto drape = ColourDrape::Of(DrapedWith(file), ground);
  for (const double footprint_m : {1.0, 300.0, 1500.0}) {
    EXPECT_FALSE(drape->At({100.0, -200.0, 0.0}, 0.0, footprint_m).has_value()) << footprint_m;
    EXPECT_TRUE(drape->At({-3500.0, 3500.0, 0.0}, 0.0, footprint_m).has_value()) << footprint_m;
  }
  // Colours beside the hole are not mixed with what is stored in it.
  const auto beside = drape->At({-4000.0 + 15.9 * 125.0, 0.0, 0.0}, 0.0, 1.0);
  ASSERT_TRUE(beside.has_value());
  EXPECT_NEAR((*beside)[0], Linear(45), 1e-4);
}

void WriteBand(GDALRasterBand& band, std::vector<std::uint8_t> values) {
  ASSERT_EQ(
      band.RasterIO(GF_Write, 0, 0, kSide, kSide, values.data(), kSide, kSide, GDT_Byte, 0, 0),
      CE_None);
}

TEST_F(DrapedColours, TransparentPixelsShowNothing) {
  WriteHole(folder_ / "mask.tif", [](GDALDataset& dataset, const auto& there) {
    ASSERT_EQ(dataset.CreateMaskBand(GMF_PER_DATASET), CE_None);
    WriteBand(*dataset.GetRasterBand(1)->GetMaskBand(), there);
  });
  ExpectHole(folder_ / "mask.tif");
  WriteHole(folder_ / "nodata.tif", [](GDALDataset& dataset, const auto& there) {
    for (int number = 1; number <= 3; ++number) {
      GDALRasterBand& band = *dataset.GetRasterBand(number);
      std::vector<std::uint8_t> values(there.size());
      ASSERT_EQ(
          band.RasterIO(GF_Read, 0, 0, kSide, kSide, values.data(), kSide, kSide, GDT_Byte, 0, 0),
          CE_None);
      for (std::size_t i = 0; i < values.size(); ++i) {
        if (there[i] == 0) values[i] = 7;
      }
      WriteBand(band, values);
      band.SetNoDataValue(7.0);
    }
  });
  ExpectHole(folder_ / "nodata.tif");
  const auto rgba = folder_ / "rgba.tif";
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  WriteHole(folder_ / "rgb.tif", [&](GDALDataset& dataset, const auto& there) {
    GDALDataset* copy = driver->Create(rgba.c_str(), kSide, kSide, 4, GDT_Byte, nullptr);
    for (int number = 1; number <= 3; ++number) {
      std::vector<std::uint8_t> values(there.size());
      ASSERT_EQ(dataset.GetRasterBand(number)->RasterIO(GF_Read, 0, 0, kSide, kSide, values.data(),
                                                        kSide, kSide, GDT_Byte, 0, 0),
                CE_None);
      WriteBand(*copy->GetRasterBand(number), values);
    }
    copy->GetRasterBand(4)->SetColorInterpretation(GCI_AlphaBand);
    WriteBand(*copy->GetRasterBand(4), there);
    GDALClose(copy);
  });
  ExpectHole(rgba);
}

TEST_F(DrapedColours, LiesWhereItsGeoreferenceSays) {
  const auto file = folder_ / "placed.tif";
  constexpr double kStep = 0.001;  // degrees
  const std::array<double, 6> transform{7.97, kStep, 0.0, 46.03, 0.0, -kStep};
  WritePicture(file, &transform);
  const SceneGround ground = Plain();
  const auto drape = ColourDrape::Of(DrapedWith(file), ground);
  for (const auto& [column, row] : {std::pair{40, 20}, {10, 50}, {25, 33}}) {
    const GeodeticPosition place =
        PlaceFromDegrees(46.03 - kStep * (row + 0.5), 7.97 + kStep * (column + 0.5), 800.0);
    const glm::dvec3 point = ground.frame.EnuFromGeodetic(place).xyz;
    const auto rgb = drape->At(point, 800.0, 1.0);
    ASSERT_TRUE(rgb.has_value());
    EXPECT_NEAR((*rgb)[0], Linear(3 * column), 0.01 * Linear(3 * column) + 1e-4);
    EXPECT_NEAR((*rgb)[1], Linear(3 * row), 0.01 * Linear(3 * row) + 1e-4)
        << "a hundredth of a pixel";
  }
  EXPECT_FALSE(drape->At({-3900.0, 0.0, 0.0}, 0.0, 1.0).has_value()) << "west of the picture";
}

TEST_F(DrapedColours, DistantGroundHasTheMeanColour) {
  const auto file = folder_ / "plain.tif";
  WritePicture(file, nullptr);
  const SceneGround ground = Plain();
  const auto drape = ColourDrape::Of(DrapedWith(file), ground);
  double mean = 0.0;
  for (int column = 0; column < kSide; ++column) mean += Linear(3 * column) / kSide;
  const auto rgb = drape->At({500.0, 500.0, 0.0}, 0.0, 1e6);
  ASSERT_TRUE(rgb.has_value());
  EXPECT_NEAR((*rgb)[0], mean, 1e-3 * mean) << "rounded to 16 bits at six levels";
}

TEST_F(DrapedColours, WhatIsNoPictureIsRefused) {
  const SceneGround ground = Plain();
  EXPECT_EQ(ColourDrape::Of(Scene{}, ground), nullptr);
  const auto fault = [&](const std::filesystem::path& file) {
    return tests::FaultOf([&] { return ColourDrape::Of(DrapedWith(file), ground); });
  };
  EXPECT_THAT(fault(folder_ / "none.png"), HasSubstr("there is no such file"));
  const auto text = folder_ / "text.png";
  std::ofstream(text) << "not a picture";
  EXPECT_THAT(fault(text), HasSubstr("not a readable GeoTIFF or PNG"));
  SceneGround bare = Plain();
  bare.terrain.reset();
  const auto file = folder_ / "plain.tif";
  WritePicture(file, nullptr);
  EXPECT_THROW((void)ColourDrape::Of(DrapedWith(file), bare), InputError);
}

TEST(BandsOfColour, AreTheAlbedosOfColours) {
  const std::vector<double> wavelengths = WavelengthSet(4);
  const BandsOfColour bands(wavelengths);
  for (const std::array<double, 3>& rgb :
       {std::array{0.2, 0.2, 0.2}, {0.1, 0.3, 0.2}, {0.5, 0.35, 0.3}}) {
    const std::vector<double> known = AlbedoFromLinearSrgb(rgb, wavelengths);
    const BandLight albedo = bands.Albedo(rgb);
    for (std::size_t band = 0; band < known.size(); ++band)
      EXPECT_NEAR(static_cast<double>(albedo[band]), known[band], 1e-6);
  }
}

}  // namespace
}  // namespace alpenglow::renderer
