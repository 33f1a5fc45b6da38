// SPDX-License-Identifier: MIT
#include "atmosphere/colour/spectrum.h"

#include <gtest/gtest.h>

namespace alpenglow::atmosphere {
namespace {

TEST(Water, IsClearestInTheVioletAsPopeAndFryFound) {
  double clearest_nm = 380.0;
  for (double nm = 380.0; nm <= 750.0; nm += 1.0) {
    if (WaterAbsorption(nm) < WaterAbsorption(clearest_nm)) clearest_nm = nm;
  }
  EXPECT_NEAR(clearest_nm, 418.0, 10.0) << "their minimum lies at 418 nm; the table has 10 nm";
  EXPECT_NEAR(WaterAbsorption(clearest_nm), 0.0044, 0.0002) << "their 0.0044 1/m";
  for (double nm = 430.0; nm < 745.0; nm += 5.0)
    EXPECT_LE(WaterAbsorption(nm), WaterAbsorption(nm + 5.0)) << "no digit is out of place: " << nm;
}

TEST(Water, ScattersShortWavesMuchMoreThanLongOnes) {
  EXPECT_DOUBLE_EQ(SeaWaterScattering(500.0), 0.00288);
  EXPECT_NEAR(SeaWaterScattering(400.0) / SeaWaterScattering(700.0), 11.2, 0.1)
      << "(700 / 400)^4.32";
}

TEST(Ice, AbsorbsAThousandTimesMoreInDeepRedThanInViolet) {
  EXPECT_NEAR(IceAbsorption(550.0), 0.0523, 0.0001) << "4 pi 2.289e-9 / 550 nm";
  EXPECT_NEAR(IceAbsorption(400.0), 7.43e-4, 0.01e-4) << "4 pi 2.365e-11 / 400 nm";
  EXPECT_GT(IceAbsorption(750.0) / IceAbsorption(400.0), 1000.0);
  for (double nm = 390.0; nm < 745.0; nm += 5.0)
    EXPECT_LT(IceAbsorption(nm), IceAbsorption(nm + 5.0)) << "no digit is out of place: " << nm;
}

}  // namespace
}  // namespace alpenglow::atmosphere
