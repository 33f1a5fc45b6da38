// SPDX-License-Identifier: MIT
#include "atmosphere/medium/medium_presets.h"

#include <gtest/gtest.h>

#include "atmosphere/colour/spectrum.h"

namespace alpenglow::atmosphere {
namespace {

TEST(MediumBands, OfAPresetAreThePresetThere) {
  for (const char* name : {"earth", "hazy", "clear-mountain", "mars"}) {
    const auto four = OnBands(MediumPreset(name, WavelengthSet(16)), 4);
    ASSERT_TRUE(four.has_value()) << name;
    EXPECT_EQ(*four, MediumPreset(name, WavelengthSet(4))) << name;
  }
}

TEST(MediumBands, FactorsOfAllWavelengthsAreKeptExactly) {
  const auto text = [](int bands) {
    return MediumFromToml("preset = \"earth\"\n[ozone]\ndobson = 450\n[spectrum]\nbands = " +
                              std::to_string(bands) + "\n",
                          "a.toml");
  };
  const auto eight = OnBands(text(4), 8);
  ASSERT_TRUE(eight.has_value());
  const Medium expected = text(8);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_NEAR(eight->ozone_absorption_per_m[i] / expected.ozone_absorption_per_m[i], 1.0, 1e-12);
    EXPECT_EQ(eight->solar_irradiance[i], expected.solar_irradiance[i]);
  }
}

TEST(MediumBands, DepolarisationIsThatOfTheGasOrLinearBetweenWavelengths) {
  const auto polarised = [](int bands) { return MediumPreset("earth", WavelengthSet(bands)); };
  const auto four = OnBands(polarised(16), 4);
  ASSERT_TRUE(four.has_value());
  EXPECT_EQ(*four, polarised(4));
  Medium own = polarised(4);
  own.rayleigh_depolarisation = {0.0, 0.1, 0.2, 0.3};
  const auto eight = OnBands(own, 8);
  ASSERT_TRUE(eight.has_value());
  ASSERT_EQ(eight->rayleigh_depolarisation.size(), 8U);
  for (std::size_t i = 1; i < 8; ++i)
    EXPECT_GE(eight->rayleigh_depolarisation[i], eight->rayleigh_depolarisation[i - 1]);
  own.rayleigh_depolarisation = {0.05};
  EXPECT_EQ(OnBands(own, 8)->rayleigh_depolarisation, std::vector<double>{0.05});
}

TEST(MediumBands, ThereAreNoneWhereNothingSaysWhatTheyAre) {
  EXPECT_FALSE(OnBands(MediumPreset("bruneton2017"), 8).has_value());
  Medium own = MediumPreset("earth");
  own.name = "my own";
  EXPECT_FALSE(OnBands(own, 8).has_value());
}

}  // namespace
}  // namespace alpenglow::atmosphere
