// SPDX-License-Identifier: MIT
#include <alpenglow/errors.h>
#include <alpenglow/panorama.h>
#include <alpenglow/tables.h>
#include <gtest/gtest.h>

#include "lut/api/conversions.h"
#include "lut/sky/panorama.h"
#include "lut/table_io/exchange_check.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow {
namespace {

class Tables : public TemporaryFolder {};

TEST_F(Tables, AreLookedUpAsByTheLayerBelow) {
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

TEST_F(Tables, FoldersThatCannotBeReadOrMadeAreRefused) {
  EXPECT_THROW((void)ReadTables(folder_ / "none"), InputError);
  EXPECT_THROW((void)DescribeTables(folder_), InputError);
  WriteText(folder_ / "file", "");
  EXPECT_THROW(BakeTables(Atmosphere(), folder_ / "file", BakeQuality::kPreview), OutputError);
  EXPECT_THROW(ExportTables(Atmosphere(), folder_, TableUser::kThreeAtmosphere), InputError);
}

TEST_F(Tables, AreWrittenForBrunetonsDemoWhoseLowestSunTexelsTell) {
  ExportTables(Atmosphere::Preset("bruneton2017"), folder_, TableUser::kBrunetonDemo);
  const lut::ExchangeDescription description = lut::DescribeExchangeTables(folder_);
  EXPECT_EQ(description.options.layout, lut::ExchangeLayout::kBruneton);
  EXPECT_EQ(description.options.lowest_sun_deg, 102.0);
  ASSERT_EQ(description.textures.size(), 3U);
  // Tables in float have sixteen nodes, the description twenty-four.
  EXPECT_LT(description.textures[2].errors.Quantile(0.5), 1e-5);
  EXPECT_LT(description.textures[2].errors.Largest(), 1e-2);
}

TEST(Panorama, IsThatOfTheLayerBelow) {
  const Sky sky{Atmosphere()};
  PanoramaOptions options;
  options.width = 32;
  options.height = 16;
  options.sun.lower_for_air_deg = 0.01;
  options.centre = PanoramaCentre::kUnity;
  lut::PanoramaSettings settings;
  settings.width = 32;
  settings.height = 16;
  settings.orientation = lut::PanoramaOrientation::kUnity;
  settings.sun = options.sun;
  const auto& air = sky.state().lookup.single_scattering();
  const auto& light = sky.state().lookup.multiple_scattering();
  const HdrImage panorama = RenderPanorama(sky, options);
  EXPECT_EQ(panorama.rgb, lut::RenderPanorama(air, light, settings).rgb);
  EXPECT_TRUE(panorama.is_panorama);
  EXPECT_EQ(HorizontalIlluminance(sky, 2.0, options.sun),
            lut::HorizontalIlluminance(air, light, 2.0, settings.sun));
  options.width = 0;
  EXPECT_THROW((void)RenderPanorama(sky, options), InputError);
}

}  // namespace
}  // namespace alpenglow
