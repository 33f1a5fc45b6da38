// SPDX-License-Identifier: MIT
#include "renderer/picture/render.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "atmosphere/base/error.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/reference/reference_solution.h"
#include "atmosphere/refraction/refracted_view.h"
#include "lut/image/eye.h"
#include "lut/multiple_scattering/multiple_scattering.h"
#include "renderer/camera/camera_rays.h"
#include "tests/fixtures/bare_scene.h"
#include "tests/fixtures/luminance.h"
#include "tests/fixtures/places.h"
#include "tests/fixtures/thread_counts.h"

namespace alpenglow::renderer {
namespace {

const RenderSettings kSmall{
    .width = 16, .height = 9, .samples_per_pixel = 1, .air_nodes = 16, .layers = {}};

using tests::Luminance;

TEST(Render, SkyPixelIsSingleScatteringOfTheReferencePlusMultipleScattering) {
  const SceneRenderer renderer(BareScene(1000.0, 180.0, 20.0, 40.0));
  const UtcInstant noon = ParseInstant("2026-06-21T10:00:00Z");
  const Image image = renderer.Render(noon, kSmall);
  const SunPosition sun = renderer.ApparentSun(noon);
  const Medium& medium = renderer.medium();
  const MultipleScattering multiple_scattering(medium);
  const SingleScattering<float> air(medium);
  const BandColour colour(medium.wavelengths_nm);
  const CameraRays camera(CameraFromDegrees({1000.0, false}, 180.0, 20.0, 0.0, 40.0), 16, 9);
  const glm::dvec3 to_sun = DirectionFromAngles(sun.elevation_rad, sun.azimuth_rad).xyz;
  for (const int x : {0, 8, 15}) {
    const glm::dvec3 d = camera.Direction(x + 0.5, 4.5);
    const ViewRay ray{1000.0, d.z, to_sun.z, d.x * to_sun.x + d.y * to_sun.y + d.z * to_sun.z};
    const auto once = reference::SingleScatteringAlong(medium, ray);
    const auto more = multiple_scattering.InscatterAlong(
        air.Sample(ray, {.nodes = 16, .dark_samples = true}), ray.nu);
    std::vector<double> radiance;
    for (std::size_t band = 0; band < medium.wavelengths_nm.size(); ++band) {
      radiance.push_back((once.inscatter[band] + static_cast<double>(more[band])) *
                         medium.solar_irradiance[band] / (sun.distance_au * sun.distance_au));
    }
    const auto expected = colour.LinearSrgb(radiance);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(static_cast<double>(image.at(x, 4)[c]) / expected[c], 1.0, 2e-3)
          << "12 to 16 nodes without a split at the ozone tent: 1e-3";
    }
  }
}

TEST(Render, NoonSkyHasThePublishedOrderOfLuminance) {
  // Clear zenith skies at high sun: 1e3 to 1e4 cd/m^2.
  const SceneRenderer renderer(BareScene(500.0, 0.0, 60.0, 20.0));
  const Image image = renderer.Render(ParseInstant("2026-06-21T11:30:00Z"), kSmall);
  EXPECT_GT(Luminance(image.at(8, 4)), 1e3);
  EXPECT_LT(Luminance(image.at(8, 4)), 1e4);
  EXPECT_GT(image.at(8, 4)[2], image.at(8, 4)[0]) << "the sky is blue";
}

// Hard case 23.
TEST(Render, NightIsNeverNegativeAndNeverNaN) {
  const SceneRenderer renderer(BareScene(2.0, 0.0, 10.0, 360.0));
  for (const char* time :
       {"2026-01-01T00:00:00Z", "2026-01-01T05:00:00Z", "2026-01-01T06:00:00Z"}) {
    for (const auto& rgb : renderer.Render(ParseInstant(time), kSmall).rgb) {
      for (const float value : rgb) EXPECT_TRUE(std::isfinite(value));
      EXPECT_GE(Luminance(rgb), 0.0);
    }
  }
}

// Hard case 43.
TEST(Render, TheSameBytesForAnyNumberOfThreads) {
  const SceneRenderer renderer(BareScene(2.0, 120.0, 5.0, 60.0));
  const UtcInstant dawn = ParseInstant("2026-06-21T03:40:00Z");
  static_cast<void>(
      tests::SameForAnyNumberOfThreads([&] { return renderer.Render(dawn, kSmall); }));
}

/// The camera of a bare scene somewhere else.
CameraPose PoseAt(double latitude, double longitude, double height_m, double heading,
                  double pitch) {
  const Camera camera = CameraFromDegrees({}, heading, pitch, 0.0, 40.0);
  return {PlaceFromDegrees(latitude, longitude, height_m), camera.heading_rad, camera.pitch_rad,
          0.0, camera.fov_rad};
}

double MostRelativeDifference(const Image& a, const Image& b) {
  double most = 0.0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) {
    most = std::max(most, std::abs(Luminance(a.rgb[i]) / Luminance(b.rgb[i]) - 1.0));
  }
  return most;
}

TEST(Render, AnEyeOnAPathSeesWhatOneThatStandsThereSees) {
  // 80 km apart: the frame's vertical is tilted by 0.7 degrees against the eye's.
  const UtcInstant evening = ParseInstant("2026-06-21T18:40:00Z");
  const SceneRenderer from(BareScene(1000.0, 0.0, 0.0, 40.0));
  CameraSample camera_sample(evening);
  camera_sample.poses = {PoseAt(46.0, 8.8, 3000.0, 300.0, 4.0)};
  Scene there = BareScene(3000.0, 300.0, 4.0, 40.0);
  there.place = PlaceFromDegrees(46.0, 8.8, 0.0);
  const SceneRenderer at(there);
  EXPECT_LT(MostRelativeDifference(from.Render(camera_sample, kSmall), at.Render(evening, kSmall)),
            2e-3)
      << "the sphere that osculates 80 km away, 2 m of altitude";
  EXPECT_NEAR(from.Illuminance(camera_sample) / at.Illuminance(evening), 1.0, 1e-3);
}

TEST(Render, AMovingCameraSeesTheMeanOfWhatItPasses) {
  const UtcInstant noon = ParseInstant("2026-06-21T11:30:00Z");
  const SceneRenderer renderer(BareScene(1000.0, 0.0, 0.0, 40.0));
  RenderSettings settings = kSmall;
  settings.samples_per_pixel = 64;
  settings.filter = PixelFilter::Kind::kBox;
  const auto pose = [](double pitch) {
    CameraPose at = PoseAt(46.5, 8.0, 1000.0, 90.0, pitch);
    at.fov_rad = 8.0 * kRadiansPerDegree;  // half a degree a pixel
    return at;
  };
  CameraSample blurred(noon);
  // Up from the sea over the horizon, by 16 steps of half a degree.
  for (int i = 0; i <= 16; ++i) blurred.poses.push_back(pose(-4.0 + 0.5 * i));
  const Image found = renderer.Render(blurred, settings);
  std::vector<double> mean(found.rgb.size(), 0.0);
  constexpr int kStills = 32;
  settings.samples_per_pixel = 16;
  for (int i = 0; i < kStills; ++i) {
    CameraSample still(noon);
    still.poses = {pose(-4.0 + 8.0 * (i + 0.5) / kStills)};
    const Image image = renderer.Render(still, settings);
    for (std::size_t k = 0; k < mean.size(); ++k) mean[k] += Luminance(image.rgb[k]) / kStills;
  }
  for (std::size_t k = 0; k < mean.size(); ++k) {
    EXPECT_NEAR(Luminance(found.rgb[k]) / mean[k], 1.0, 0.03)
        << "64 rays over an edge, pixel " << k;
  }
}

// Hard case 43.
TEST(Render, LensFilterAndPathGiveTheSameBytesForAnyNumberOfThreads) {
  Scene scene = BareScene(20.0, 120.0, 0.0, 60.0);
  scene.camera.lens = ThinLens{1.4, 0.085, 6.0, 7, 0.1};
  Light& lamp = scene.lights.emplace_back();
  lamp.latitude_rad = scene.place.latitude_rad - 4e-6;
  lamp.longitude_rad = scene.place.longitude_rad + 8e-6;
  lamp.height = {18.0, false};
  lamp.intensity_cd = 1000.0;
  const SceneRenderer renderer(scene);
  CameraSample camera_sample(ParseInstant("2026-06-21T02:40:00Z"));
  camera_sample.poses = {PoseAt(46.5, 8.0, 20.0, 118.0, 0.0),
                         PoseAt(46.5, 8.00001, 21.0, 124.0, 1.0)};
  RenderSettings settings = kSmall;
  settings.samples_per_pixel = 7;
  settings.layers = {PictureLayer::kDepth, PictureLayer::kLamps};
  const Image image =
      tests::SameForAnyNumberOfThreads([&] { return renderer.Render(camera_sample, settings); });
  double lamps = 0.0;
  for (const float value : image.layers[1].values) lamps += static_cast<double>(value);
  EXPECT_GT(lamps, 0.0) << "the lamp is in the picture";
}

TEST(Render, AnEyeBelowTheGroundOrTooFarAwayIsRefused) {
  const SceneRenderer renderer(BareScene(1000.0, 0.0, 0.0, 40.0));
  CameraSample camera_sample(ParseInstant("2026-06-21T11:30:00Z"));
  camera_sample.poses = {PoseAt(46.5, 8.0, -5.0, 0.0, 0.0)};
  EXPECT_THROW((void)renderer.Render(camera_sample, kSmall), InputError);
  camera_sample.poses = {PoseAt(52.5, 8.0, 100.0, 0.0, 0.0)};
  EXPECT_THROW((void)renderer.Render(camera_sample, kSmall), InputError);
}

// Hard case 20.
TEST(Render, SkyMeetsTheSeaAtTheDipOfTheHorizon) {
  // Without refraction of the line of sight the sea
  // horizon lies acos(R / (R + h)) below the horizontal.
  constexpr double kHeight_m = 10000.0;
  const SceneRenderer renderer(BareScene(kHeight_m, 0.0, -3.0, 2.0));
  RenderSettings settings{.width = 8,
                          .height = 400,
                          .samples_per_pixel = 1,
                          .air_nodes = 8,
                          .effects = EffectSet::All().Without(Effect::kRefraction),
                          .layers = {PictureLayer::kDepth}};
  const Scene scene = BareScene(kHeight_m, 0.0, -3.0, 2.0);
  const CameraRays camera(scene.camera, settings.width, settings.height);
  const Image image = renderer.Render(ParseInstant("2026-06-21T11:30:00Z"), settings);
  const double radius = renderer.medium().planet_radius_m;
  const double dip = std::acos(radius / (radius + kHeight_m));
  for (int y = 0; y < settings.height; ++y) {
    const double elevation = std::asin(camera.Direction(4.5, y + 0.5).z);
    const float depth = image.layers[0].values[static_cast<std::size_t>(y) * 8 + 4];
    EXPECT_EQ(std::isinf(depth), elevation > -dip) << "row " << y;
  }
}

TEST(Render, AirLiftsTheHorizonOfTheSeaToWhereRefractedRaysMeetIt) {
  constexpr double kHeight_m = 10000.0;
  const Scene scene = BareScene(kHeight_m, 0.0, -3.0, 2.0);
  const SceneRenderer renderer(scene);
  const RenderSettings settings{.width = 8,
                                .height = 400,
                                .samples_per_pixel = 1,
                                .air_nodes = 8,
                                .layers = {PictureLayer::kDepth}};
  const CameraRays camera(scene.camera, settings.width, settings.height);
  const Image image = renderer.Render(ParseInstant("2026-06-21T11:30:00Z"), settings);
  const double horizon_rad = RefractedView(renderer.medium(), kHeight_m).horizon_rad();
  for (int y = 0; y < settings.height; ++y) {
    const double elevation = std::asin(camera.Direction(4.5, y + 0.5).z);
    const float depth = image.layers[0].values[static_cast<std::size_t>(y) * 8 + 4];
    EXPECT_EQ(std::isinf(depth), elevation > horizon_rad) << "row " << y;
  }
}

TEST(Render, TheDiskOfASettingSunIsFlat) {
  const UtcInstant evening = ParseInstant("2026-06-21T19:20:30Z");
  Scene scene = BareScene(20.0, 0.0, 0.0, 1.2);
  const SunPosition sun = SceneRenderer(scene).ApparentSun(evening);
  scene.camera =
      CameraFromDegrees({20.0, false}, sun.azimuth_rad / kRadiansPerDegree, 0.3, 0.0, 1.2);
  const SceneRenderer renderer(scene);
  const auto height_by_width = [&](EffectSet effects) {
    const RenderSettings settings{.width = 72,
                                  .height = 72,
                                  .samples_per_pixel = 4,
                                  .filter = PixelFilter::Kind::kBox,
                                  .air_nodes = 4,
                                  .effects = effects,
                                  .layers = {}};
    const Image image = renderer.Render(evening, settings);
    double brightest = 0.0, area = 0.0;
    for (const auto& rgb : image.rgb) brightest = std::max(brightest, Luminance(rgb));
    int left = settings.width, right = 0;
    for (std::size_t i = 0; i < image.rgb.size(); ++i) {
      if (Luminance(image.rgb[i]) < 0.1 * brightest) continue;
      const int x = static_cast<int>(i) % settings.width;
      left = std::min(left, x);
      right = std::max(right, x + 1);
      area += 1.0;
    }
    return area / (0.25 * kPi * (right - left) * (right - left));  // of an ellipse
  };
  const RefractedView view(renderer.medium(), 20.0);
  const double middle = view.TrueElevation(sun.elevation_rad), radius = sun.angular_radius_rad;
  const double flat =
      (view.ApparentElevationOf(middle + radius) - view.ApparentElevationOf(middle - radius)) /
      (2.0 * radius);
  const EffectSet straight = EffectSet::All().Without(Effect::kRefraction);
  EXPECT_NEAR(height_by_width(straight), 1.0, 0.03) << "pixels of a thirtieth of the disk";
  EXPECT_LT(flat, 0.93);
  EXPECT_NEAR(height_by_width(EffectSet::All()), flat, 0.04)
      << "pixels, and a disk that is an ellipse only nearly";
}

// Hard case 32.
TEST(Render, SunIrradianceInThePictureOfTheDiskIsThatOfTheSun) {
  // Radiance over the disk's pixels sums to the direct normal illuminance.
  const Scene at_sun = [] {
    Scene scene = BareScene(2.0, 0.0, 0.0, 1.0);
    const SceneRenderer probe(scene);
    const SunPosition sun = probe.ApparentSun(ParseInstant("2026-06-21T11:30:00Z"));
    scene.camera = CameraFromDegrees({2.0, false}, sun.azimuth_rad / kRadiansPerDegree,
                                     sun.elevation_rad / kRadiansPerDegree, 0.0, 1.0);
    return scene;
  }();
  const SceneRenderer renderer(at_sun);
  const RenderSettings settings{
      .width = 100, .height = 100, .samples_per_pixel = 4, .air_nodes = 8, .layers = {}};
  const Image image = renderer.Render(ParseInstant("2026-06-21T11:30:00Z"), settings);
  const double pixel = std::pow(CameraRays(at_sun.camera, 100, 100).PixelAngle(), 2);
  double illuminance = 0.0;
  for (const auto& rgb : image.rgb) illuminance += Luminance(rgb) * pixel;
  const SingleScattering<float> air(renderer.medium());
  const SunPosition sun = renderer.ApparentSun(ParseInstant("2026-06-21T11:30:00Z"));
  const auto transmittance = air.TransmittanceToSpace(2.0, std::sin(sun.elevation_rad));
  std::vector<double> direct;
  for (std::size_t band = 0; band < air.bands(); ++band) {
    direct.push_back(static_cast<double>(transmittance[band]) *
                     renderer.medium().solar_irradiance[band] /
                     (sun.distance_au * sun.distance_au));
  }
  const double expected = BandColour(renderer.medium().wavelengths_nm).Xyz(direct)[1];
  EXPECT_NEAR(illuminance / expected, 1.0, 0.01)
      << "edge pixels of a disk 53 pixels wide, aureole included";
}

TEST(Render, UnknownLayersAndSizesAreRefused) {
  const SceneRenderer renderer(BareScene(2.0, 0.0, 0.0, 60.0));
  RenderSettings settings = kSmall;
  EXPECT_THROW((void)LayerFromName("dept"), InputError);
  settings.width = 0;
  EXPECT_THROW((void)renderer.Render(ParseInstant("2026-06-21T11:30:00Z"), settings), InputError);
}

TEST(Render, SummitOfFujiIsLitBeforeTheLakeBelow) {
  const auto dem = std::filesystem::path(tests::kSharedFolder) / "dem" / "N35E138.hgt";
  if (!std::filesystem::exists(dem)) GTEST_SKIP() << "no elevation model at " << dem;
  Scene scene = BareScene(0.0, 0.0, 0.0, 8.0);
  scene.place = PlaceFromDegrees(35.50, 138.76, 0.0);
  scene.terrain = {TerrainSource::Kind::kElevationModel, dem, VoidPolicy::kFill};
  // Mount Fuji (35.3606, 138.7274) stands 15.7 km off,
  // heading 191 degrees, its summit 10.5 degrees up.
  scene.camera = CameraFromDegrees({20.0, true}, 190.8, 7.0, 0.0, 12.0);
  const SceneRenderer renderer(scene);
  const RenderSettings settings{.width = 60,
                                .height = 60,
                                .samples_per_pixel = 4,
                                .filter = PixelFilter::Kind::kBox,
                                .air_nodes = 8,
                                .layers = {PictureLayer::kDepth, PictureLayer::kSunVisibility}};
  const UtcInstant sunrise =
      *FindSunEvent(SunEvent::kSunrise, scene.place, ParseInstant("2026-01-01T03:00:00Z"));
  const auto lit_share = [&](double minutes, int first_row, int last_row) {
    const Image image = renderer.Render(AddSeconds(sunrise, 60.0 * minutes), settings);
    double lit = 0.0, ground = 0.0;
    for (int y = first_row; y < last_row; ++y) {
      for (int x = 0; x < 60; ++x) {
        const std::size_t pixel = static_cast<std::size_t>(y) * 60 + static_cast<std::size_t>(x);
        if (std::isinf(image.layers[0].values[pixel])) continue;
        ground += 1.0;
        lit += static_cast<double>(image.layers[1].values[pixel]);
      }
    }
    return ground > 0.0 ? lit / ground : 0.0;
  };
  // From 3776 m the sea horizon lies 2 degrees deeper, which the sun climbs in ten minutes.
  EXPECT_GT(lit_share(-5.0, 0, 30), 0.01) << "the summit catches the sun";
  EXPECT_EQ(lit_share(-5.0, 40, 60), 0.0) << "the foot lies in shadow";
  EXPECT_EQ(lit_share(-15.0, 0, 60), 0.0) << "the sun is under the summit's horizon";
}

// Hard case 22.
TEST(Render, IlluminanceFallsSmoothlyFromNoonIntoTheNight) {
  const SceneRenderer renderer(BareScene(2.0, 0.0, 0.0, 60.0));
  const UtcInstant noon = ParseInstant("2026-06-21T11:30:00Z");
  const double at_noon = renderer.Illuminance(noon);
  EXPECT_GT(at_noon, 90e3) << "a clear June noon at 46.5 degrees: about 110 klx";
  EXPECT_LT(at_noon, 130e3);
  double before = std::log2(renderer.Illuminance(ParseInstant("2026-06-21T17:00:00Z")));
  double step_before = 0.0;
  for (int minute = 1; minute <= 340; ++minute) {
    const UtcInstant instant{61212, 17.0 * 3600.0 + 60.0 * minute};
    const double stops = std::log2(renderer.Illuminance(instant));
    EXPECT_LT(stops, before) << minute << " minutes after 17:00 UTC";
    if (minute > 1) {
      EXPECT_NEAR(stops - before, step_before, 0.05) << "no flicker, " << minute << " minutes";
    }
    step_before = stops - before;
    before = stops;
  }
}

TEST(Render, ScotopicLayerIsWhatRodsSeeOfTheSamePixel) {
  const SceneRenderer renderer(BareScene(1000.0, 180.0, 20.0, 40.0));
  RenderSettings settings = kSmall;
  settings.layers = {PictureLayer::kScotopic};
  const Image image = renderer.Render(ParseInstant("2026-06-21T10:00:00Z"), settings);
  ASSERT_EQ(image.layers.size(), 1U);
  EXPECT_EQ(image.layers[0].name, kScotopicChannel);
  for (std::size_t i = 0; i < image.rgb.size(); ++i) {
    const double ratio = static_cast<double>(image.layers[0].values[i]) / Luminance(image.rgb[i]);
    EXPECT_GT(ratio, 2.3) << "a blue sky has S/P 2.5 to 3.5";
    EXPECT_LT(ratio, 4.0);
  }
}

}  // namespace
}  // namespace alpenglow::renderer
