// SPDX-License-Identifier: MIT
// The moon in the renderer's pictures.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "atmosphere/astronomy/moon.h"
#include "atmosphere/math/constants.h"
#include "renderer/picture/render.h"
#include "tests/fixtures/bare_scene.h"

namespace alpenglow::renderer {
namespace {

/// A small picture around a direction, of the sky at night.
Image NightAround(double azimuth_rad, double elevation_rad, const UtcInstant& instant) {
  const Scene scene =
      BareScene(2.0, azimuth_rad / kRadiansPerDegree, elevation_rad / kRadiansPerDegree, 2.0);
  RenderSettings settings;
  settings.width = settings.height = 64;
  settings.samples_per_pixel = 1;
  return SceneRenderer(scene).Render(instant, settings);
}

/// Where the pixels lie that are brighter than a hundredth of the brightest, and how many.
struct Bright {
  double x = 0.0, y = 0.0, luminance = 0.0;
  int count = 0;
};

Bright BrightOf(const Image& image) {
  float most = 0.0F;
  for (const auto& pixel : image.rgb) most = std::max(most, pixel[1]);
  Bright bright;
  bright.luminance = static_cast<double>(most);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      if (image.at(x, y)[1] < 0.01F * most) continue;
      bright.x += x + 0.5;
      bright.y += y + 0.5;
      ++bright.count;
    }
  }
  bright.x /= bright.count;
  bright.y /= bright.count;
  return bright;
}

TEST(MoonPicture, TheFullMoonStandsWhereItIsAndIsAsBrightAsTheAirLetsThrough) {
  // Full on 2026 June 29 at 23:57 UT.
  const UtcInstant instant = ParseInstant("2026-06-29T23:30:00Z");
  const Scene scene = BareScene(2.0, 0.0, 0.0, 60.0);
  GeodeticPosition eye = scene.place;
  eye.height_m = 2.0;
  const MoonPosition moon = ApparentMoonAt(eye, instant);
  ASSERT_GT(moon.elevation_rad, 10.0 * kRadiansPerDegree);
  const Bright bright = BrightOf(NightAround(moon.azimuth_rad, moon.elevation_rad, instant));
  EXPECT_NEAR(bright.x, 32.0, 0.5) << "pixels of a thirty-second of a degree";
  EXPECT_NEAR(bright.y, 32.0, 0.5);
  const double radius_pixels =
      std::tan(moon.angular_radius_rad) / std::tan(kRadiansPerDegree) * 32.0;
  EXPECT_NEAR(bright.count, kPi * radius_pixels * radius_pixels, 12.0);
  EXPECT_GT(bright.luminance, 1000.0) << "cd/m^2, through two to four masses of air";
  EXPECT_LT(bright.luminance, 5100.0);
}

TEST(MoonPicture, TheHalfMoonIsLitOnItsRightInTheEveningOfTheNorth) {
  // First quarter on 2026 June 21 at 21:55 UT.
  const UtcInstant instant = ParseInstant("2026-06-21T20:30:00Z");
  const Scene scene = BareScene(2.0, 0.0, 0.0, 60.0);
  GeodeticPosition eye = scene.place;
  eye.height_m = 2.0;
  const MoonPosition moon = ApparentMoonAt(eye, instant);
  ASSERT_GT(moon.elevation_rad, 5.0 * kRadiansPerDegree);
  const Bright bright = BrightOf(NightAround(moon.azimuth_rad, moon.elevation_rad, instant));
  EXPECT_GT(bright.x, 33.0) << "towards the sun that has set";
  EXPECT_GT(bright.y, 32.5) << "and below";
}

}  // namespace
}  // namespace alpenglow::renderer
