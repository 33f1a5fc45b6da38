// SPDX-License-Identifier: MIT
// The eclipse of 2026 August 12 over Burgos in the renderer's pictures.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/astronomy/eclipse.h"
#include "atmosphere/math/constants.h"
#include "renderer/picture/render.h"
#include "tests/fixtures/bare_scene.h"

namespace alpenglow::renderer {
namespace {

constexpr double kEye_m = 2.0;

GeodeticPosition Burgos() { return PlaceFromDegrees(42.3439, -3.6969, kEye_m); }

/// Looking so, in degrees, over the bare ellipsoid.
Scene SceneTowards(double heading, double pitch, double fov) {
  Scene scene = BareScene(kEye_m, heading, pitch, fov);
  scene.place = PlaceFromDegrees(42.3439, -3.6969, 0.0);
  return scene;
}

/// The same planet without its moon.
Scene Moonless(Scene scene) {
  scene.medium.follows_wgs84 = false;
  scene.medium.planet_radius_m = OsculatingRadius(kWgs84, scene.place.latitude_rad);
  return scene;
}

Image Rendered(const Scene& scene, const UtcInstant& instant, int size, int rays) {
  RenderSettings settings;
  settings.width = settings.height = size;
  settings.samples_per_pixel = rays;
  return SceneRenderer(scene).Render(instant, settings);
}

double Mean(const Image& image, std::size_t channel) {
  double sum = 0.0;
  for (const auto& pixel : image.rgb) sum += static_cast<double>(pixel[channel]);
  return sum / static_cast<double>(image.rgb.size());
}

double Left(const UtcInstant& instant, double wavelength_nm) {
  return UncoveredLight(EclipseAt(Burgos(), instant).disk, wavelength_nm);
}

// Nine tenths covered, all higher orders of scattering and the ground included.
TEST(EclipsePicture, SkyIsDarkerByTheLightThatTheMoonCovers) {
  const UtcInstant instant = ParseInstant("2026-08-12T18:23:00Z");
  const Scene scene = SceneTowards(100.0, 10.0, 60.0);
  const Image eclipsed = Rendered(scene, instant, 24, 1);
  const Image whole = Rendered(Moonless(scene), instant, 24, 1);
  const double green = Mean(eclipsed, 1) / Mean(whole, 1);
  EXPECT_NEAR(Left(instant, 550.0), 0.1, 0.02);
  EXPECT_NEAR(green / Left(instant, 550.0), 1.0, 0.01)
      << "the channel is as wide as the share changes by a few per cent";
  EXPECT_LT(Mean(eclipsed, 2) / Mean(whole, 2), green) << "the limb that is left is red";
  EXPECT_GT(Mean(eclipsed, 0) / Mean(whole, 0), green);
}

// What the camera collects of the disk is what lights the land.
TEST(EclipsePicture, LightOfTheCrescentIsWhatIsLeftOfTheSun) {
  for (const char* utc : {"2026-08-12T17:50:00Z", "2026-08-12T18:10:00Z", "2026-08-12T18:23:00Z"}) {
    const UtcInstant instant = ParseInstant(utc);
    const SunPosition sun = ApparentSunAt(Burgos(), instant);
    const Scene scene = SceneTowards(sun.azimuth_rad / kRadiansPerDegree,
                                     sun.elevation_rad / kRadiansPerDegree, 0.7);
    const double share = Mean(Rendered(scene, instant, 96, 16), 1) /
                         Mean(Rendered(Moonless(scene), instant, 96, 16), 1);
    EXPECT_NEAR(share / Left(instant, 550.0), 1.0, 0.02)
        << utc << ": the air reddens the lower side of a low sun";
  }
}

TEST(EclipsePicture, TheCrescentTurnsItsBackToTheMoon) {
  for (const char* utc : {"2026-08-12T17:50:00Z", "2026-08-12T18:10:00Z", "2026-08-12T18:40:00Z"}) {
    const UtcInstant instant = ParseInstant(utc);
    const SunPosition sun = ApparentSunAt(Burgos(), instant);
    const MoonPosition moon = ApparentMoonAt(Burgos(), instant);
    const Image image = Rendered(SceneTowards(sun.azimuth_rad / kRadiansPerDegree,
                                              sun.elevation_rad / kRadiansPerDegree, 0.7),
                                 instant, 64, 4);
    double x = 0.0, y = 0.0;
    for (int row = 0; row < 64; ++row) {
      for (int column = 0; column < 64; ++column) {
        const auto light = static_cast<double>(image.at(column, row)[1]);
        x += light * (column + 0.5 - 32.0);
        y += light * (32.0 - row - 0.5);
      }
    }
    const double right = (moon.azimuth_rad - sun.azimuth_rad) * std::cos(sun.elevation_rad);
    const double up = moon.elevation_rad - sun.elevation_rad;
    const double cosine = (x * right + y * up) / (std::hypot(x, y) * std::hypot(right, up));
    EXPECT_LT(cosine, -0.995) << utc << ": within 6 degrees of opposite";
  }
}

TEST(EclipsePicture, TotalityIsDarkAndFiniteAndOneMinuteAsideItIsDay) {
  const UtcInstant middle = ParseInstant("2026-08-12T18:29:40Z");
  ASSERT_EQ(Left(middle, 550.0), 0.0);
  const SunPosition sun = ApparentSunAt(Burgos(), middle);
  const Scene scene = SceneTowards(sun.azimuth_rad / kRadiansPerDegree, 20.0, 60.0);
  const Image dark = Rendered(scene, middle, 32, 2);
  for (const auto& pixel : dark.rgb) {
    for (const float value : pixel) {
      EXPECT_TRUE(std::isfinite(value));
      EXPECT_GE(value, 0.0F);
    }
  }
  const double before = Mean(Rendered(scene, ParseInstant("2026-08-12T18:27:00Z"), 32, 2), 1);
  EXPECT_GT(Mean(dark, 1), 1e-7 * before) << "the corona and the stars";
  EXPECT_LT(Mean(dark, 1), 1e-3 * before);
}

TEST(EclipsePicture, IlluminanceFallsToTheCoronasAndRisesAgain) {
  const SceneRenderer renderer(SceneTowards(280.0, 10.0, 60.0));
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
