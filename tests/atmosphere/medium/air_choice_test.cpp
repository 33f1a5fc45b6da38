// SPDX-License-Identifier: MIT
#include "atmosphere/medium/medium_presets.h"

#include <gtest/gtest.h>

#include "tests/fixtures/fault_of.h"

namespace alpenglow::atmosphere {
namespace {

TEST(AirChoice, AirHasTheRequestedVisibility) {
  const Medium earth = MediumPreset("earth");
  for (const double visibility_m : {2e3, 20e3, 100e3}) {
    AirChoice choice;
    choice.aerosol = AerosolForVisibility(earth, visibility_m);
    EXPECT_NEAR(VisibilityOf(Changed(earth, choice)), visibility_m, 1e-9 * visibility_m);
  }
  EXPECT_EQ(AerosolForVisibility(earth, 1e7), 0.0) << "molecules alone leave less";
}

TEST(AirChoice, VisibilityIsThatOfAirAndFogAtTheEye) {
  const Medium earth = MediumPreset("earth");
  EXPECT_DOUBLE_EQ(VisibilityAt(earth, 0.0, 0.0), VisibilityOf(earth));
  EXPECT_GT(VisibilityAt(earth, 3000.0, 0.0), 1.5 * VisibilityOf(earth)) << "over the haze";
  EXPECT_NEAR(VisibilityAt(earth, 0.0, 3.912 / 900.0), 900.0, 15.0) << "in fog";
  EXPECT_EQ(VisibilityAt(earth, -100.0, 0.0), VisibilityOf(earth));
}

TEST(AirChoice, OzoneIsMeasuredInDobsonUnits) {
  const Medium earth = MediumPreset("earth");
  EXPECT_NEAR(OzoneDobson(earth), 300.0, 60.0) << "the preset has the mean of the earth";
  AirChoice choice;
  choice.ozone_du = 450.0;
  EXPECT_NEAR(OzoneDobson(Changed(earth, choice)), 450.0, 1e-9);
  EXPECT_EQ(OzoneDobson(MediumPreset("mars")), 0.0);
}

TEST(AirChoice, ValuesOutOfRangeAreNamed) {
  AirChoice choice;
  choice.ground_albedo = 1.5;
  EXPECT_NE(
      tests::FaultOf([&] { return Changed(MediumPreset("earth"), choice); }).find("ground albedo"),
      std::string::npos);
}

}  // namespace
}  // namespace alpenglow::atmosphere
