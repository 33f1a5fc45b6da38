// SPDX-License-Identifier: MIT
// Refraction in pictures, compared with the ray equation: places of sun, moon, stars and mountains,
// the shape of disks, and the light of a low sun.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "atmosphere/astronomy/moon.h"
#include "atmosphere/astronomy/night_sky.h"
#include "atmosphere/reference/reference_solution.h"
#include "atmosphere/refraction/refracted_view.h"
#include "atmosphere/refraction/refraction.h"
#include "renderer/illumination/night_light.h"
#include "renderer/picture/frame_context.h"
#include "renderer/picture/pixel_shader.h"
#include "renderer/picture/prepared_scene.h"
#include "renderer/picture/render.h"
#include "tests/fixtures/bare_scene.h"
#include "tests/fixtures/far_peak.h"
#include "tests/fixtures/luminance.h"
#include "tests/fixtures/refracted_twilight.h"
#include "tests/fixtures/temporary_folder.h"
#include "tests/renderer/picture/sun_seen.h"

namespace alpenglow::renderer {
namespace {

using tests::ElevationByEquation;
using tests::FarPeak;
using tests::SceneOf;
using RefractedTerrain = TemporaryFolder;

constexpr double kArcminute = kRadiansPerDegree / 60.0;
constexpr double kTolerance = 0.1 * kArcminute;
const UtcTime kRefractedNoon = ParseInstant("2026-06-21T11:30:00Z");

/// Returns the true elevation of a body that is seen at an apparent one.
double TrueElevation(const Medium& medium, double apparent_rad, double height_m) {
  const reference::RayEquation equation(medium, reference::PeckAndReeder(kHorizonWavelength_nm));
  return apparent_rad - equation.Follow(apparent_rad, height_m).refraction_rad;
}

TEST(RefractedPlaces, TheSunIsWhereTheRayEquationSays) {
  const SceneRenderer renderer(QuickScene(2.0, 0.0, 0.0, 60.0));
  for (const double height_m : {2.0, 3000.0}) {
    const Place eye = CheckedPlace({46.5, 8.0, height_m});
    int seen = 0;
    for (int minutes = 0; minutes < 60; minutes += 6) {
      const UtcTime instant = AddSeconds(ParseInstant("2026-06-21T18:26:00Z"), 60.0 * minutes);
      CameraSample camera_sample(instant);
      camera_sample.poses = {{eye, 0.0, 0.0, 0.0, 1.0}};
      const double apparent = renderer.ApparentSun(camera_sample).elevation_rad();
      if (apparent < RefractedView(renderer.medium(), height_m).horizon_rad() + kArcminute)
        continue;
      ++seen;
      EXPECT_NEAR(TrueElevation(renderer.medium(), apparent, height_m),
                  TrueSunAt(eye, instant).elevation_rad(), kTolerance)
          << height_m << " m, " << apparent / kRadiansPerDegree << " degrees";
    }
    EXPECT_GT(seen, 5);
  }
}

TEST(RefractedPlaces, StarsAreWhereTheRayEquationSays) {
  const Medium medium = OnOsculatingSphere(MediumPreset("earth"), 46.5 * kRadiansPerDegree);
  const UtcTime instant = ParseInstant("2026-01-15T22:00:00Z");
  const BandColour colour(medium.wavelengths_nm);
  constexpr double kFaintest = 4.5;
  for (const double height_m : {2.0, 3000.0}) {
    const Place eye = CheckedPlace({46.5, 8.0, height_m});
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
  Scene scene = QuickScene(2.0, 0.0, 0.0, 60.0);
  scene.medium = MediumPreset("mars");
  const UtcTime evening = ParseInstant("2026-06-21T19:15:00Z");
  const SunInSky sun = tests::SunSeenIn(scene, evening);
  EXPECT_NEAR(sun.elevation_rad(), TrueSunAt(Place{46.5, 8.0, 2.0}, evening).elevation_rad(),
              1.0 * kArcminute);
  EXPECT_LT(sun.lower_for_air_deg * kRadiansPerDegree, 1.0 * kArcminute)
      << "its light comes from where it is seen";
}

/// Returns the area of a disk in a picture relative to that of a circle as wide as the disk. Pixels
/// belong to the disk from a share of the brightest one on.
double AreaOfCircle(const HdrImage& image, int rows, double share_of_brightest) {
  double brightest = 0.0, area = 0.0;
  int left = image.width, right = 0;
  const auto visit = [&](const auto& see) {
    for (int y = 0; y < rows; ++y) {
      for (int x = 0; x < image.width; ++x) see(x, tests::Luminance(image.at(x, y)));
    }
  };
  visit([&](int, double luminance) { brightest = std::max(brightest, luminance); });
  visit([&](int x, double luminance) {
    if (luminance < share_of_brightest * brightest) return;
    left = std::min(left, x);
    right = std::max(right, x + 1);
    area += 1.0;
  });
  return area / (0.25 * kPi * (right - left) * (right - left));
}

/// Settings for the picture of a disk of half a degree.
RenderSettings DiskSettings(EffectSet effects) {
  return {.width = 72,
          .height = 72,
          .samples_per_pixel = 4,
          .filter = PixelFilter::Kind::kBox,
          .air_nodes = 4,
          .effects = effects,
          .layers = {}};
}

/// Expects a circle without refraction, and with refraction an ellipse of this height over width.
/// @param off_circle  by how much the area of the circle may be off: pixels at its edge count whole
void ExpectFlat(const std::function<double(EffectSet effects)>& area_of_circle, double flat,
                double off_circle) {
  EXPECT_NEAR(area_of_circle(EffectSet::All().Without(Effect::kRefraction)), 1.0, off_circle)
      << "pixels of a thirtieth of the disk";
  EXPECT_LT(flat, 0.93);
  EXPECT_NEAR(area_of_circle(EffectSet::All()), flat, 0.04)
      << "pixels, and a disk that is only nearly an ellipse";
}

TEST(RefractedPlaces, TheRisingMoonIsAsFlatAsTheRayEquationSays) {
  const Place eye{46.5, 8.0, 20.0};
  const UtcTime instant =
      AddSeconds(*NextMoonrise(eye, ParseInstant("2026-06-29T12:00:00Z")), 360.0);  // full
  const Medium medium = OnOsculatingSphere(MediumPreset("earth"), 46.5 * kRadiansPerDegree);
  const MoonPosition moon = ApparentMoonAt(eye, instant, GentleAirOf(medium));
  const SceneRenderer renderer(QuickScene(20.0, moon.azimuth_deg, moon.elevation_deg, 1.2));
  const auto truly = [&](double apparent) { return TrueElevation(medium, apparent, 20.0); };
  const double upper = moon.elevation_rad() + 0.85 * moon.angular_radius_rad();
  const double lower = moon.elevation_rad() - 0.85 * moon.angular_radius_rad();
  ASSERT_GT(lower, 0.0);
  ExpectFlat(
      [&](EffectSet effects) {
        for (const Effect effect : {Effect::kSky, Effect::kNightSky, Effect::kStars})
          effects = effects.Without(effect);  // the dusk would outshine the moon
        // The lowest quarter is the sea, in the light of dusk. The air dims the lower limb four
        // times as much as the upper one.
        return AreaOfCircle(renderer.Render(instant, DiskSettings(effects)), 3 * 72 / 4, 0.05);
      },
      (upper - lower) / (truly(upper) - truly(lower)), 0.04);
}

TEST(RefractedPlaces, TheDiskOfASettingSunIsFlat) {
  const UtcTime evening = ParseInstant("2026-06-21T19:20:30Z");
  Scene scene = QuickScene(20.0, 0.0, 0.0, 1.2);
  const SunInSky sun = tests::SunSeenIn(scene, evening);
  scene.camera = CameraFromDegrees({20.0, false}, sun.azimuth_deg, 0.3, 0.0, 1.2);
  const SceneRenderer renderer(scene);
  const RefractedView view(renderer.medium(), 20.0);
  const double middle = view.TrueElevation(sun.elevation_rad()), radius = sun.angular_radius_rad();
  ExpectFlat(
      [&](EffectSet effects) {
        return AreaOfCircle(renderer.Render(evening, DiskSettings(effects)), 72, 0.1);
      },
      (view.ApparentElevationOf(middle + radius) - view.ApparentElevationOf(middle - radius)) /
          (2.0 * radius),
      0.03);
}

// Hard case 20.
TEST(RefractedPlaces, TheSeaEndsAtTheHorizonOfStraightOrRefractedRays) {
  constexpr double kHeight_m = 10000.0;
  const Scene scene = QuickScene(kHeight_m, 0.0, -3.0, 2.0);
  const SceneRenderer renderer(scene);
  const CameraRays camera(scene.camera, 8, 400);
  const double radius = renderer.medium().planet_radius_m;
  for (const bool is_straight : {true, false}) {
    const EffectSet all = EffectSet::All();
    const HdrImage image = renderer.Render(
        kRefractedNoon, {.width = 8,
                         .height = 400,
                         .samples_per_pixel = 1,
                         .air_nodes = 8,
                         .effects = is_straight ? all.Without(Effect::kRefraction) : all,
                         .layers = {PictureLayer::kDepth}});
    const double horizon_rad = is_straight
                                   ? -std::acos(radius / (radius + kHeight_m))
                                   : RefractedView(renderer.medium(), kHeight_m).horizon_rad();
    for (int y = 0; y < 400; ++y) {
      const double elevation = std::asin(camera.Direction(4.5, y + 0.5).z);
      const float depth = image.layers[0].values[static_cast<std::size_t>(y) * 8 + 4];
      EXPECT_EQ(std::isinf(depth), elevation > horizon_rad) << "row " << y;
    }
  }
}

TEST_F(RefractedTerrain, HiddenPeaksAppearWhereTheRayEquationSays) {
  const Medium medium = OnOsculatingSphere(MediumPreset("earth"),
                                           QuickScene(0.0, 0.0, 0.0, 1.0).place.latitude_rad());
  const double radius_m = medium.planet_radius_m;
  for (const FarPeak& peak :
       {FarPeak{20.0, 110e3, 650.0}, FarPeak{20.0, 150e3, 1350.0}, FarPeak{3000.0, 300e3, 800.0}}) {
    const double horizon_m = radius_m * std::acos(radius_m / (radius_m + peak.eye_m));
    const double hides_m = radius_m / std::cos((peak.distance_m - horizon_m) / radius_m) - radius_m;
    ASSERT_GT(hides_m, peak.height_m) << "by straight rays it is hidden";
    const double expected = ElevationByEquation(medium, peak);
    const Scene scene = SceneOf(peak, expected / kRadiansPerDegree, 0.1, radius_m, folder_);
    const SceneRenderer renderer(scene);
    RenderSettings settings{.width = 60,
                            .height = 120,
                            .samples_per_pixel = 1,
                            .air_nodes = 4,
                            .effects = EffectSet::All(),
                            .layers = {PictureLayer::kDepth}};
    const CameraRays camera(scene.camera, settings.width, settings.height);
    const auto far_pixels = [&](const HdrImage& image) {
      std::vector<int> rows;
      for (int y = 0; y < settings.height; ++y) {
        const double depth_m =
            static_cast<double>(image.layers[0].values[static_cast<std::size_t>(y) * 60 + 30]);
        if (std::isfinite(depth_m) && depth_m > 0.9 * peak.distance_m) rows.push_back(y);
      }
      return rows;
    };
    const auto rows = far_pixels(renderer.Render(kRefractedNoon, settings));
    ASSERT_FALSE(rows.empty()) << "refraction shows it: " << peak.distance_m << " m";
    const double top = std::asin(camera.Direction(30.5, rows.front()).z);
    EXPECT_NEAR(top / kArcminute, expected / kArcminute, 0.15)
        << "0.1' of RefractedPath, and half a pixel";
    settings.effects = settings.effects.Without(Effect::kRefraction);
    EXPECT_TRUE(far_pixels(renderer.Render(kRefractedNoon, settings)).empty());
  }
}

TEST(RefractedPlaces, WideViewsAreRefractedForTheirSmallestPixels) {
  // The horizon is lifted by 12'; pixels have 4.5 degrees in the middle and 18' at the edges.
  const SceneRenderer renderer(QuickScene(10e3, 0.0, 0.0, 150.0));
  RenderSettings settings{
      .width = 96, .height = 24, .samples_per_pixel = 1, .air_nodes = 4, .layers = {}};
  const HdrImage bent = renderer.Render(kRefractedNoon, settings);
  settings.effects = settings.effects.Without(Effect::kRefraction);
  EXPECT_NE(bent.rgb, renderer.Render(kRefractedNoon, settings).rgb);
}

TEST_F(RefractedTerrain, ShiftsBelowHalfAPixelAreIgnored) {
  const FarPeak peak{20.0, 40e3, 1500.0};  // lifted by 1.2'
  const double radius_m = MediumPreset("earth").planet_radius_m;
  const SceneRenderer renderer(SceneOf(peak, 1.0, 6.0, radius_m, folder_));
  RenderSettings settings{
      .width = 64, .height = 36, .samples_per_pixel = 1, .air_nodes = 4, .layers = {}};
  const HdrImage bent = renderer.Render(kRefractedNoon, settings);
  settings.effects = settings.effects.Without(Effect::kRefraction);
  EXPECT_EQ(bent.rgb, renderer.Render(kRefractedNoon, settings).rgb) << "pixels of 5.6'";
}

/// Returns the height of the middle of an aureole above that of a square picture [rad]. The aureole
/// is light scattered once by haze alone; of two columns, one goes through the middle.
double MiddleOfAureole(const HdrImage& image, double pixel_rad) {
  const int middle = image.width / 2, aside = image.width / 8;
  // The ratio of radiances in both columns is that of the phase function; they are otherwise alike.
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

/// The air before the sea in the middle of a picture that looks below the horizon from space.
class AirFromSpace {
 public:
  explicit AirFromSpace(double height_m)
      : height_m_(height_m),
        scene_(Sea(height_m), static_cast<Progress*>(nullptr)),
        air_(GentleAirOf(scene_.medium())) {}

  [[nodiscard]] std::size_t last_band() const { return scene_.medium().wavelengths_nm.size() - 1; }
  [[nodiscard]] double horizon_rad() const { return GrazingElevation(air_, height_m_); }
  /// Returns the optical depth in a band, in the middle of a picture with a field of view.
  [[nodiscard]] double Depth(double elevation_rad, double fov, std::size_t band) const {
    CameraSample camera_sample(kRefractedNoon);
    camera_sample.poses = {
        {CheckedPlace({46.5, 8.0, height_m_}), 0.0, elevation_rad, 0.0, fov * kRadiansPerDegree}};
    const FrameContext frame(scene_, camera_sample, {.width = 65, .height = 37, .layers = {}});
    const PixelShader shader(frame);
    const CameraRay ray = frame.camera().MiddleRay(32.5, 18.5);
    SharedSegmentAir air = SharedSegmentAir::Of(shader.Trace(ray), ray.through, frame);
    EXPECT_EQ(air.kind, HitKind::kPlanet);
    AddAir(frame, air);
    return -std::log(static_cast<double>(air.air.transmittance[band]));
  }
  /// Returns the optical depth along the refracted ray.
  [[nodiscard]] double DepthOfRay(double elevation_rad, std::size_t band) const {
    const Medium& medium = scene_.medium();
    const double at_sea_rad = RefractedRay(air_, elevation_rad, height_m_).ElevationAt(0.0);
    const auto to_space = [&](double from_rad, double from_m) {
      return RefractedRay(air_, from_rad, from_m).ColumnToSpace([&](double height_m) {
        return medium.rayleigh_scattering_per_m[band] * MoleculeDensity(medium, height_m) +
               medium.mie_extinction_per_m[band] * std::exp(-height_m / medium.mie_scale_height_m);
      });
    };
    return to_space(at_sea_rad, 0.0) - to_space(-elevation_rad, height_m_);
  }

 private:
  static Scene Sea(double height_m) {
    Scene scene = QuickScene(height_m, 0.0, -20.0, 10.0);
    for (double& ozone : scene.medium.ozone_absorption_per_m) ozone = 0.0;
    return scene;
  }

  double height_m_;
  PreparedScene scene_;
  BendingAir air_;
};

TEST(RefractedAir, InFrontOfTheSeaHasTheColumnsOfTheRefractedRay) {
  for (const double height_m :
       tests::ScaledDown<std::vector<double>>({3e3, 10e3, 400e3, 36e6}, {400e3})) {
    const AirFromSpace seen(height_m);
    for (const double below : {0.02, 0.1, 0.4}) {
      const double elevation_rad = seen.horizon_rad() - below * kRadiansPerDegree;
      for (const std::size_t band : {0UL, seen.last_band()}) {
        EXPECT_NEAR(seen.Depth(elevation_rad, 1.0, band) / seen.DepthOfRay(elevation_rad, band),
                    1.0, height_m < 10e3 ? 0.04 : 0.03)
            << height_m << " m, " << below << " degrees below the horizon";
      }
    }
  }
}

TEST(RefractedAir, InFrontOfTheSeaDoesNotDependOnTheFieldOfView) {
  const AirFromSpace seen(400e3);
  const double elevation_rad = seen.horizon_rad() - 0.4 * kRadiansPerDegree;
  const double depth = seen.Depth(elevation_rad, 1.0, 0);
  for (const double fov : {0.1, 3.0, 4.0, 6.0, 60.0})
    EXPECT_NEAR(seen.Depth(elevation_rad, fov, 0) / depth, 1.0, 2e-3) << fov << " degrees";
}

TEST(TwilightAir, TheAureoleSurroundsTheVisibleDisk) {
  constexpr double kFov_deg = 5.0;
  const UtcTime evening = ParseInstant("2026-06-21T19:12:00Z");
  const SunInSky sun = tests::SunSeenIn(QuickScene(20.0, 0.0, 0.0, kFov_deg), evening);
  EXPECT_GT(sun.lower_for_air_deg * kRadiansPerDegree, 15.0 * kArcminute)
      << "another sun lights the air";
  const SceneRenderer renderer(QuickScene(20.0, sun.azimuth_deg, sun.elevation_deg, kFov_deg));
  RenderSettings settings{.width = 81,
                          .height = 81,
                          .samples_per_pixel = 4,
                          .filter = PixelFilter::Kind::kBox,
                          .layers = {}};
  for (const Effect effect : {Effect::kMultipleScattering, Effect::kMolecules, Effect::kNightSky})
    settings.effects = settings.effects.Without(effect);
  const HdrImage image = renderer.Render(evening, settings);
  EXPECT_NEAR(MiddleOfAureole(image, kFov_deg * kRadiansPerDegree / settings.width), 0.0,
              0.1 * kArcminute)
      << "rays of a pixel fall on different places of it";
}

/// Returns the luminance of the sky 30 degrees above the north at an instant.
double SkyAt(const SceneRenderer& renderer, const UtcTime& instant) {
  const RenderSettings settings{.width = 1, .height = 1, .samples_per_pixel = 1, .layers = {}};
  return tests::Luminance(renderer.Render(instant, settings).at(0, 0));
}

TEST(TwilightAir, DarkensWithoutAStepWhileTheSunSets) {
  const SceneRenderer renderer(QuickScene(20.0, 0.0, 30.0, 1.0));
  // The sun moves from 1 degree above the horizon to 4 below. Its direct light ends at 34', its
  // effect on the air at 3.5 degrees.
  const UtcTime begin = ParseInstant("2026-06-21T19:11:00Z");
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
  const SceneRenderer renderer(QuickScene(2.0, 0.0, -90.0, 1.0));
  const Medium& medium = renderer.medium();
  const BandColour colour(medium.wavelengths_nm);
  const tests::RefractedTwilight rays(medium);
  RenderSettings settings{.width = 1, .height = 1, .samples_per_pixel = 16, .layers = {}};
  settings.effects = settings.effects.Without(Effect::kSkylight).Without(Effect::kNightSky);
  for (const char* time :
       {"2026-06-21T18:30:00Z", "2026-06-21T19:00:00Z", "2026-06-21T19:12:00Z"}) {
    const UtcTime evening = ParseInstant(time);
    const SunInSky sun = renderer.ApparentSun(evening);
    std::vector<double> sent = rays.Beam(sun.elevation_rad(), 0.0);
    for (std::size_t band = 0; band < sent.size(); ++band)
      sent[band] *= medium.solar_irradiance[band] / (sun.distance_au * sun.distance_au) *
                    std::sin(sun.elevation_rad()) * medium.ground_albedo[band] / kPi;
    EXPECT_NEAR(tests::Luminance(renderer.Render(evening, settings).at(0, 0)) / colour.Xyz(sent)[1],
                1.0, 0.03)
        << "RefractedBeam is within 2 %; 16 places of the disk stand for it; at "
        << sun.elevation_deg << " degrees";
  }
}

}  // namespace
}  // namespace alpenglow::renderer
