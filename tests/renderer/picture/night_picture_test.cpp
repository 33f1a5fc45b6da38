// SPDX-License-Identifier: MIT
// Pictures of the night, of the moon, and of the eclipse of 2026 August 12 over Burgos.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "atmosphere/astronomy/moon.h"
#include "atmosphere/astronomy/night_sky.h"
#include "atmosphere/astronomy/sky_bodies.h"
#include "atmosphere/math/constants.h"
#include "renderer/picture/render.h"
#include "tests/fixtures/bare_scene.h"
#include "tests/fixtures/luminance.h"

namespace alpenglow::renderer {
namespace {

const UtcTime kMoonless = ParseInstant("2026-01-17T22:00:00Z");  // new moon: January 18, 19:52
const UtcTime kFullMoon = ParseInstant("2026-12-24T00:30:00Z");  // full: 01:28
const UtcTime kNoon = ParseInstant("2026-06-21T11:30:00Z");

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

/// Returns the illuminance by a picture of a narrow field [lx].
double Lux(const HdrImage& image, double pixel_rad) {
  const auto pixels = static_cast<double>(image.rgb.size());
  return tests::MeanLuminance(image) * pixels * pixel_rad * pixel_rad;
}

/// A direction as azimuth and elevation [degrees].
struct StarView {
  double azimuth, elevation;
};

/// Returns the direction of Sirius at the place of BareScene.
StarView SiriusAt(const UtcTime& instant) {
  const LocalFrame frame(kWgs84, Place{46.5, 8.0, 2.0});
  const glm::dvec3 enu = frame.EnuFromEcef(StarsAt(instant).front().direction).xyz;
  return {std::atan2(enu.x, enu.y) / kRadiansPerDegree, std::asin(enu.z) / kRadiansPerDegree};
}

TEST(NightPicture, AStarHasTheSameLuxAtEverySizeOfThePicture) {
  const StarView sirius = SiriusAt(kMoonless);
  ASSERT_GT(sirius.elevation, 20.0);
  const SceneRenderer renderer(QuickScene(2.0, sirius.azimuth, sirius.elevation + 0.1, 4.0));
  std::vector<double> lux;
  for (const int side : {24, 60, 111}) {
    const double pixel_rad = 2.0 * std::tan(2.0 * kRadiansPerDegree) / side;
    const double with = Lux(renderer.Render(kMoonless, Small(side, side)), pixel_rad);
    const double without =
        Lux(renderer.Render(kMoonless, Small(side, side, Without({Effect::kStars}))), pixel_rad);
    // With optical depths in V of 0.097 (molecules), 0.05 (dust) and 0.03 (ozone), 2.2 air masses
    // leave exp(-0.39) of 9.7e-6 lux above the air. Faint neighbours add a hundredth.
    EXPECT_NEAR((with - without) / 9.7e-6, 0.68, 0.02) << side;
    lux.push_back(with - without);
  }
  EXPECT_NEAR(lux[0] / lux[1], 1.0, 1e-3) << "the field's pixels are not quite of one size";
  EXPECT_NEAR(lux[2] / lux[1], 1.0, 1e-3);
}

TEST(NightPicture, TrailsHaveTheLuxOfTheirStarAndTheirLength) {
  const StarView sirius = SiriusAt(kMoonless);
  Scene scene = QuickScene(2.0, sirius.azimuth, sirius.elevation + 0.1, 4.0);
  const SceneRenderer still(scene);
  scene.camera.shutter_s = 300.0;
  const SceneRenderer open(scene);
  for (const int side : {24, 60}) {
    const double pixel_rad = 2.0 * std::tan(2.0 * kRadiansPerDegree) / side;
    const auto settings = Small(side, side), dark = Small(side, side, Without({Effect::kStars}));
    const HdrImage empty = open.Render(kMoonless, dark), trails = open.Render(kMoonless, settings);
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
    // The sky turns by 15.04 arcseconds a second, times the cosine of Sirius' declination, -16.7
    // degrees.
    EXPECT_NEAR((last - first + 1) * pixel_rad, 0.0209, 2.0 * pixel_rad) << side;
  }
}

TEST(NightPicture, TheMoonDrawsATrailOfItsLight) {
  const MoonPosition moon = TrueMoonAt(Place{46.5, 8.0, 2.0}, kFullMoon);
  Scene scene = QuickScene(2.0, moon.azimuth_deg, moon.elevation_deg, 8.0);
  const RenderSettings settings = Small(64, 64);
  const double pixel_rad = 2.0 * std::tan(4.0 * kRadiansPerDegree) / 64;
  const HdrImage still = SceneRenderer(scene).Render(kFullMoon, settings);
  scene.camera.shutter_s = 600.0;
  const HdrImage open = SceneRenderer(scene).Render(kFullMoon, settings);
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
  // The trail is measured from end to end, without the disk of half a degree.
  const double across = (right - left + 1) * 8.0 / 64 - 0.55;
  const double down = (bottom - top + 1) * 8.0 / 64 - 0.55;
  // The moon moves by 14.5 arcseconds a second, times the cosine of its declination, 28 degrees;
  // the ends of the trail are dim.
  EXPECT_NEAR(std::hypot(across, down), 2.42 * 0.883, 0.25);
}

TEST(NightPicture, OrionStandsInTheSouthOfAJanuaryNight) {
  const StarView sirius = SiriusAt(kMoonless);
  EXPECT_NEAR(sirius.azimuth, 172.0, 3.0) << "an hour before it culminates";
  const SceneRenderer renderer(QuickScene(2.0, sirius.azimuth, sirius.elevation, 4.0));
  const HdrImage image = renderer.Render(kMoonless, Small(41, 41));
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

TEST(NightPicture, MoonlessAndMoonlitNightsHaveTheirIlluminance) {
  const SceneRenderer renderer(QuickScene(2.0, 0.0, 45.0, 60.0));
  EXPECT_NEAR(renderer.Illuminance(kMoonless), 1e-3, 0.4e-3);
  EXPECT_GT(renderer.Illuminance(kFullMoon), 0.2);
  EXPECT_LT(renderer.Illuminance(kFullMoon), 0.4) << "near its perigee, 65 degrees up";
}

TEST(NightPicture, MoonlitGroundHasTheLuminanceOfItsLux) {
  Scene scene = QuickScene(1000.0, 40.0, -80.0, 10.0);
  scene.medium.ground_albedo.assign(scene.medium.wavelengths_nm.size(), 0.2);
  const SceneRenderer renderer(scene);
  const HdrImage ground = renderer.Render(kFullMoon, Small(4, 4));
  const double lambertian = 0.2 / kPi * renderer.Illuminance(kFullMoon);
  EXPECT_NEAR(tests::Luminance(ground.at(2, 2)) / lambertian, 1.0, 0.15)
      << "but for a kilometre of air before it";
}

TEST(NightPicture, AMoonlitSkyIsLessBlueThanASunlitOne) {
  const SceneRenderer renderer(QuickScene(2.0, 0.0, 60.0, 30.0));
  const auto blue_by_red = [&](const UtcTime& instant, EffectSet without) {
    const auto rgb = renderer.Render(instant, Small(1, 1, Without(without))).at(0, 0);
    return static_cast<double>(rgb[2] / rgb[0]);
  };
  const double moonlit = blue_by_red(kFullMoon, {Effect::kStars, Effect::kNightSky});
  const double sunlit = blue_by_red(kNoon, {});
  EXPECT_GT(moonlit, 1.5);
  EXPECT_GT(sunlit / moonlit, 1.2) << "the moon reflects 1.4 times as much in the red";
  EXPECT_LT(sunlit / moonlit, 1.8);
}

TEST(NightPicture, ByDayLightsOfTheNightAreAbsent) {
  const SceneRenderer renderer(QuickScene(2.0, 120.0, 20.0, 60.0));
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
  const SceneRenderer renderer(QuickScene(2.0, 120.0, 30.0, 60.0));
  double before = renderer.Illuminance(ParseInstant("2026-12-23T15:10:00Z"));
  for (int minute = 11; minute < 30; ++minute) {
    const double now =
        renderer.Illuminance(AddSeconds(ParseInstant("2026-12-23T15:00:00Z"), 60.0 * minute));
    EXPECT_LT(now, before) << minute;
    EXPECT_GT(now, 0.80 * before) << "no step, " << minute;
    before = now;
  }
}

/// Returns a small picture of the night sky around a direction.
HdrImage NightAround(double azimuth_rad, double elevation_rad, const UtcTime& instant) {
  const Scene scene =
      QuickScene(2.0, azimuth_rad / kRadiansPerDegree, elevation_rad / kRadiansPerDegree, 2.0);
  RenderSettings settings;
  settings.width = settings.height = 64;
  settings.samples_per_pixel = 1;
  return SceneRenderer(scene).Render(instant, settings);
}

/// The mean place and the number of pixels brighter than a hundredth of the brightest.
struct Bright {
  double x = 0.0, y = 0.0, luminance = 0.0;
  int count = 0;
};

Bright BrightOf(const HdrImage& image) {
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

/// Returns the moon at the place of BareScene.
MoonPosition MoonOver(const UtcTime& instant) {
  return ApparentMoonAt(Place{46.5, 8.0, 2.0}, instant, AlmanacAir());
}

TEST(MoonPicture, TheFullMoonHasItsPlaceAndBrightness) {
  // The moon is full on 2026 June 29 at 23:57 UT.
  const UtcTime instant = ParseInstant("2026-06-29T23:30:00Z");
  const MoonPosition moon = MoonOver(instant);
  ASSERT_GT(moon.elevation_rad(), 10.0 * kRadiansPerDegree);
  const Bright bright = BrightOf(NightAround(moon.azimuth_rad(), moon.elevation_rad(), instant));
  EXPECT_NEAR(bright.x, 32.0, 0.5) << "pixels of a thirty-second of a degree";
  EXPECT_NEAR(bright.y, 32.0, 0.5);
  const double radius_pixels =
      std::tan(moon.angular_radius_rad()) / std::tan(kRadiansPerDegree) * 32.0;
  EXPECT_NEAR(bright.count, kPi * radius_pixels * radius_pixels, 12.0);
  EXPECT_GT(bright.luminance, 1000.0) << "cd/m^2, through two to four masses of air";
  EXPECT_LT(bright.luminance, 5100.0);
}

TEST(MoonPicture, TheHalfMoonOfAnEveningIsLitOnItsRight) {
  // The first quarter is on 2026 June 21 at 21:55 UT.
  const UtcTime instant = ParseInstant("2026-06-21T20:30:00Z");
  const MoonPosition moon = MoonOver(instant);
  ASSERT_GT(moon.elevation_rad(), 5.0 * kRadiansPerDegree);
  const Bright bright = BrightOf(NightAround(moon.azimuth_rad(), moon.elevation_rad(), instant));
  EXPECT_GT(bright.x, 33.0) << "towards the sun that has set";
  EXPECT_GT(bright.y, 32.5) << "and below";
}

constexpr double kBurgosEye_m = 2.0;

Place Burgos() { return CheckedPlace({42.3439, -3.6969, kBurgosEye_m}); }

enum class Moon { kThere, kAbsent };

/// Returns the bare ellipsoid at Burgos; without its moon the planet has the same radius.
const SceneRenderer& OverBurgos(Moon moon) {
  const auto scene_of = [](Moon of) {
    Scene scene = QuickScene(kBurgosEye_m, 0.0, 0.0, 60.0);
    scene.place = {42.3439, -3.6969, 0.0};
    if (of == Moon::kThere) return scene;
    scene.medium.follows_wgs84 = false;
    scene.medium.planet_radius_m = OsculatingRadius(kWgs84, scene.place.latitude_rad());
    return scene;
  };
  static const SceneRenderer kWith(scene_of(Moon::kThere)), kWithout(scene_of(Moon::kAbsent));
  return moon == Moon::kThere ? kWith : kWithout;
}

/// Returns the view of a camera at Burgos; angles are in degrees.
CameraPose Towards(double heading, double pitch, double fov) {
  const Camera camera = CameraFromDegrees({}, heading, pitch, 0.0, fov);
  return {Burgos(), camera.heading_rad, camera.pitch_rad, 0.0, camera.fov_rad};
}

HdrImage EclipseRendered(const CameraPose& pose, const UtcTime& instant, int size, int rays,
                         Moon moon = Moon::kThere) {
  RenderSettings settings;
  settings.width = settings.height = size;
  settings.samples_per_pixel = rays;
  CameraSample sample(instant);
  sample.poses = {pose};
  return OverBurgos(moon).Render(sample, settings);
}

double Mean(const HdrImage& image, std::size_t channel) {
  double sum = 0.0;
  for (const auto& pixel : image.rgb) sum += static_cast<double>(pixel[channel]);
  return sum / static_cast<double>(image.rgb.size());
}

double Left(const UtcTime& instant, double wavelength_nm) {
  return UncoveredLight(EclipseAt(Burgos(), instant).disk, wavelength_nm);
}

/// Returns the view of a camera at Burgos that looks at the sun.
CameraPose TowardsSun(const UtcTime& instant, double fov) {
  const SunInSky sun = ApparentSunAt(Burgos(), instant);
  return Towards(sun.azimuth_deg, sun.elevation_deg, fov);
}

// Nine tenths of the sun are covered. Higher orders of scattering and the ground are included.
TEST(EclipsePicture, SkyIsDarkerByTheLightThatTheMoonCovers) {
  const UtcTime instant = ParseInstant("2026-08-12T18:23:00Z");
  const CameraPose pose = Towards(100.0, 10.0, 60.0);
  const HdrImage eclipsed = EclipseRendered(pose, instant, 24, 1);
  const HdrImage whole = EclipseRendered(pose, instant, 24, 1, Moon::kAbsent);
  const double green = Mean(eclipsed, 1) / Mean(whole, 1);
  EXPECT_NEAR(Left(instant, 550.0), 0.1, 0.02);
  EXPECT_NEAR(green / Left(instant, 550.0), 1.0, 0.01)
      << "the channel is as wide as the share changes by a few per cent";
  EXPECT_LT(Mean(eclipsed, 2) / Mean(whole, 2), green) << "the limb that is left is red";
  EXPECT_GT(Mean(eclipsed, 0) / Mean(whole, 0), green);
}

// The light of the disk in the picture is that on the land.
TEST(EclipsePicture, LightOfTheCrescentIsThatOfTheUncoveredSun) {
  for (const char* utc : {"2026-08-12T17:50:00Z", "2026-08-12T18:23:00Z"}) {
    const UtcTime instant = ParseInstant(utc);
    const CameraPose pose = TowardsSun(instant, 0.7);
    const double share = Mean(EclipseRendered(pose, instant, 64, 16), 1) /
                         Mean(EclipseRendered(pose, instant, 64, 16, Moon::kAbsent), 1);
    EXPECT_NEAR(share / Left(instant, 550.0), 1.0, 0.02)
        << utc << ": the air reddens the lower side of a low sun";
  }
}

TEST(EclipsePicture, TheCrescentFacesAwayFromTheMoon) {
  for (const char* utc : {"2026-08-12T17:50:00Z", "2026-08-12T18:10:00Z", "2026-08-12T18:40:00Z"}) {
    const UtcTime instant = ParseInstant(utc);
    const SunInSky sun = ApparentSunAt(Burgos(), instant);
    const MoonPosition moon = ApparentMoonAt(Burgos(), instant, AlmanacAir());
    const HdrImage image = EclipseRendered(TowardsSun(instant, 0.7), instant, 64, 4);
    double x = 0.0, y = 0.0;
    for (int row = 0; row < 64; ++row) {
      for (int column = 0; column < 64; ++column) {
        const auto light = static_cast<double>(image.at(column, row)[1]);
        x += light * (column + 0.5 - 32.0);
        y += light * (32.0 - row - 0.5);
      }
    }
    const double right = (moon.azimuth_rad() - sun.azimuth_rad()) * std::cos(sun.elevation_rad());
    const double up = moon.elevation_rad() - sun.elevation_rad();
    const double cosine = (x * right + y * up) / (std::hypot(x, y) * std::hypot(right, up));
    EXPECT_LT(cosine, -0.995) << utc << ": within 6 degrees of opposite";
  }
}

TEST(EclipsePicture, TotalityIsDarkAndFinite) {
  const UtcTime middle = ParseInstant("2026-08-12T18:29:40Z");
  ASSERT_EQ(Left(middle, 550.0), 0.0);
  const SunInSky sun = ApparentSunAt(Burgos(), middle);
  const CameraPose pose = Towards(sun.azimuth_deg, 20.0, 60.0);
  const HdrImage dark = EclipseRendered(pose, middle, 32, 2);
  for (const auto& pixel : dark.rgb) {
    for (const float value : pixel) {
      EXPECT_TRUE(std::isfinite(value));
      EXPECT_GE(value, 0.0F);
    }
  }
  const double before = Mean(EclipseRendered(pose, ParseInstant("2026-08-12T18:27:00Z"), 32, 2), 1);
  EXPECT_GT(Mean(dark, 1), 1e-7 * before) << "the corona and the stars";
  EXPECT_LT(Mean(dark, 1), 1e-3 * before);
}

TEST(EclipsePicture, IlluminanceFallsToThatOfTheCoronaAndRises) {
  const SceneRenderer& renderer = OverBurgos(Moon::kThere);
  const SolarEclipse eclipse =
      *FindSolarEclipse(Burgos(), ParseInstant("2026-08-12T12:00:00Z"), 43200.0);
  double before_lux = renderer.Illuminance(eclipse.first_contact.instant);
  const double whole_lux = before_lux;
  const double down_s = SecondsBetween(eclipse.first_contact.instant, eclipse.maximum.instant);
  for (int i = 1; i <= 40; ++i) {
    const double now_lux =
        renderer.Illuminance(AddSeconds(eclipse.first_contact.instant, down_s * i / 40.0));
    EXPECT_LT(now_lux, before_lux);
    before_lux = now_lux;
  }
  EXPECT_GT(before_lux, 1e-7 * whole_lux);
  EXPECT_LT(before_lux, 1e-5 * whole_lux);
  EXPECT_GT(renderer.Illuminance(AddSeconds(eclipse.maximum.instant, 120.0)), 100.0 * before_lux);
}

}  // namespace
}  // namespace alpenglow::renderer
