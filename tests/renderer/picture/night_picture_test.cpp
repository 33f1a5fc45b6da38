// SPDX-License-Identifier: MIT
// What shines at night in the renderer's pictures.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "atmosphere/astronomy/moon.h"
#include "atmosphere/astronomy/night_sky.h"
#include "atmosphere/math/constants.h"
#include "renderer/picture/render.h"
#include "tests/fixtures/bare_scene.h"
#include "tests/fixtures/luminance.h"

namespace alpenglow::renderer {
namespace {

const UtcInstant kMoonless = ParseInstant("2026-01-17T22:00:00Z");  // new moon: January 18, 19:52
const UtcInstant kFullMoon = ParseInstant("2026-12-24T00:30:00Z");  // full: 01:28
const UtcInstant kNoon = ParseInstant("2026-06-21T11:30:00Z");

constexpr EffectSet kOfNight{Effect::kMoonlight, Effect::kNightSky, Effect::kStars};

EffectSet Without(EffectSet effects) {
  EffectSet rest = EffectSet::All();
  for (const Effect effect : effects.List()) rest = rest.Without(effect);
  return rest;
}

RenderSettings Small(int width, int height, EffectSet effects = EffectSet::All()) {
  RenderSettings settings;
  settings.width = width;
  settings.height = height;
  settings.samples_per_pixel = 1;
  settings.effects = effects;
  return settings;
}

/// Illuminance that a picture holds, of a narrow field [lux].
double Lux(const Image& image, double pixel_rad) {
  double sum = 0.0;
  for (const auto& rgb : image.rgb) sum += tests::Luminance(rgb);
  return sum * pixel_rad * pixel_rad;
}

/// A direction as azimuth and elevation [degrees].
struct Look {
  double azimuth, elevation;
};

/// Sirius, from the place of BareScene.
Look SiriusAt(const UtcInstant& instant) {
  const LocalFrame frame(kWgs84, PlaceFromDegrees(46.5, 8.0, 2.0));
  const glm::dvec3 enu = frame.EnuFromEcef(StarsAt(instant).front().direction).xyz;
  return {std::atan2(enu.x, enu.y) / kRadiansPerDegree, std::asin(enu.z) / kRadiansPerDegree};
}

TEST(NightPicture, AStarIsOfTheSameLuxAtEverySizeOfThePicture) {
  const Look sirius = SiriusAt(kMoonless);
  ASSERT_GT(sirius.elevation, 20.0);
  const SceneRenderer renderer(BareScene(2.0, sirius.azimuth, sirius.elevation + 0.1, 4.0));
  std::vector<double> lux;
  for (const int side : {24, 60, 111}) {
    const double pixel_rad = 2.0 * std::tan(2.0 * kRadiansPerDegree) / side;
    const double with = Lux(renderer.Render(kMoonless, Small(side, side)), pixel_rad);
    const double without =
        Lux(renderer.Render(kMoonless, Small(side, side, Without({Effect::kStars}))), pixel_rad);
    // Of molecules 0.097, dust 0.05 and ozone 0.03 in V, 2.2 air masses leave exp(-0.39) of 9.7e-6
    // lux above the air; faint neighbours bring a hundredth.
    EXPECT_NEAR((with - without) / 9.7e-6, 0.68, 0.02) << side;
    lux.push_back(with - without);
  }
  EXPECT_NEAR(lux[0] / lux[1], 1.0, 1e-3) << "the field's pixels are not quite of one size";
  EXPECT_NEAR(lux[2] / lux[1], 1.0, 1e-3);
}

TEST(NightPicture, ATrailIsOfTheLuxOfItsStarAtEverySizeAndAsLongAsTheSkyTurns) {
  const Look sirius = SiriusAt(kMoonless);
  Scene scene = BareScene(2.0, sirius.azimuth, sirius.elevation + 0.1, 4.0);
  const SceneRenderer still(scene);
  scene.camera.shutter_s = 300.0;
  const SceneRenderer open(scene);
  for (const int side : {24, 60, 111}) {
    const double pixel_rad = 2.0 * std::tan(2.0 * kRadiansPerDegree) / side;
    const auto settings = Small(side, side), dark = Small(side, side, Without({Effect::kStars}));
    const Image empty = open.Render(kMoonless, dark), trails = open.Render(kMoonless, settings);
    const double of_star =
        Lux(still.Render(kMoonless, settings), pixel_rad) - Lux(empty, pixel_rad);
    const double of_trail = Lux(trails, pixel_rad) - Lux(empty, pixel_rad);
    EXPECT_NEAR(of_trail / of_star, 1.0, 5e-3)
        << side << ": faint neighbours come in and go out, a hundredth of its light";
    int first = side, last = 0;
    for (int x = 0; x < side; ++x) {
      double column = 0.0;
      for (int y = 0; y < side; ++y)
        column += tests::Luminance(trails.at(x, y)) - tests::Luminance(empty.at(x, y));
      if (column * pixel_rad * pixel_rad < 0.5 * of_star * pixel_rad / 0.0209) continue;
      first = std::min(first, x);
      last = std::max(last, x);
    }
    // 15.04 arcseconds a second, by the cosine of Sirius' declination, -16.7 degrees.
    EXPECT_NEAR((last - first + 1) * pixel_rad, 0.0209, 2.0 * pixel_rad) << side;
  }
}

TEST(NightPicture, TheMoonDrawsATrailOfItsLight) {
  const MoonPosition moon = MoonAt(PlaceFromDegrees(46.5, 8.0, 2.0), kFullMoon);
  Scene scene = BareScene(2.0, moon.azimuth_rad / kRadiansPerDegree,
                          moon.elevation_rad / kRadiansPerDegree, 8.0);
  const RenderSettings settings = Small(64, 64);
  const double pixel_rad = 2.0 * std::tan(4.0 * kRadiansPerDegree) / 64;
  const Image still = SceneRenderer(scene).Render(kFullMoon, settings);
  scene.camera.shutter_s = 600.0;
  const Image open = SceneRenderer(scene).Render(kFullMoon, settings);
  EXPECT_NEAR(Lux(open, pixel_rad) / Lux(still, pixel_rad), 1.0, 0.05) << "one ray a pixel";
  int left = 64, right = 0, top = 64, bottom = 0;
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      if (tests::Luminance(open.at(x, y)) < 10.0) continue;
      left = std::min(left, x);
      right = std::max(right, x);
      top = std::min(top, y);
      bottom = std::max(bottom, y);
    }
  }
  // From end to end but for the disk, half a degree.
  const double across = (right - left + 1) * 8.0 / 64 - 0.55;
  const double down = (bottom - top + 1) * 8.0 / 64 - 0.55;
  // 14.5 arcseconds a second by the cosine of its declination, 28 degrees, but for the dim ends.
  EXPECT_NEAR(std::hypot(across, down), 2.42 * 0.883, 0.25);
}

TEST(NightPicture, OrionStandsInTheSouthOfAJanuaryNight) {
  const Look sirius = SiriusAt(kMoonless);
  EXPECT_NEAR(sirius.azimuth, 172.0, 3.0) << "an hour before it culminates";
  const SceneRenderer renderer(BareScene(2.0, sirius.azimuth, sirius.elevation, 4.0));
  const Image image = renderer.Render(kMoonless, Small(41, 41));
  int x_of_brightest = 0, y_of_brightest = 0;
  for (int y = 0; y < 41; ++y) {
    for (int x = 0; x < 41; ++x) {
      if (image.at(x, y)[1] > image.at(x_of_brightest, y_of_brightest)[1]) {
        x_of_brightest = x;
        y_of_brightest = y;
      }
    }
  }
  EXPECT_EQ(x_of_brightest, 20);
  EXPECT_NEAR(y_of_brightest, 20, 1) << "refraction lifts it by two minutes of arc, a third of one";
}

TEST(NightPicture, AMoonlessNightIsAThousandthAndAFullMoonAQuarterOfALux) {
  const SceneRenderer renderer(BareScene(2.0, 0.0, 45.0, 60.0));
  EXPECT_NEAR(renderer.Illuminance(kMoonless), 1e-3, 0.4e-3);
  EXPECT_GT(renderer.Illuminance(kFullMoon), 0.2);
  EXPECT_LT(renderer.Illuminance(kFullMoon), 0.4) << "near its perigee, 65 degrees up";
}

TEST(NightPicture, TheMoonlitGroundIsThatOfItsLuxOnGrey) {
  Scene scene = BareScene(1000.0, 40.0, -80.0, 10.0);
  scene.medium.ground_albedo.assign(scene.medium.wavelengths_nm.size(), 0.2);
  const SceneRenderer renderer(scene);
  const Image ground = renderer.Render(kFullMoon, Small(4, 4));
  const double lambertian = 0.2 / kPi * renderer.Illuminance(kFullMoon);
  EXPECT_NEAR(tests::Luminance(ground.at(2, 2)) / lambertian, 1.0, 0.15)
      << "but for a kilometre of air before it";
}

TEST(NightPicture, AMoonlitSkyIsBlueButLessSoThanASunlitOne) {
  const SceneRenderer renderer(BareScene(2.0, 0.0, 60.0, 30.0));
  const auto blue_by_red = [&](const UtcInstant& instant, EffectSet without) {
    const auto rgb = renderer.Render(instant, Small(1, 1, Without(without))).at(0, 0);
    return static_cast<double>(rgb[2] / rgb[0]);
  };
  const double moonlit = blue_by_red(kFullMoon, {Effect::kStars, Effect::kNightSky});
  const double sunlit = blue_by_red(kNoon, {});
  EXPECT_GT(moonlit, 1.5);
  EXPECT_GT(sunlit / moonlit, 1.2) << "the moon reflects 1.4 times as much in the red";
  EXPECT_LT(sunlit / moonlit, 1.8);
}

TEST(NightPicture, ByDayNothingOfTheNightIsThere) {
  const SceneRenderer renderer(BareScene(2.0, 120.0, 20.0, 60.0));
  EffectBudget budget;
  const ChosenPicture day = renderer.RenderWithin(kNoon, Small(32, 18), budget);
  int found = 0;
  for (const EffectEstimate& estimate : day.choice.estimates) {
    if (!kOfNight.Has(estimate.effect)) continue;
    ++found;
    EXPECT_FALSE(estimate.present);
    EXPECT_EQ(estimate.cost_s, 0.0) << "never rendered, never asked for";
  }
  EXPECT_EQ(found, 3);
  EXPECT_EQ(renderer.Render(kNoon, Small(32, 18)).rgb,
            renderer.Render(kNoon, Small(32, 18, Without(kOfNight))).rgb);
}

TEST(NightPicture, DuskFallsWithoutAStepWhereTheMoonBegins) {
  const SceneRenderer renderer(BareScene(2.0, 120.0, 30.0, 60.0));
  double before = renderer.Illuminance(ParseInstant("2026-12-23T15:10:00Z"));
  for (int minute = 11; minute < 30; ++minute) {
    const double now =
        renderer.Illuminance(AddSeconds(ParseInstant("2026-12-23T15:00:00Z"), 60.0 * minute));
    EXPECT_LT(now, before) << minute;
    EXPECT_GT(now, 0.80 * before) << "no step, " << minute;
    before = now;
  }
}

}  // namespace
}  // namespace alpenglow::renderer
