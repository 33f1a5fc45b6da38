// SPDX-License-Identifier: MIT
// Pictures at the ends of what a scene, an eye and a picture may be.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/constants.h"
#include "lut/image/exr.h"
#include "renderer/camera/camera_rays.h"
#include "renderer/picture/render.h"
#include "tests/fixtures/bare_scene.h"
#include "tests/fixtures/luminance.h"
#include "tests/fixtures/media.h"
#include "tests/fixtures/mesh_scene.h"
#include "tests/fixtures/sanitized.h"
#include "tests/fixtures/temporary_folder.h"
#include "tests/renderer/picture/sun_seen.h"

namespace alpenglow::renderer {
namespace {

using tests::Luminance;

const UtcTime kExtremeNoon = ParseInstant("2026-06-21T11:30:00Z");

RenderSettings Settings(int width, int height, std::vector<PictureLayer> layers = {}) {
  return {.width = width,
          .height = height,
          .samples_per_pixel = 1,
          .air_nodes = 12,
          .layers = std::move(layers)};
}

/// Returns a view of another camera at the place of a bare scene; angles are in degrees.
CameraSample CameraSampleFrom(double height_m, double pitch, double roll, double fov) {
  const Camera camera = CameraFromDegrees({}, 40.0, pitch, roll, 60.0);
  CameraSample camera_sample(kExtremeNoon);
  camera_sample.poses = {{CheckedPlace({46.5, 8.0, height_m}), camera.heading_rad, camera.pitch_rad,
                          camera.roll_rad, fov * kRadiansPerDegree}};
  return camera_sample;
}

void ExpectLightEverywhere(const HdrImage& image) {
  for (std::size_t i = 0; i < image.rgb.size(); ++i) {
    for (const float channel : image.rgb[i]) EXPECT_TRUE(std::isfinite(channel)) << "pixel " << i;
    EXPECT_GT(Luminance(image.rgb[i]), 1.0) << "by day nothing is black; pixel " << i;
  }
}

// Hard case 1.
TEST(RenderExtremes, OnTheGroundTheHorizonIsTheHorizontal) {
  const SceneRenderer renderer(QuickScene(0.0, 40.0, 0.0, 2.0));
  const HdrImage image = renderer.Render(kExtremeNoon, Settings(2, 100, {PictureLayer::kDepth}));
  ExpectLightEverywhere(image);
  for (int y = 0; y < image.height; ++y) {
    const float depth = image.layers[0].values[static_cast<std::size_t>(2 * y)];
    EXPECT_EQ(std::isinf(depth), y < 50) << "row " << y;
  }
}

/// Returns the mean luminance of each pixel, from a picture that is `finer` times as fine.
std::vector<double> MeansOf(const HdrImage& image, int finer) {
  const int columns = image.width / finer, rows = image.height / finer;
  std::vector<double> means(static_cast<std::size_t>(columns * rows));
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x)
      means[static_cast<std::size_t>(y / finer * columns + x / finer)] +=
          Luminance(image.at(x, y)) / (finer * finer);
  }
  return means;
}

/// Compares the limb of the planet with a picture of many more pixels.
/// @param pitch  to the limb. @param fov  of eight columns.
void ExpectSmoothLimb(double height_m, double pitch, double fov, int rows) {
  constexpr int kColumns = 8, kFiner = 12;
  const SceneRenderer renderer(QuickScene(height_m, 0.0, pitch, fov));
  const std::vector<double> expected =
      MeansOf(renderer.Render(kExtremeNoon, Settings(kFiner * kColumns, kFiner * rows)), kFiner);
  for (const bool is_noise_bounded : {false, true}) {
    RenderSettings settings = Settings(kColumns, rows);
    settings.filter = PixelFilter::Kind::kBox;
    settings.samples_per_pixel = is_noise_bounded ? 16 : 256;
    if (is_noise_bounded) settings.noise = 0.005;
    const HdrImage image = renderer.Render(kExtremeNoon, settings);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_NEAR(Luminance(image.rgb[i]), expected[i], 0.05 * expected[i] + 0.05)
          << height_m << " m, row " << i / kColumns << ": rays of the noise asked for";
    }
  }
}

// Hard case 6.
TEST(RenderExtremes, TheLimbOfThePlanetIsTheMeanOverEachPixel) {
  ExpectSmoothLimb(400e3, -17.0, 3.2, 18);
  if (!tests::kSanitized) ExpectSmoothLimb(36e6, -81.3, 1.0, 9);
}

// Hard case 6.
TEST(RenderExtremes, AClimbToOrbitIsContinuous) {
  const SceneRenderer renderer(QuickScene(1.7, 40.0, 0.0, 20.0));
  struct Climb {
    double from_m, to_m;
  };
  // From the ground, through the layers of the air, and out of it.
  const std::vector<Climb> climbs{{1.7, 4.0}, {8e3, 50e3}, {60e3, 400e3}};
  // The camera looks at the sky, the horizon (which the limb passes at 100 km) or the ground.
  for (const double pitch : {40.0, -10.0, -60.0}) {
    double peak = 0.0;
    std::vector<double> seen;
    for (const Climb& climb : tests::ScaledDown(climbs, {climbs.back()})) {
      seen.clear();
      for (double height_m = climb.from_m; height_m < climb.to_m; height_m *= 1.01) {
        const CameraSample camera_sample = CameraSampleFrom(height_m, pitch, 0.0, 0.1);
        seen.push_back(Luminance(renderer.Render(camera_sample, Settings(1, 1)).at(0, 0)));
        peak = std::max(peak, seen.back());
        if (seen.size() < 3) continue;
        const double* last = &seen.back();
        EXPECT_NEAR(last[0] - last[-1], last[-1] - last[-2], 0.02 * peak)
            << pitch << " degrees up, at " << height_m
            << " m: the pace changes by less than 2 % of "
            << "the brightest";
      }
    }
  }
}

// Returns a scene at the bottom of a funnel whose rim is 300 m above the sea and 30 km away.
Scene AtTheBottomOf(const std::filesystem::path& file, double depth_m) {
  std::string text = fmt::format("v 0 0 {}\n", -depth_m);
  constexpr int kRim = 24;
  for (int i = 0; i < kRim; ++i) {
    const double turn = 2.0 * kPi * i / kRim;
    text += fmt::format("v {} {} 300\n", 30e3 * std::cos(turn), 30e3 * std::sin(turn));
  }
  for (int i = 0; i < kRim; ++i) text += fmt::format("f 1 {} {}\n", i + 2, (i + 1) % kRim + 2);
  Scene scene = tests::MeshScene(QuickScene(0.0, 40.0, 55.0, 30.0), file, text);
  scene.camera.height = {2.0, true};
  return scene;
}

class RenderExtremesFiles : public TemporaryFolder {};

// Hard case 2.
TEST_F(RenderExtremesFiles, BelowTheSeaTheSkyIsThatOfTheShore) {
  const HdrImage shore =
      SceneRenderer(QuickScene(0.0, 40.0, 55.0, 30.0)).Render(kExtremeNoon, Settings(12, 8));
  const std::vector<double> depths_m{430.0, 11000.0};
  for (const double depth_m : tests::ScaledDown(depths_m, {depths_m.back()})) {
    const SceneRenderer renderer(AtTheBottomOf(folder_ / "sink.obj", depth_m));
    EXPECT_NEAR(renderer.eye_height_m(), 2.0 - depth_m, 1e-3);
    const HdrImage sky = renderer.Render(kExtremeNoon, Settings(12, 8));
    for (std::size_t i = 0; i < sky.rgb.size(); ++i) {
      EXPECT_NEAR(Luminance(sky.rgb[i]) / Luminance(shore.rgb[i]), 1.0, 1e-3)
          << depth_m << " m down, pixel " << i << ": the ground's shape does not change the sky";
    }
    // The camera looks at the walls and the rim, then at the floor.
    for (const double pitch : {0.0, -60.0}) {
      const CameraSample down = CameraSampleFrom(renderer.eye_height_m(), pitch, 0.0, 60.0);
      ExpectLightEverywhere(renderer.Render(down, Settings(12, 8)));
    }
    EXPECT_GT(renderer.Illuminance(kExtremeNoon), 90e3) << "lux";
  }
}

Scene WithoutAir(double height_m, double heading, double pitch, double fov) {
  Scene scene = QuickScene(height_m, heading, pitch, fov);
  scene.medium = tests::WithoutAir(scene.medium);
  return scene;
}

// Hard cases 28, 32.
TEST(RenderExtremes, WithoutAirTheSunsDiskStandsInABlackSky) {
  const SunInSky sun = tests::SunSeenIn(WithoutAir(2.0, 0.0, 0.0, 2.0), kExtremeNoon);
  const Scene scene = WithoutAir(2.0, sun.azimuth_deg, sun.elevation_deg, 2.0);
  const SceneRenderer renderer(scene);
  constexpr int kSide = 200;
  const HdrImage image = renderer.Render(
      kExtremeNoon,
      Settings(kSide, kSide, {PictureLayer::kTransmittance, PictureLayer::kInscatter}));
  const CameraRays camera(scene.camera, kSide, kSide);
  const glm::dvec3 to_sun = EnuFromAngles(sun.elevation_rad(), sun.azimuth_rad()).xyz;
  const double radius = 0.5 * 0.5334 * kRadiansPerDegree / sun.distance_au;
  double illuminance = 0.0, brightest = 0.0;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const double away = std::acos(glm::dot(camera.Direction(x + 0.5, y + 0.5), to_sun));
      const bool is_sky = away > 1.02 * radius;
      EXPECT_TRUE(!is_sky || image.at(x, y) == (std::array<float, 3>{})) << x << ", " << y;
      illuminance += Luminance(image.at(x, y)) * std::pow(camera.PixelAngle(), 2);
      brightest = std::max(brightest, Luminance(image.at(x, y)));
    }
  }
  for (std::size_t i = 0; i < image.rgb.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_EQ(image.layers[c].values[i], 1.0F) << "transmittance";
      EXPECT_EQ(image.layers[3 + c].values[i], 0.0F) << "inscatter";
    }
  }
  const double expected =
      BandColour(scene.medium.wavelengths_nm).Xyz(scene.medium.solar_irradiance)[1] /
      (sun.distance_au * sun.distance_au);
  EXPECT_NEAR(illuminance / expected, 1.0, 0.01) << "a disk of 53 pixels across";
  EXPECT_NEAR(expected, 133e3 / std::pow(sun.distance_au, 2), 2e3) << "lux above the air";
  EXPECT_GT(brightest, 1.6e9) << "cd/m^2; the middle is brighter than the mean";
  EXPECT_LT(brightest, 3e9);
}

/// Returns the settings without the other lights of the night.
RenderSettings InSunlightAlone(RenderSettings settings) {
  for (const Effect effect : {Effect::kMoonlight, Effect::kNightSky, Effect::kStars})
    settings.effects = settings.effects.Without(effect);
  return settings;
}

// Hard case 28.
TEST(RenderExtremes, WithoutAirGroundIsSunlitAndNightsAreBlack) {
  const SceneRenderer renderer(WithoutAir(1000.0, 40.0, -30.0, 40.0));
  ExpectLightEverywhere(renderer.Render(kExtremeNoon, Settings(8, 8)));
  const HdrImage night =
      renderer.Render(ParseInstant("2026-06-21T23:30:00Z"), InSunlightAlone(Settings(8, 8)));
  for (const auto& rgb : night.rgb) EXPECT_EQ(rgb, (std::array<float, 3>{}));
  const SunInSky sun = renderer.ApparentSun(kExtremeNoon);
  const double lux =
      BandColour(renderer.medium().wavelengths_nm).Xyz(renderer.medium().solar_irradiance)[1] *
      std::sin(sun.elevation_rad()) / (sun.distance_au * sun.distance_au);
  EXPECT_NEAR(renderer.Illuminance(kExtremeNoon) / lux, 1.0, 1e-4);
}

// Hard case 33.
TEST_F(RenderExtremesFiles, DeepTwilightHasNoBands) {
  constexpr int kRows = 200;  // 4 to 24 degrees up, away from the sun and towards it
  const RenderSettings column = InSunlightAlone(Settings(1, kRows));
  for (const double heading : {310.0, 130.0}) {
    const SceneRenderer renderer(QuickScene(2.0, heading, 14.0, 0.1));
    const double noon = Luminance(renderer.Render(kExtremeNoon, column).at(0, kRows / 2));
    const HdrImage image = renderer.Render(ParseInstant("2026-06-21T20:50:00Z"), column);
    const double dusk = Luminance(image.at(0, kRows / 2));
    WriteExr(folder_ / "dusk.exr", image, {});
    const HdrImage kept = ReadExr(folder_ / "dusk.exr");
    EXPECT_EQ(kept.rgb, image.rgb);
    // Exposed a million times longer, the light changes from pixel to pixel as evenly as by day.
    std::vector<double> stops;
    for (int y = 0; y < kRows; ++y) stops.push_back(std::log2(1e6 * Luminance(kept.at(0, y))));
    double largest = 0.0;
    for (std::size_t y = 2; y < stops.size(); ++y) {
      largest = std::max(largest, std::abs(stops[y] - 2.0 * stops[y - 1] + stops[y - 2]));
    }
    EXPECT_LT(largest, 2e-3) << "a code of 8 bits is 0.065 stops in AgX's 16.5; heading "
                             << heading;
    EXPECT_LT(dusk, 1e-5 * noon);
    EXPECT_GT(dusk, 1e-7 * noon);
  }
}

double TanHalf(double fov_deg) { return std::tan(0.5 * fov_deg * kRadiansPerDegree); }

double FovOf(double tan_half) { return 2.0 * std::atan(tan_half) / kRadiansPerDegree; }

// Hard case 44.
TEST(RenderExtremes, OnePixelAndOneColumnArePartsOfWiderPictures) {
  const SceneRenderer renderer(QuickScene(100.0, 40.0, 10.0, 60.0));
  for (const double fov : {1.0, 60.0, 179.0}) {
    for (const double roll : {0.0, 90.0}) {
      // The narrow picture is a third of one that is three times as wide.
      const CameraSample narrow = CameraSampleFrom(100.0, 10.0, roll, FovOf(TanHalf(fov) / 3.0));
      const HdrImage three = renderer.Render(CameraSampleFrom(100.0, 10.0, roll, fov),
                                             Settings(3, 5, {PictureLayer::kDepth}));
      const HdrImage column = renderer.Render(narrow, Settings(1, 5));
      for (int y = 0; y < 5; ++y) {
        const bool sky = std::isinf(three.layers[0].values[static_cast<std::size_t>(3 * y + 1)]);
        EXPECT_NEAR(Luminance(column.at(0, y)) / Luminance(three.at(1, y)), 1.0, sky ? 1e-4 : 1e-2)
            << "light on the ground comes from another point of the sun's disk in every pixel; "
            << fov << ", roll " << roll << ", row " << y;
      }
      EXPECT_EQ(renderer.Render(narrow, Settings(1, 1)).at(0, 0), column.at(0, 2));
    }
  }
}

// Hard case 44.
TEST(RenderExtremes, ACameraOnItsSideSeesRowsAsColumns) {
  constexpr int kPixels = 9;
  constexpr double kFov = 10.0;
  const SceneRenderer renderer(QuickScene(100.0, 40.0, 30.0, 60.0));
  const CameraSample upright = CameraSampleFrom(100.0, 30.0, 0.0, FovOf(kPixels * TanHalf(kFov)));
  const HdrImage row = renderer.Render(upright, Settings(kPixels, 1));
  const HdrImage column =
      renderer.Render(CameraSampleFrom(100.0, 30.0, 90.0, kFov), Settings(1, kPixels));
  for (int i = 0; i < kPixels; ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(column.at(0, i)[c] / row.at(kPixels - 1 - i, 0)[c], 1.0F, 1e-4F)
          << "rolled clockwise, its top looks to the right; pixel " << i;
    }
  }
}

int BrightestColumn(const HdrImage& image) {
  const auto first_row = image.rgb.begin();
  return static_cast<int>(
      std::max_element(first_row, first_row + image.width,
                       [](const auto& a, const auto& b) { return Luminance(a) < Luminance(b); }) -
      first_row);
}

// Hard case 44.
TEST(RenderExtremes, SixteenThousandColumnsAreSmooth) {
  constexpr int kWidth = 16384;
  const SceneRenderer renderer(QuickScene(100.0, 40.0, 20.0, 360.0));
  const RenderSettings wide = Settings(kWidth, 1);
  ExpectLightEverywhere(renderer.Render(kExtremeNoon, Settings(1, 1)));
  for (const double fov : {1.0, 179.0, 360.0}) {
    const bool closes = fov == 360.0;
    // The upper one of two rows of a panorama looks 45 degrees up.
    const HdrImage image = closes ? renderer.Render(kExtremeNoon, Settings(kWidth, 2))
                                  : renderer.Render(CameraSampleFrom(100.0, 20.0, 0.0, fov), wide);
    ExpectLightEverywhere(image);
    // The disk of the high sun stands in 100 columns of a panorama, and the pixel filter reaches
    // across the pole to the opposite ones.
    const int sun = BrightestColumn(image);
    for (int x = 0; x < (closes ? kWidth : kWidth - 1); ++x) {
      if (closes && std::abs(std::remainder(x - sun, 0.5 * kWidth)) < 120) continue;
      EXPECT_NEAR(Luminance(image.at((x + 1) % kWidth, 0)) / Luminance(image.at(x, 0)), 1.0, 0.01)
          << "from one column to the next; field of view " << fov << ", column " << x;
    }
  }
}

}  // namespace
}  // namespace alpenglow::renderer
