// SPDX-License-Identifier: MIT
#include "viewer/passes/frame_light.h"

#include <gtest/gtest.h>

#include <cmath>

#include "atmosphere/astronomy/sun.h"
#include "atmosphere/math/constants.h"
#include "renderer/illumination/night_light.h"

namespace alpenglow::viewer {
namespace {

TEST(NightSkyMap, LampsOfTownsAreInTheAirAsTheRendererHasThem) {
  const GeodeticPosition eye = PlaceFromDegrees(46.5, 8.0, 500.0);
  const UtcInstant now{61058, 73800.0};
  const Medium medium = MediumPreset("earth");
  const BandColour colour(medium.wavelengths_nm);
  const SingleScattering<float> air(OnOsculatingSphere(medium, eye.latitude_rad));
  const NightSkyMap dark = NightSkyMapOver(eye, now, medium, colour);
  const NightSkyMap city = NightSkyMapOver(eye, now, medium, colour, {18.0, 400.0});
  const BandLight towns = Skyglow(18.0, 400.0, air, colour);
  for (int band = 0; band < 4; ++band) {
    const auto at = static_cast<std::size_t>(band);
    EXPECT_FLOAT_EQ(city.scattered[band], dark.scattered[band] + towns[at]);
  }
  EXPECT_GT(city.level.y, 10.0F * dark.level.y);
}

TEST(NightSkyMap, BetweenTexelsTheSkyIsThatOfTheRenderer) {
  const GeodeticPosition eye = PlaceFromDegrees(46.5, 8.0, 3000.0);
  const UtcInstant now{61058, 73800.0};
  const Medium medium = MediumPreset("earth");
  const BandColour colour(medium.wavelengths_nm);
  const NightSkyMap floor = NightSkyMapOver(eye, now, medium, colour);
  const NightLight reference(NightSky(eye, now),
                             SingleScattering<float>(OnOsculatingSphere(medium, eye.latitude_rad)),
                             colour, {0.0, 0.0, 1.0}, eye.height_m);
  EXPECT_EQ(floor.scattered.x, reference.scattered()[0]);
  EXPECT_EQ(floor.level.x, reference.OnSurface(1.0)[0]);
  double sum = 0.0;
  int count = 0;
  for (int row = NightSkyMap::kRows / 2; row + 1 < NightSkyMap::kRows; row += 3) {
    for (int column = 0; column + 1 < NightSkyMap::kColumns; column += 5) {
      const auto texel = [&](int x, int y) {
        return static_cast<double>(
            floor.above[static_cast<std::size_t>((row + y) * NightSkyMap::kColumns + column + x)]
                .y);
      };
      const double between = 0.25 * (texel(0, 0) + texel(1, 0) + texel(0, 1) + texel(1, 1));
      const double elevation = kPi * ((row + 1.0) / NightSkyMap::kRows - 0.5);
      const double azimuth = 2.0 * kPi * (column + 1.0) / NightSkyMap::kColumns;
      const auto is =
          static_cast<double>(reference.Above(DirectionFromAngles(elevation, azimuth).xyz)[1]);
      EXPECT_NEAR(between, is, 0.08 * is) << "the lane of dust has edges within a texel";
      sum += std::abs(between / is - 1.0);
      ++count;
    }
  }
  EXPECT_LT(sum / count, 0.005) << "texels of 1.4 degrees";
}

}  // namespace
}  // namespace alpenglow::viewer
