// SPDX-License-Identifier: MIT
#include <alpenglow/errors.h>
#include <alpenglow/panorama.h>
#include <alpenglow/tables.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <stdexcept>
#include <vector>

#include "lut/api/conversions.h"
#include "lut/api/sky_parts.h"
#include "lut/sky/panorama.h"
#include "lut/table_io/exchange_check.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow {
namespace {

class Tables : public TemporaryFolder {};

TEST_F(Tables, AreInterpolatedAsByTheLayerBelow) {
  const Atmosphere earth;
  BakeTables(earth, folder_ / "baked", BakeQuality::kPreview);
  const Sky sky = ReadTables(folder_ / "baked", earth);
  const lut::TableLookup lookup(lut::ReadTableFolder(folder_ / "baked"));
  const LocalPoint eye{.up_m = 300.0};
  const Direction view = DirectionFromAngles(20.0, 40.0), sun = DirectionFromAngles(5.0, 200.0);
  const auto expected = lookup.InscatterOfAllOrders(
      RayFrom(AltitudeOf(eye, earth.planet_radius_m()), UnitVectorOf(view), UnitVectorOf(sun)));
  const Spectrum found = sky.Radiance(eye, view, sun);
  for (std::size_t band = 0; band < found.size(); ++band) EXPECT_EQ(found[band], expected[band]);
  EXPECT_EQ(sky.atmosphere().hash(), earth.hash());
  EXPECT_EQ(DescribeTables(folder_ / "baked"), lut::DescribeTables(folder_ / "baked"));
  EXPECT_THROW((void)ReadTables(folder_ / "baked", Atmosphere::Preset("hazy")), InputError);
  std::filesystem::remove(folder_ / "baked" / "multiple_scattering.exr");
  EXPECT_THROW((void)ReadTables(folder_ / "baked"), InputError);
}

TEST_F(Tables, UnusableFoldersAreRefused) {
  EXPECT_THROW((void)ReadTables(folder_ / "none"), InputError);
  EXPECT_THROW((void)DescribeTables(folder_), InputError);
  WriteText(folder_ / "file", "");
  EXPECT_THROW(BakeTables(Atmosphere(), folder_ / "file", BakeQuality::kPreview), OutputError);
  EXPECT_THROW(ExportTables(Atmosphere(), folder_, TableUser::kThreeAtmosphere), InputError);
}

TEST_F(Tables, ForBrunetonsDemoHaveItsLowestSun) {
  ExportTables(Atmosphere::Preset("bruneton2017"), folder_, TableUser::kBrunetonDemo);
  const lut::ExchangeDescription description = lut::DescribeExchangeTables(folder_);
  EXPECT_EQ(description.options.user, TableUser::kBrunetonDemo);
  EXPECT_EQ(description.options.lowest_sun_deg, 102.0);
  ASSERT_EQ(description.textures.size(), 3U);
  // Tables in float have sixteen nodes, the description twenty-four.
  EXPECT_LT(description.textures[2].errors.Quantile(0.5), 1e-5);
  EXPECT_LT(description.textures[2].errors.Largest(), 1e-2);
}

TEST_F(Tables, SingleScatteringAloneIsWrittenOnRequest) {
  BakeTables(Atmosphere(), folder_,
             {.quality = BakeQuality::kPreview, .single_scattering_only = true});
  EXPECT_TRUE(std::filesystem::exists(folder_ / "single_scattering.exr"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "multiple_scattering.exr"));
}

TEST_F(Tables, TellTheirProgressAndEndWhenTheyAreCancelled) {
  double before = 0.0;
  BakeTables(Atmosphere(), folder_,
             {.quality = BakeQuality::kPreview, .single_scattering_only = true},
             [&](double fraction) {
               EXPECT_GT(fraction, before);
               before = fraction;
               return true;
             });
  EXPECT_EQ(before, 1.0);
  const auto no = [](double) { return false; };
  EXPECT_THROW(BakeTables(Atmosphere(), folder_ / "baked", {}, no), Cancelled);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "baked" / "single_scattering.exr"));
  const Atmosphere three = Atmosphere::Preset("bruneton2017");
  EXPECT_THROW(ExportTables(three, folder_ / "exported", ExportOptions{}, no), Cancelled);
  EXPECT_THROW(ExportTables(three, folder_ / "exported", ExportOptions{},
                            [](double) -> bool { throw std::domain_error("of the caller"); }),
               std::domain_error);
  EXPECT_TRUE(std::filesystem::is_empty(folder_ / "exported"));
}

TEST_F(Tables, ExportsThatNoProgramLoadsAreRefused) {
  const Atmosphere three = Atmosphere::Preset("bruneton2017");
  for (const ExportOptions& options :
       {ExportOptions{.format = TexelFormat::kDat}, ExportOptions{.lowest_sun_deg = 102.0},
        ExportOptions{.user = TableUser::kBrunetonDemo, .type = TexelType::kHalf},
        ExportOptions{.user = static_cast<TableUser>(7)}})
    EXPECT_THROW(ExportTables(three, folder_ / "none", options), InputError);
  EXPECT_THROW(BakeTables(three, folder_ / "none", static_cast<BakeQuality>(7)), InputError);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "none"));
}

TEST(Panorama, EqualsThatOfTheLayerBelow) {
  const Sky sky{Atmosphere()};
  PanoramaOptions options;
  options.width = 32;
  options.height = 16;
  options.sun.lower_for_air_deg = 0.01;
  options.centre = PanoramaCentre::kUnity;
  const auto& air = SkyParts::LookupOf(sky).single_scattering();
  const auto& light = SkyParts::LookupOf(sky).multiple_scattering();
  const HdrImage panorama = RenderPanorama(sky, options);
  EXPECT_EQ(panorama.rgb, lut::RenderPanorama(air, light, options).rgb);
  EXPECT_TRUE(panorama.is_panorama);
  EXPECT_EQ(HorizontalIlluminance(sky, 2.0, options.sun),
            lut::HorizontalIlluminance(air, light, 2.0, options.sun));
  EXPECT_EQ(panorama.metadata.at("alpenglow.orientation"), "unity");
  EXPECT_EQ(panorama.metadata.at("alpenglow.sun_azimuth_deg"), "180.000000");
  options.width = 0;
  EXPECT_THROW((void)RenderPanorama(sky, options), InputError);
}

TEST(Panorama, TellsItsProgressAndEndsWhenItIsCancelled) {
  const Sky sky{Atmosphere()};
  const PanoramaOptions options{.width = 8, .height = 5, .sun = {}, .layers = {"polarisation"}};
  std::vector<double> fractions;
  const HdrImage panorama = RenderPanorama(sky, options, [&](double fraction) {
    fractions.push_back(fraction);
    return true;
  });
  EXPECT_EQ(fractions, (std::vector{0.2, 0.4, 0.6, 0.8, 1.0}));
  ASSERT_EQ(panorama.layers.size(), 2U);
  EXPECT_EQ(panorama.layers[0].name, "polarisation.degree");
  EXPECT_THROW((void)RenderPanorama(sky, options, [](double) { return false; }), Cancelled);
}

}  // namespace
}  // namespace alpenglow
