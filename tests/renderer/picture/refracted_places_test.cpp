// SPDX-License-Identifier: MIT
// Sun, moon and stars stand where the air of the picture lifts them: against the ray equation.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "atmosphere/astronomy/moon.h"
#include "atmosphere/astronomy/night_sky.h"
#include "atmosphere/reference/reference_solution.h"
#include "atmosphere/refraction/refracted_view.h"
#include "renderer/illumination/night_light.h"
#include "renderer/picture/render.h"
#include "tests/fixtures/bare_scene.h"
#include "tests/fixtures/luminance.h"

namespace alpenglow::renderer {
namespace {

constexpr double kArcminute = kRadiansPerDegree / 60.0;
constexpr double kTolerance = 0.1 * kArcminute;

/// Where what is seen at an apparent elevation truly stands.
double TrueElevation(const Medium& medium, double apparent_rad, double height_m) {
  const reference::RayEquation equation(medium, reference::PeckAndReeder(kHorizonWavelength_nm));
  return apparent_rad - equation.Follow(apparent_rad, height_m).refraction_rad;
}

TEST(RefractedPlaces, TheSunIsWhereTheRayEquationOfThePicturesAirHasIt) {
  for (const double height_m : {2.0, 3000.0}) {
    const SceneRenderer renderer(BareScene(height_m, 0.0, 0.0, 60.0));
    const GeodeticPosition eye = PlaceFromDegrees(46.5, 8.0, height_m);
    int seen = 0;
    for (int minutes = 0; minutes < 60; minutes += 6) {
      const UtcInstant instant = AddSeconds(ParseInstant("2026-06-21T18:26:00Z"), 60.0 * minutes);
      const double apparent = renderer.ApparentSun(instant).elevation_rad;
      if (apparent < RefractedView(renderer.medium(), height_m).horizon_rad() + kArcminute)
        continue;
      ++seen;
      EXPECT_NEAR(TrueElevation(renderer.medium(), apparent, height_m),
                  SunAt(eye, instant).elevation_rad, kTolerance)
          << height_m << " m, " << apparent / kRadiansPerDegree << " degrees";
    }
    EXPECT_GT(seen, 5);
  }
}

TEST(RefractedPlaces, StarsAreWhereTheRayEquationOfThePicturesAirHasThem) {
  const Medium medium = OnOsculatingSphere(MediumPreset("earth"), 46.5 * kRadiansPerDegree);
  const UtcInstant instant = ParseInstant("2026-01-15T22:00:00Z");
  const BandColour colour(medium.wavelengths_nm);
  constexpr double kFaintest = 4.5;
  for (const double height_m : {2.0, 3000.0}) {
    const GeodeticPosition eye = PlaceFromDegrees(46.5, 8.0, height_m);
    const RefractedView view(medium, height_m);
    const LocalFrame local(kWgs84, eye);
    const auto stars = StarsAt(instant, kFaintest);
    auto lights = StarLightsOver(eye, instant, view, colour, kFaintest);
    lights.erase(lights.begin(), lights.end() - static_cast<std::ptrdiff_t>(stars.size()));
    int low = 0;
    for (std::size_t i = 0; i < stars.size(); ++i) {
      const double truly = std::asin(local.EnuFromEcef(stars[i].direction).xyz.z);
      const double seen = std::asin(lights[i].direction.z);
      if (truly < view.TrueElevation(view.horizon_rad())) {
        EXPECT_LE(seen, view.horizon_rad()) << "what the earth hides does not come up";
      } else if (seen > view.horizon_rad() + 0.5 * kArcminute && seen < 0.5) {
        low += seen < 0.05 ? 1 : 0;
        EXPECT_NEAR(TrueElevation(medium, seen, height_m), truly, kTolerance);
      }
    }
    EXPECT_GT(low, 5);
  }
}

TEST(RefractedPlaces, OnMarsAlmostNothingIsLifted) {
  Scene scene = BareScene(2.0, 0.0, 0.0, 60.0);
  scene.medium = MediumPreset("mars");
  const SceneRenderer renderer(scene);
  const UtcInstant evening = ParseInstant("2026-06-21T19:15:00Z");
  EXPECT_NEAR(renderer.ApparentSun(evening).elevation_rad,
              SunAt(PlaceFromDegrees(46.5, 8.0, 2.0), evening).elevation_rad, 1.0 * kArcminute);
}

TEST(RefractedPlaces, TheRisingMoonIsAsFlatAsTheRayEquationHasIt) {
  const GeodeticPosition eye = PlaceFromDegrees(46.5, 8.0, 20.0);
  const UtcInstant instant =
      AddSeconds(*NextMoonrise(eye, ParseInstant("2026-06-29T12:00:00Z")), 360.0);  // full
  const Medium medium = SceneRenderer(BareScene(20.0, 0.0, 0.0, 1.2)).medium();
  const MoonPosition moon = ApparentMoonAt(eye, instant, GentleAirOf(medium));
  Scene scene = BareScene(20.0, moon.azimuth_rad / kRadiansPerDegree,
                          moon.elevation_rad / kRadiansPerDegree, 1.2);
  const SceneRenderer renderer(scene);
  RenderSettings settings{.width = 72,
                          .height = 72,
                          .samples_per_pixel = 4,
                          .filter = PixelFilter::Kind::kBox,
                          .air_nodes = 4,
                          .layers = {}};
  const auto area_of_circle = [&](EffectSet effects) {
    for (const Effect effect : {Effect::kSky, Effect::kNightSky, Effect::kStars})
      effects = effects.Without(effect);  // the dusk would outshine it
    settings.effects = effects;
    const Image image = renderer.Render(instant, settings);
    const int rows = 3 * settings.height / 4;  // under them is the sea, in the light of dusk
    double brightest = 0.0, area = 0.0;
    int left = settings.width, right = 0;
    const auto visit = [&](const auto& see) {
      for (int y = 0; y < rows; ++y) {
        for (int x = 0; x < settings.width; ++x) see(x, tests::Luminance(image.at(x, y)));
      }
    };
    visit([&](int, double luminance) { brightest = std::max(brightest, luminance); });
    visit([&](int x, double luminance) {
      if (luminance < 0.05 * brightest) return;  // the air dims the lower limb four times more
      left = std::min(left, x);
      right = std::max(right, x + 1);
      area += 1.0;
    });
    return area / (0.25 * kPi * (right - left) * (right - left));
  };
  const double radius = moon.angular_radius_rad;
  const auto truly = [&](double apparent) { return TrueElevation(medium, apparent, 20.0); };
  const double upper = moon.elevation_rad + 0.85 * radius;
  const double lower = moon.elevation_rad - 0.85 * radius;
  ASSERT_GT(lower, 0.0);
  const double flat = (upper - lower) / (truly(upper) - truly(lower));
  EXPECT_NEAR(area_of_circle(EffectSet::All().Without(Effect::kRefraction)), 1.0, 0.04)
      << "pixels of a thirtieth of the disk";
  EXPECT_LT(flat, 0.93);
  EXPECT_NEAR(area_of_circle(EffectSet::All()), flat, 0.04)
      << "pixels, and a disk that is an ellipse only nearly";
}

}  // namespace
}  // namespace alpenglow::renderer
