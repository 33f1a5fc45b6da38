// SPDX-License-Identifier: MIT
// Light of a low sun: in the air by straight rays of a lower one, about the disk that is seen; on the
// ground by bent rays.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "atmosphere/refraction/refraction.h"
#include "renderer/picture/render.h"
#include "tests/fixtures/bare_scene.h"
#include "tests/fixtures/luminance.h"
#include "tests/fixtures/refracted_twilight.h"

namespace alpenglow::renderer {
namespace {

constexpr double kMinuteOfArc = kRadiansPerDegree / 60.0;

/// By how much the middle of an aureole is higher than the middle of a square picture [rad]: of light
/// scattered once by haze alone, in two columns of which one goes through the middle.
double MiddleOfAureole(const Image& image, double pixel_rad) {
  const int middle = image.width / 2, aside = image.width / 8;
  // Radiance through the middle over that aside: the phase function alone, where else they are alike.
  const auto contrast = [&](int up) {
    const int row = middle - up;
    return std::log(tests::Luminance(image.at(middle, row)) /
                    tests::Luminance(image.at(aside, row)));
  };
  const int near = image.height / 10, far = image.height / 6;  // beyond the disk
  const double slope =
      0.5 * (contrast(near) + contrast(-near) - contrast(far) - contrast(-far)) / (far - near);
  const double lower = 0.5 * (contrast(near) + contrast(far)),
               higher = 0.5 * (contrast(-near) + contrast(-far));
  return 0.5 * (lower - higher) / slope * pixel_rad;
}

TEST(TwilightAir, TheAureoleIsAboutTheDiskThatIsSeen) {
  constexpr double kFov_deg = 5.0;
  const UtcInstant evening = ParseInstant("2026-06-21T19:12:00Z");
  const SunPosition sun = SceneRenderer(BareScene(20.0, 0.0, 0.0, kFov_deg)).ApparentSun(evening);
  EXPECT_GT(sun.lower_for_air_rad, 15.0 * kMinuteOfArc) << "another sun lights the air";
  const SceneRenderer renderer(BareScene(20.0, sun.azimuth_rad / kRadiansPerDegree,
                                         sun.elevation_rad / kRadiansPerDegree, kFov_deg));
  RenderSettings settings{.width = 81,
                          .height = 81,
                          .samples_per_pixel = 4,
                          .filter = PixelFilter::Kind::kBox,
                          .layers = {}};
  for (const Effect effect : {Effect::kMultipleScattering, Effect::kMolecules, Effect::kNightSky})
    settings.effects = settings.effects.Without(effect);
  const Image image = renderer.Render(evening, settings);
  EXPECT_NEAR(MiddleOfAureole(image, kFov_deg * kRadiansPerDegree / settings.width), 0.0,
              0.1 * kMinuteOfArc)
      << "rays of a pixel fall on different places of it";
}

TEST(TwilightAir, OnMarsItIsLitFromWhereTheSunIsSeen) {
  Scene scene = BareScene(2.0, 0.0, 0.0, 60.0);
  scene.medium = MediumPreset("mars");
  EXPECT_LT(
      SceneRenderer(scene).ApparentSun(ParseInstant("2026-06-21T19:15:00Z")).lower_for_air_rad,
      1.0 * kMinuteOfArc);
}

/// Luminance of the sky 30 degrees over the north at an instant.
double SkyAt(const SceneRenderer& renderer, const UtcInstant& instant) {
  const RenderSettings settings{.width = 1, .height = 1, .samples_per_pixel = 1, .layers = {}};
  return tests::Luminance(renderer.Render(instant, settings).at(0, 0));
}

TEST(TwilightAir, DarkensWithoutAStepWhileTheSunSets) {
  const SceneRenderer renderer(BareScene(20.0, 0.0, 30.0, 1.0));
  // From 1 degree over the horizon to 4 under it. What is seen of the sun fades at 34' and at 3.5 degrees.
  const UtcInstant begin = ParseInstant("2026-06-21T19:11:00Z");
  std::array<double, 37> fall{};
  double last = std::log(SkyAt(renderer, begin));
  for (std::size_t i = 0; i < fall.size(); ++i) {
    const double now =
        std::log(SkyAt(renderer, AddSeconds(begin, 60.0 * static_cast<double>(i + 1))));
    fall[i] = last - now;
    last = now;
  }
  for (std::size_t i = 1; i < fall.size(); ++i) {
    EXPECT_GT(fall[i], 0.0) << i;
    EXPECT_NEAR(fall[i], fall[i - 1], 0.02)
        << i << ": a step of a minute is at most a fiftieth of the light";
  }
}

TEST(LowSun, LightsLevelGroundByItsRefractedBeam) {
  const SceneRenderer renderer(BareScene(2.0, 0.0, -90.0, 1.0));
  const Medium& medium = renderer.medium();
  const BandColour colour(medium.wavelengths_nm);
  const tests::RefractedTwilight rays(medium);
  RenderSettings settings{.width = 1, .height = 1, .samples_per_pixel = 16, .layers = {}};
  settings.effects = settings.effects.Without(Effect::kSkylight).Without(Effect::kNightSky);
  for (const char* time :
       {"2026-06-21T18:30:00Z", "2026-06-21T19:00:00Z", "2026-06-21T19:12:00Z"}) {
    const UtcInstant evening = ParseInstant(time);
    const SunPosition sun = renderer.ApparentSun(evening);
    std::vector<double> sent = rays.Beam(sun.elevation_rad, 0.0);
    for (std::size_t band = 0; band < sent.size(); ++band)
      sent[band] *= medium.solar_irradiance[band] / (sun.distance_au * sun.distance_au) *
                    std::sin(sun.elevation_rad) * medium.ground_albedo[band] / kPi;
    EXPECT_NEAR(tests::Luminance(renderer.Render(evening, settings).at(0, 0)) / colour.Xyz(sent)[1],
                1.0, 0.03)
        << "RefractedBeam is within 2 %; 16 places of the disk stand for it; at "
        << sun.elevation_rad / kRadiansPerDegree << " degrees";
  }
}

}  // namespace
}  // namespace alpenglow::renderer
