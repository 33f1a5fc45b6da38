// SPDX-License-Identifier: MIT
// A map of land cover laid over terrain decides what grows where, and the season what lies on it.
#include "renderer/material/land_cover.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "atmosphere/base/error.h"
#include "atmosphere/colour/spectrum.h"
#include "renderer/surface/surface.h"
#include "tests/fixtures/class_map.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/rough_land.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::renderer {
namespace {

using testing::HasSubstr;
using LandCover = TemporaryFolder;

constexpr std::uint32_t kCoverSide = 16;  // pixels of 500 m
constexpr MountainCover kSummer{2100.0, 2900.0};

SceneGround CoveredPlain() {
  SceneGround ground{LocalFrame(kWgs84, PlaceFromDegrees(46.0, 8.0, 0.0)), std::nullopt, 2.0, "",
                     true};
  ground.terrain.emplace(LandMesh([](double, double) { return 0.0; }, 33, 250.0));
  return ground;
}

/// The ground of a map whose western half is one class and whose eastern half is another.
GroundMaterial Halves(const std::filesystem::path& file, std::uint8_t west, std::uint8_t east) {
  std::vector<std::uint8_t> classes;
  for (std::uint32_t i = 0; i < kCoverSide * kCoverSide; ++i)
    classes.push_back(i % kCoverSide < kCoverSide / 2 ? west : east);
  tests::WriteClassMap(file, kCoverSide, classes);
  Scene scene;
  scene.terrain.land_cover = file;
  return {GroundCover{}, ColourDrape::Of(scene, CoveredPlain()), WavelengthSet(4)};
}

/// At 1000 m, so far away that there is no grain.
GroundPatch PatchAt(const GroundMaterial& material, double east_m, const MountainCover& cover,
                    double footprint_m = 100.0) {
  return material.OfTerrain({east_m, 0.0, 1000.0, footprint_m}, {east_m, 0.0, 0.0}, 0.9,
                            MountainSurface(WavelengthSet(4), cover));
}

double AlbedoAt(const GroundMaterial& material, double east_m, const MountainCover& cover) {
  return static_cast<double>(PatchAt(material, east_m, cover).BodyAlbedo(1.0)[1]);
}

TEST_F(LandCover, DecidesWhatGrowsWhere) {
  const auto trees_and_grass = Halves(folder_ / "a.tif", 10, 30);
  EXPECT_NEAR(AlbedoAt(trees_and_grass, -2000.0, kSummer), 0.05, 0.015) << "wood";
  EXPECT_NEAR(AlbedoAt(trees_and_grass, 2000.0, kSummer), 0.112, 0.025)
      << "grass, on a slope that would be wood";
  const auto bare_and_ice = Halves(folder_ / "b.tif", 60, 70);
  EXPECT_NEAR(AlbedoAt(bare_and_ice, -2000.0, kSummer), 0.17, 0.04) << "rock, under the tree line";
  EXPECT_GT(AlbedoAt(bare_and_ice, 2000.0, kSummer), 0.8) << "a glacier's tongue in summer";
}

TEST_F(LandCover, SnowOfTheSeasonLiesOnIt) {
  const auto material = Halves(folder_ / "a.tif", 10, 30);
  constexpr MountainCover kWinter{2100.0, 300.0};
  EXPECT_GT(AlbedoAt(material, 2000.0, kWinter), 0.8) << "meadow";
  EXPECT_LT(AlbedoAt(material, -2000.0, kWinter), 0.2) << "wood";
}

TEST_F(LandCover, LakesAreWaterAndTheirShoresAreWhereTheMapHasThem) {
  for (const int shore : {10, 20, 30, 60, 70, 90}) {
    const auto material = Halves(folder_ / "lake.tif", 80, static_cast<std::uint8_t>(shore));
    EXPECT_TRUE(material.HasGloss());
    EXPECT_TRUE(PatchAt(material, -251.0, kSummer).IsWater()) << shore;
    EXPECT_FALSE(PatchAt(material, 251.0, kSummer).IsWater())
        << shore << ": classes are mixed between the middles of pixels of 500 m";
  }
}

TEST_F(LandCover, WhereTheMapKnowsNothingGroundIsAsWithoutIt) {
  const auto material = Halves(folder_ / "a.tif", 0, 70);
  const GroundMaterial without(GroundCover{}, nullptr, WavelengthSet(4));
  EXPECT_EQ(AlbedoAt(material, -2000.0, kSummer), AlbedoAt(without, -2000.0, kSummer));
  EXPECT_FALSE(PatchAt(material, -2000.0, kSummer).IsWater());
}

TEST_F(LandCover, DistantGroundIsItsMean) {
  const auto material = Halves(folder_ / "a.tif", 10, 30);
  const double mean =
      static_cast<double>(PatchAt(material, 2000.0, kSummer, 1e6).BodyAlbedo(1.0)[1]);
  EXPECT_NEAR(mean, 0.5 * (0.05 + 0.112), 0.01);
}

TEST_F(LandCover, WhatIsNoMapIsRefused) {
  const auto file = folder_ / "odd.tif";
  EXPECT_THAT(tests::FaultOf([&] { return Halves(file, 10, 17); }),
              HasSubstr("has 17, which is no class of land cover"));
  Scene scene;
  scene.terrain.land_cover = folder_ / "none.tif";
  EXPECT_THAT(tests::FaultOf([&] { return ColourDrape::Of(scene, CoveredPlain()); }),
              HasSubstr("there is no such file"));
}

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

}  // namespace
}  // namespace alpenglow::renderer
