// SPDX-License-Identifier: MIT
// Pictures of skies, and what belongs to all pictures: layers, polarisers, cameras that move.
#include "renderer/picture/render.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "atmosphere/astronomy/sun.h"
#include "atmosphere/base/error.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/medium/medium.h"
#include "atmosphere/medium/medium_presets.h"
#include "atmosphere/reference/reference_solution.h"
#include "atmosphere/refraction/refracted_view.h"
#include "lut/image/night_vision.h"
#include "lut/multiple_scattering/multiple_scattering.h"
#include "renderer/camera/camera_rays.h"
#include "renderer/illumination/aerial_perspective.h"
#include "renderer/picture/picture_layers.h"
#include "renderer/picture/prepared_scene.h"
#include "tests/fixtures/bare_scene.h"
#include "tests/fixtures/luminance.h"
#include "tests/fixtures/temporary_folder.h"
#include "tests/fixtures/thread_counts.h"
#include "tests/renderer/elevation/coarse_fuji.h"
#include "tests/renderer/picture/sun_seen.h"

namespace alpenglow::renderer {
namespace {

using tests::Luminance;

const RenderSettings kSmall{
    .width = 16, .height = 9, .samples_per_pixel = 1, .air_nodes = 16, .layers = {}};

TEST(Render, SkyPixelsAreReferenceSingleScatteringPlusTheRest) {
  const SceneRenderer renderer(QuickScene(1000.0, 180.0, 20.0, 40.0));
  const UtcTime noon = ParseInstant("2026-06-21T10:00:00Z");
  const HdrImage image = renderer.Render(noon, kSmall);
  const SunInSky sun = renderer.ApparentSun(noon);
  const Medium& medium = renderer.medium();
  const MultipleScattering multiple_scattering(medium);
  const SingleScattering<float> air(medium);
  const BandColour colour(medium.wavelengths_nm);
  const CameraRays camera(CameraFromDegrees({1000.0, false}, 180.0, 20.0, 0.0, 40.0), 16, 9);
  const glm::dvec3 to_sun = EnuFromAngles(sun.elevation_rad(), sun.azimuth_rad()).xyz;
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
  const SceneRenderer renderer(QuickScene(500.0, 0.0, 60.0, 20.0));
  const HdrImage image = renderer.Render(ParseInstant("2026-06-21T11:30:00Z"), kSmall);
  EXPECT_GT(Luminance(image.at(8, 4)), 1e3);
  EXPECT_LT(Luminance(image.at(8, 4)), 1e4);
  EXPECT_GT(image.at(8, 4)[2], image.at(8, 4)[0]) << "the sky is blue";
}

// Hard case 23.
TEST(Render, NightsAreFiniteAndNotNegative) {
  const SceneRenderer renderer(QuickScene(2.0, 0.0, 10.0, 360.0));
  for (const char* time :
       {"2026-01-01T00:00:00Z", "2026-01-01T05:00:00Z", "2026-01-01T06:00:00Z"}) {
    for (const auto& rgb : renderer.Render(ParseInstant(time), kSmall).rgb) {
      for (const float value : rgb) EXPECT_TRUE(std::isfinite(value));
      EXPECT_GE(Luminance(rgb), 0.0);
    }
  }
}

// Hard case 43.
TEST(Render, BytesAreTheSameForAnyNumberOfThreads) {
  const SceneRenderer renderer(QuickScene(2.0, 120.0, 5.0, 60.0));
  const UtcTime dawn = ParseInstant("2026-06-21T03:40:00Z");
  static_cast<void>(
      tests::SameForAnyNumberOfThreads([&] { return renderer.Render(dawn, kSmall); }));
}

/// Returns a pose of the camera; angles are in degrees.
CameraPose PoseAt(double latitude, double longitude, double height_m, double heading,
                  double pitch) {
  const Camera camera = CameraFromDegrees({}, heading, pitch, 0.0, 40.0);
  return {CheckedPlace({latitude, longitude, height_m}), camera.heading_rad, camera.pitch_rad, 0.0,
          camera.fov_rad};
}

double MostRelativeDifference(const HdrImage& a, const HdrImage& b) {
  double most = 0.0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) {
    most = std::max(most, std::abs(Luminance(a.rgb[i]) / Luminance(b.rgb[i]) - 1.0));
  }
  return most;
}

TEST(Render, AnEyeOnAPathSeesTheSameAsAStandingOne) {
  // The eye is 80 km away: its vertical differs from the frame's by 0.7 degrees.
  const UtcTime evening = ParseInstant("2026-06-21T18:40:00Z");
  const SceneRenderer from(QuickScene(1000.0, 0.0, 0.0, 40.0));
  CameraSample camera_sample(evening);
  camera_sample.poses = {PoseAt(46.0, 8.8, 3000.0, 300.0, 4.0)};
  Scene there = QuickScene(3000.0, 300.0, 4.0, 40.0);
  there.place = {46.0, 8.8, 0.0};
  const SceneRenderer at(there);
  EXPECT_LT(MostRelativeDifference(from.Render(camera_sample, kSmall), at.Render(evening, kSmall)),
            2e-3)
      << "the sphere that osculates 80 km away, 2 m of altitude";
  EXPECT_NEAR(from.Illuminance(camera_sample) / at.Illuminance(evening), 1.0, 1e-3);
}

TEST(Render, AMovingCameraSeesTheMeanOfItsViews) {
  const UtcTime noon = ParseInstant("2026-06-21T11:30:00Z");
  const SceneRenderer renderer(QuickScene(1000.0, 0.0, 0.0, 40.0));
  RenderSettings settings = kSmall;
  settings.samples_per_pixel = 64;
  settings.filter = PixelFilter::Kind::kBox;
  const auto pose = [](double pitch) {
    CameraPose at = PoseAt(46.5, 8.0, 1000.0, 90.0, pitch);
    at.fov_rad = 8.0 * kRadiansPerDegree;  // half a degree a pixel
    return at;
  };
  CameraSample blurred(noon);
  // The camera moves from the sea to above the horizon in 16 steps of half a degree.
  for (int i = 0; i <= 16; ++i) blurred.poses.push_back(pose(-4.0 + 0.5 * i));
  const HdrImage found = renderer.Render(blurred, settings);
  std::vector<double> mean(found.rgb.size(), 0.0);
  constexpr int kStills = 32;
  settings.samples_per_pixel = 16;
  for (int i = 0; i < kStills; ++i) {
    CameraSample still(noon);
    still.poses = {pose(-4.0 + 8.0 * (i + 0.5) / kStills)};
    const HdrImage image = renderer.Render(still, settings);
    for (std::size_t k = 0; k < mean.size(); ++k) mean[k] += Luminance(image.rgb[k]) / kStills;
  }
  for (std::size_t k = 0; k < mean.size(); ++k) {
    EXPECT_NEAR(Luminance(found.rgb[k]) / mean[k], 1.0, 0.03)
        << "64 rays over an edge, pixel " << k;
  }
}

TEST(Render, ImpossibleEyesLayersAndSizesAreRefused) {
  const SceneRenderer renderer(QuickScene(1000.0, 0.0, 0.0, 40.0));
  const UtcTime noon = ParseInstant("2026-06-21T11:30:00Z");
  CameraSample camera_sample(noon);
  for (const CameraPose& pose : {PoseAt(46.5, 8.0, -5.0, 0.0, 0.0),      // below the ground
                                 PoseAt(52.5, 8.0, 100.0, 0.0, 0.0)}) {  // too far away
    camera_sample.poses = {pose};
    EXPECT_THROW((void)renderer.Render(camera_sample, kSmall), InputError);
  }
  EXPECT_THROW((void)LayerFromName("dept"), InputError);
  RenderSettings settings = kSmall;
  settings.width = 0;
  EXPECT_THROW((void)renderer.Render(noon, settings), InputError);
}

/// Returns the illuminance of a surface 2 m up that faces the sun, without the sky [lx].
double SunIlluminance(const SceneRenderer& renderer, const SunInSky& sun) {
  const SingleScattering<float> air(renderer.medium());
  const auto transmittance = air.TransmittanceToSpace(2.0, std::sin(sun.elevation_rad()));
  std::vector<double> direct;
  for (std::size_t band = 0; band < air.bands(); ++band) {
    direct.push_back(static_cast<double>(transmittance[band]) *
                     renderer.medium().solar_irradiance[band] /
                     (sun.distance_au * sun.distance_au));
  }
  return BandColour(renderer.medium().wavelengths_nm).Xyz(direct)[1];
}

// Hard case 32.
TEST(Render, TheDiskInThePictureHasTheSunsIlluminance) {
  // The radiance of the disk's pixels sums to the direct normal illuminance.
  const UtcTime noon = ParseInstant("2026-06-21T11:30:00Z");
  Scene at_sun = QuickScene(2.0, 0.0, 0.0, 1.0);
  const SunInSky sun = tests::SunSeenIn(at_sun, noon);
  at_sun.camera = CameraFromDegrees({2.0, false}, sun.azimuth_deg, sun.elevation_deg, 0.0, 1.0);
  const SceneRenderer renderer(at_sun);
  const RenderSettings settings{
      .width = 100, .height = 100, .samples_per_pixel = 4, .air_nodes = 8, .layers = {}};
  const HdrImage image = renderer.Render(noon, settings);
  const double pixel = std::pow(CameraRays(at_sun.camera, 100, 100).PixelAngle(), 2);
  double illuminance = 0.0;
  for (const auto& rgb : image.rgb) illuminance += Luminance(rgb) * pixel;
  EXPECT_NEAR(illuminance / SunIlluminance(renderer, sun), 1.0, 0.01)
      << "edge pixels of a disk 53 pixels wide, aureole included";
}

class RenderOfFiles : public TemporaryFolder {};

/// Returns the solid angle of a pixel by summing over its parts, which are nearly flat.
double SolidAngleBySum(const CameraRays& camera, int column, int row) {
  constexpr int kParts = 32;
  double sum = 0.0;
  for (int i = 0; i < kParts * kParts; ++i) {
    const double x = column + (i % kParts) / (1.0 * kParts),
                 y = row + (i / kParts) / (1.0 * kParts);
    constexpr double kSide = 1.0 / kParts;
    const glm::dvec3 down = camera.Direction(x + kSide, y + kSide) - camera.Direction(x, y);
    const glm::dvec3 rise = camera.Direction(x + kSide, y) - camera.Direction(x, y + kSide);
    sum += 0.5 * glm::length(glm::cross(down, rise));
  }
  return sum;
}

/// Returns the illuminance that the pixels much brighter than the sky around the sun add up to.
double IlluminanceOfBrightPixels(const HdrImage& image, const CameraRays& camera) {
  double illuminance = 0.0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const double luminance = Luminance(image.at(x, y));
      if (luminance > 1e5) illuminance += luminance * SolidAngleBySum(camera, x, y);
    }
  }
  return illuminance;
}

// Hard case 32.
TEST(Render, ADiskSmallerThanAPixelHasTheSunsIlluminance) {
  const UtcTime noon = ParseInstant("2026-06-21T11:30:00Z");
  const Scene bare = QuickScene(2.0, 0.0, 0.0, 90.0);
  const SunInSky sun = tests::SunSeenIn(bare, noon);
  const double azimuth = sun.azimuth_deg;
  const double elevation = sun.elevation_deg;
  const Height height{2.0, false};
  const ThinLens lens{2.0, 0.05, 1.0};  // blurs a point at infinity by 25 mrad
  struct Case {
    const char* name;
    Camera camera;
    std::optional<ThinLens> lens = {};
  };
  // The zenith of a panorama follows the pitch of its camera.
  const std::vector<Case> cases{
      {"near the middle", CameraFromDegrees(height, azimuth + 1.0, elevation + 1.0, 0.0, 90.0)},
      {"at the rim of a wide view",
       CameraFromDegrees(height, azimuth, elevation - 80.0, 30.0, 170.0)},
      {"on the seam", CameraFromDegrees(height, azimuth - 180.0, 0.0, 0.0, 360.0)},
      {"beside the seam", CameraFromDegrees(height, azimuth - 178.0, 0.0, 0.0, 360.0)},
      {"at the zenith", CameraFromDegrees(height, azimuth, elevation - 90.0, 0.0, 360.0)},
      {"beside the zenith", CameraFromDegrees(height, azimuth, elevation - 88.7, 0.0, 360.0)},
      {"at the nadir", CameraFromDegrees(height, azimuth, elevation - 90.0, 180.0, 360.0)},
      {"through a lens", CameraFromDegrees(height, azimuth, elevation, 0.0, 90.0), lens},
  };
  for (Case one : cases) {
    one.camera.lens = one.lens;
    Scene scene = bare;
    scene.camera = one.camera;
    const SceneRenderer renderer(scene);
    const RenderSettings settings{.width = 48, .height = 27, .samples_per_pixel = 1, .layers = {}};
    const HdrImage image = renderer.Render(noon, settings);
    EXPECT_NEAR(IlluminanceOfBrightPixels(image, CameraRays(one.camera, 48, 27)) /
                    SunIlluminance(renderer, sun),
                1.0, 0.01)
        << one.name << ": the sum over cells of a 24th of the disk";
  }
}

// Hard case 32.
TEST(Render, ASmallDiskIsFoundWithABoundOnTheNoise) {
  const UtcTime noon = ParseInstant("2026-06-21T11:30:00Z");
  Scene at_sun = QuickScene(2.0, 0.0, 0.0, 90.0);
  const SunInSky sun = tests::SunSeenIn(at_sun, noon);
  at_sun.camera =
      CameraFromDegrees({2.0, false}, sun.azimuth_deg + 1.0, sun.elevation_deg + 1.0, 0.0, 90.0);
  const SceneRenderer renderer(at_sun);
  RenderSettings settings{.width = 48, .height = 27, .samples_per_pixel = 4, .layers = {}};
  settings.noise = 0.02;
  const HdrImage image = renderer.Render(noon, settings);
  EXPECT_NEAR(IlluminanceOfBrightPixels(image, CameraRays(at_sun.camera, 48, 27)) /
                  SunIlluminance(renderer, sun),
              1.0, 0.01)
      << "as without the bound";
}

// Hard case 32.
TEST(Render, AMovingCameraBlursADiskSmallerThanAPixel) {
  const UtcTime noon = ParseInstant("2026-06-21T11:30:00Z");
  const Scene scene = QuickScene(1000.0, 0.0, 0.0, 90.0);
  const SunInSky sun = tests::SunSeenIn(scene, noon);
  const SceneRenderer renderer(scene);
  const auto view = [&](double turn_deg) {
    return CameraFromDegrees({1000.0, false}, sun.azimuth_deg + turn_deg, sun.elevation_deg, 0.0,
                             90.0);
  };
  const RenderSettings settings{.width = 48, .height = 27, .samples_per_pixel = 1, .layers = {}};
  const auto render = [&](double half_turn_deg) {
    CameraSample sample(noon);
    for (int i = 0; i <= 16; ++i) {
      const Camera at = view(half_turn_deg * (i / 8.0 - 1.0));
      sample.poses.push_back(
          {Place{46.5, 8.0, 1000.0}, at.heading_rad, at.pitch_rad, 0.0, at.fov_rad});
    }
    return renderer.Render(sample, settings);
  };
  const CameraRays camera(view(0.0), 48, 27);
  const auto brightest = [](const HdrImage& image) {
    double most = 0.0;
    for (const auto& rgb : image.rgb) most = std::max(most, Luminance(rgb));
    return most;
  };
  const HdrImage still = render(0.001), moved = render(20.0);
  EXPECT_NEAR(IlluminanceOfBrightPixels(moved, camera) / IlluminanceOfBrightPixels(still, camera),
              1.0, 0.01);
  EXPECT_LT(brightest(moved), 0.5 * brightest(still)) << "a trail over many pixels";
}

TEST_F(RenderOfFiles, SummitOfFujiIsLitBeforeTheLakeBelow) {
  if (!std::filesystem::exists(tests::FujiModel()))
    GTEST_SKIP() << "no elevation model at " << tests::FujiModel();
  Scene scene = QuickScene(0.0, 0.0, 0.0, 8.0);
  scene.place = {35.50, 138.76, 0.0};
  scene.terrain = {TerrainSource::Kind::kElevationModel, tests::CoarseFuji(folder_),
                   VoidPolicy::kFill};
  // Mount Fuji (35.3606, 138.7274) stands 15.7 km off,
  // heading 191 degrees, its summit 10.5 degrees up.
  scene.camera = CameraFromDegrees({20.0, true}, 190.8, 7.0, 0.0, 12.0);
  const SceneRenderer renderer(scene);
  const RenderSettings settings{.width = 60,
                                .height = 60,
                                .samples_per_pixel = 1,
                                .filter = PixelFilter::Kind::kBox,
                                .air_nodes = 8,
                                .layers = {PictureLayer::kDepth, PictureLayer::kSunVisibility}};
  const UtcTime sunrise =
      *FindSunEvent(SunEvent::kSunrise, scene.place, ParseInstant("2026-01-01T03:00:00Z"));
  const auto lit_share = [&](const HdrImage& image, int first_row, int last_row) {
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
  // From 3776 m the sea horizon is 2 degrees lower, which the sun climbs in ten minutes.
  const HdrImage lit = renderer.Render(AddSeconds(sunrise, -300.0), settings);
  EXPECT_GT(lit_share(lit, 0, 30), 0.01) << "the summit catches the sun";
  EXPECT_EQ(lit_share(lit, 40, 60), 0.0) << "the foot lies in shadow";
  EXPECT_EQ(lit_share(renderer.Render(AddSeconds(sunrise, -900.0), settings), 0, 60), 0.0)
      << "the sun is under the summit's horizon";
}

// Hard case 22.
TEST(Render, IlluminanceFallsSmoothlyFromNoonIntoTheNight) {
  const SceneRenderer renderer(QuickScene(2.0, 0.0, 0.0, 60.0));
  const UtcTime noon = ParseInstant("2026-06-21T11:30:00Z");
  const double at_noon = renderer.Illuminance(noon);
  EXPECT_GT(at_noon, 90e3) << "a clear June noon at 46.5 degrees: about 110 klx";
  EXPECT_LT(at_noon, 130e3);
  double before = std::log2(renderer.Illuminance(ParseInstant("2026-06-21T17:00:00Z")));
  double step_before = 0.0;
  for (int minute = 1; minute <= 340; ++minute) {
    const UtcTime instant{61212, 17.0 * 3600.0 + 60.0 * minute};
    const double stops = std::log2(renderer.Illuminance(instant));
    EXPECT_LT(stops, before) << minute << " minutes after 17:00 UTC";
    if (minute > 1) {
      EXPECT_NEAR(stops - before, step_before, 0.05) << "no flicker, " << minute << " minutes";
    }
    step_before = stops - before;
    before = stops;
  }
}

TEST(Render, TheScotopicLayerIsThatOfTheRods) {
  const SceneRenderer renderer(QuickScene(1000.0, 180.0, 20.0, 40.0));
  RenderSettings settings = kSmall;
  settings.layers = {PictureLayer::kScotopic};
  const HdrImage image = renderer.Render(ParseInstant("2026-06-21T10:00:00Z"), settings);
  ASSERT_EQ(image.layers.size(), 1U);
  EXPECT_EQ(image.layers[0].name, kScotopicChannel);
  for (std::size_t i = 0; i < image.rgb.size(); ++i) {
    const double ratio = static_cast<double>(image.layers[0].values[i]) / Luminance(image.rgb[i]);
    EXPECT_GT(ratio, 2.3) << "a blue sky has S/P 2.5 to 3.5";
    EXPECT_LT(ratio, 4.0);
  }
}

const UtcTime kPolarisedMorning = ParseInstant("2026-06-21T06:00:00Z");

HdrImage Through(Scene scene, std::optional<double> polariser_deg, int width, int height,
                 const std::vector<PictureLayer>& layers = {}) {
  if (polariser_deg) scene.camera.polariser_rad = *polariser_deg * kRadiansPerDegree;
  return SceneRenderer(scene).Render(kPolarisedMorning, {.width = width,
                                                         .height = height,
                                                         .samples_per_pixel = 1,
                                                         .air_nodes = 12,
                                                         .layers = layers});
}

TEST(Polariser, HalvesUnpolarisedLightToTheLastBit) {
  Scene scene = QuickScene(300.0, 60.0, 0.0, 90.0);
  scene.medium.polarised = false;
  const HdrImage bare = Through(scene, std::nullopt, 16, 9);
  const HdrImage through = Through(scene, 30.0, 16, 9);
  for (std::size_t i = 0; i < bare.rgb.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(through.rgb[i][c], 0.5F * bare.rgb[i][c]);
  }
}

TEST(Polariser, AirWithoutPolarisationHasTheSameLight) {
  const Medium earth = MediumPreset("earth", {450.0, 650.0});
  const SingleScattering<float> air(earth);
  const MultipleScattering multiple_scattering(earth,
                                               {.altitudes = 6, .sun_angles = 8, .degree = 2});
  const AerialPerspective aerial(air, multiple_scattering);
  const ViewRay ray = RayFromAngles(2.0, 60.0, 80.0, 70.0);
  const AirAlongRay without = aerial.Along(ray, AerialPerspective::Nodes{});
  const AirAlongRay with = aerial.Along(ray, AerialPerspective::Nodes{.polarised = true});
  EXPECT_FALSE(without.polarised.has_value());
  EXPECT_EQ(without.inscatter, with.inscatter);
  ASSERT_TRUE(with.polarised.has_value());
  EXPECT_GT(std::hypot(with.polarised->q[0], with.polarised->u[0]), 0.3F * with.inscatter[0]);
}

/// A direction of a panorama that looks north, and the picture's axes there (east, north, up).
struct Seen {
  glm::dvec3 view, up, right;
};

Seen SeenAt(int x, int y, int width, int height) {
  const double azimuth = 2.0 * kPi * ((x + 0.5) / width - 0.5);
  const double elevation = kPi * (0.5 - (y + 0.5) / height);
  const double se = std::sin(elevation), ce = std::cos(elevation);
  const double sa = std::sin(azimuth), ca = std::cos(azimuth);
  return {{ce * sa, ce * ca, se}, {-se * sa, -se * ca, ce}, {ca, -sa, 0.0}};
}

// The test compares all directions, on both sides of the sun.
TEST(Polariser, LightOfTheSkyVibratesAcrossThePlaneOfTheSun) {
  constexpr int kWidth = 24, kHeight = 12;
  Scene scene = BareScene(30.0, 0.0, 0.0, 360.0);
  scene.ground.kind = GroundCover::Kind::kWater;
  const auto through = [&](std::optional<double> angle) {
    return Through(scene, angle, kWidth, kHeight);
  };
  const HdrImage upright = through(0.0), level = through(90.0), right = through(45.0),
                 left = through(-45.0);
  const HdrImage bare =
      Through(scene, std::nullopt, kWidth, kHeight,
              {PictureLayer::kStokesQ, PictureLayer::kStokesU, PictureLayer::kPolarisation});
  const auto layer = [&](std::size_t channel, int x, int y) {
    return bare.layers[channel].values[static_cast<std::size_t>(y * kWidth + x)];
  };
  const SunInSky sun = ApparentSunAt(scene.place, kPolarisedMorning);
  const glm::dvec3 to_sun{std::cos(sun.elevation_rad()) * std::sin(sun.azimuth_rad()),
                          std::cos(sun.elevation_rad()) * std::cos(sun.azimuth_rad()),
                          std::sin(sun.elevation_rad())};
  int compared = 0;
  double strongest = 0.0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const double whole = Luminance(bare.at(x, y));
      const double q = Luminance(upright.at(x, y)) - Luminance(level.at(x, y));
      const double u = Luminance(right.at(x, y)) - Luminance(left.at(x, y));
      EXPECT_NEAR(Luminance(upright.at(x, y)) + Luminance(level.at(x, y)), whole, 1e-6 * whole);
      EXPECT_NEAR(Luminance(right.at(x, y)) + Luminance(left.at(x, y)), whole, 1e-6 * whole);
      const double degree = std::hypot(q, u) / whole;
      EXPECT_LT(degree, 1.0);
      EXPECT_NEAR(Luminance({layer(0, x, y), layer(1, x, y), layer(2, x, y)}), q, 1e-5 * whole);
      EXPECT_NEAR(Luminance({layer(3, x, y), layer(4, x, y), layer(5, x, y)}), u, 1e-5 * whole);
      EXPECT_NEAR(static_cast<double>(layer(6, x, y)), degree, 1e-4);
      const Seen seen = SeenAt(x, y, kWidth, kHeight);
      if (seen.view.z < 0.2 || std::abs(glm::dot(seen.view, to_sun)) > 0.5) continue;
      const double angle = static_cast<double>(layer(7, x, y)) * kRadiansPerDegree;
      EXPECT_NEAR(std::remainder(angle - 0.5 * std::atan2(u, q), kPi), 0.0, 1e-3);
      const glm::dvec3 vibrates = std::cos(angle) * seen.up + std::sin(angle) * seen.right;
      EXPECT_LT(std::abs(glm::dot(vibrates, to_sun)), std::sin(5.0 * kRadiansPerDegree))
          << "pixel " << x << ", " << y
          << ": light scattered again turns it by degrees, a wrong sign by tens";
      EXPECT_GT(degree, 0.3);
      strongest = std::max(strongest, degree);
      ++compared;
    }
  }
  EXPECT_GT(compared, 50);
  EXPECT_GT(strongest, 0.6) << "of pixels 15 degrees wide, in air of little haze over a sea";
  EXPECT_LT(strongest, 0.85) << "Coulson (1988): the clearest air of mountains";
}

TEST(Polariser, RemovesReflectionsOfTheSeaAtBrewstersAngle) {
  Scene scene = BareScene(5.0, 240.0, -36.7, 4.0);
  scene.ground.kind = GroundCover::Kind::kWater;
  scene.ground.wind_m_per_s = 1.0;
  const auto red = [&](double angle) {  // water itself sends none
    const HdrImage image = Through(scene, angle, 4, 4);
    double sum = 0.0;
    for (const auto& pixel : image.rgb) sum += static_cast<double>(pixel[0]);
    return sum;
  };
  EXPECT_LT(red(0.0), 0.2 * red(90.0)) << "waves tilt the surface by 5 degrees and more";
}

TEST(PictureLayers, EveryLayerHasANameChannelsAndOneFunction) {
  ASSERT_EQ(LayerNames().size(), 14U);
  for (const std::string& name : LayerNames()) {
    const PictureLayer layer = LayerFromName(name);
    const LayerKind& kind = KindOf(layer);
    EXPECT_EQ(kind.layer, layer);
    EXPECT_EQ(NameOf(layer), name);
    EXPECT_NE(kind.of_middle == nullptr, kind.of_rays == nullptr) << name;
    for (const std::string& channel : kind.channels)
      EXPECT_EQ(channel.find(name + "."), 0U) << channel;
    EXPECT_LE(kind.channels.size(), LayerValues{}.size());
  }
  EXPECT_THROW((void)LayersFromNames({"depth", "dept"}), InputError);
}

TEST(PictureLayers, FactorsOfRedLightAreNotNegative) {
  const Medium earth = MediumPreset("earth");
  const BandColour colour(earth.wavelengths_nm);
  Shaded ray;
  ray.radiance = ray.transmittance = ray.albedo = ray.clouds =
      Spectrum(colour.wavelengths_nm().size());
  ray.transmittance[ray.transmittance.size() - 1] = 0.9F;  // as if through a red filter
  ray.albedo[1] = 0.9F;                                    // or a green one
  PixelSum pixel;
  pixel.Add(ray, true);
  for (const PictureLayer layer : {PictureLayer::kTransmittance, PictureLayer::kAlbedo}) {
    const LayerValues factor = KindOf(layer).of_rays(colour, pixel);
    for (const float value : factor) {
      EXPECT_GE(value, 0.0F) << NameOf(layer);
      EXPECT_LE(value, 1.0F) << NameOf(layer);
    }
  }
  EXPECT_GT(KindOf(PictureLayer::kTransmittance).of_rays(colour, pixel)[0], 0.3F)
      << "red stays what it is";
}

TEST(PictureLayers, CloudsHaveTheMeanOfTheirDistances) {
  const BandColour colour(MediumPreset("earth").wavelengths_nm);
  Shaded clear;
  clear.radiance = clear.clouds = Spectrum(colour.wavelengths_nm().size());
  Shaded thin = clear, thick = clear;
  thin.cloud_transmittance = 0.75F;
  thin.cloud_distance_m = 0.25F * 8000.0F;
  thick.cloud_transmittance = 0.0F;
  thick.cloud_distance_m = 3000.0F;
  std::ranges::fill(thick.clouds.values(), 1.0F);
  PixelSum pixel;
  pixel.Add(clear, true);
  const LayerValues without = KindOf(PictureLayer::kClouds).of_rays(colour, pixel);
  EXPECT_EQ(without[3], 1.0F);
  EXPECT_TRUE(std::isinf(without[4])) << "without clouds there is no distance";
  for (const Shaded& ray : {thin, thick, thick}) pixel.Add(ray, true);
  const LayerValues mean = KindOf(PictureLayer::kClouds).of_rays(colour, pixel);
  EXPECT_FLOAT_EQ(mean[3], 0.4375F);
  // Clouds take 0.25, 1 and 1 of the light, at 8, 3 and 3 km.
  EXPECT_FLOAT_EQ(mean[4], (0.25F * 8000.0F + 2.0F * 3000.0F) / 2.25F);
  EXPECT_FLOAT_EQ(mean[1], 0.5F * static_cast<float>(colour.LinearSrgb(thick.clouds)[1]))
      << "two of four rays have light";
}

/// Returns the sky from 100 km up, 8.5 degrees below the horizontal and 84 degrees beside the sun,
/// which is 15 degrees down: the light that ozone leaves in the planet's shadow.
std::vector<double> DeepTwilight(const Medium& medium) {
  const SingleScattering<float> air(medium);
  const MultipleScattering multiple_scattering(medium);
  const double down = -8.5 * kRadiansPerDegree, sun = -15.0 * kRadiansPerDegree;
  const double nu = std::sin(down) * std::sin(sun) +
                    std::cos(down) * std::cos(sun) * std::cos(84.0 * kRadiansPerDegree);
  const AirAlongRay seen = AerialPerspective(air, multiple_scattering)
                               .Along({100e3, std::sin(down), std::sin(sun), nu}, {.sky = 12});
  std::vector<double> radiance;
  for (std::size_t band = 0; band < seen.inscatter.size(); ++band) {
    radiance.push_back(static_cast<double>(seen.inscatter[band]) * medium.solar_irradiance[band]);
  }
  return radiance;
}

TEST(PictureLayers, DeepTwilightIsBluerThanSrgb) {
  // A negative channel is due to the gamut, not to rounding: on 16 bands the blue there is
  // (-2.4e-5, 1.4e-3, 8.1e-3) cd/m^2, and all radiances are positive.
  const Medium fine = *OnBands(MediumPreset("earth"), 16);
  const std::vector<double> radiance = DeepTwilight(fine);
  for (const double band : radiance) EXPECT_GT(band, 0.0);
  const BandColour colour(fine.wavelengths_nm);
  const auto rgb = colour.LinearSrgb(radiance);
  EXPECT_LT(rgb[0], 0.0);
  EXPECT_GT(rgb[0], -0.01 * rgb[2]) << "just outside";
  EXPECT_GT(colour.Xyz(radiance)[1], 0.0) << "its luminance is that of light";
}

TEST(PictureLayers, LightOfOneBandAloneHasLuminance) {
  // With more bands, each is narrower than the eye's. Their rows are fitted to spectra of daylight,
  // and some ends of the spectrum have a slightly negative weight.
  for (const int bands : {3, 4, 5, 6}) {
    const BandColour colour(WavelengthSet(bands));
    for (std::size_t band = 0; band < colour.wavelengths_nm().size(); ++band) {
      std::vector<double> alone(colour.wavelengths_nm().size(), 0.0);
      alone[band] = 1.0;
      EXPECT_GT(colour.Xyz(alone)[1], 0.0) << colour.wavelengths_nm()[band] << " nm of " << bands;
    }
  }
}

TEST(RecentSunlight, IsKeptForTheLastTwoSuns) {
  const SceneGround ground = LoadGround(QuickScene(2.0, 0.0, 0.0, 60.0));
  RecentSunlight recent(ground);
  constexpr double kRadius = 4.6e-3;
  const auto at = [&](double elevation_deg, double radius) {
    return recent.At(EnuFromAngles(elevation_deg * kRadiansPerDegree, 1.0).xyz, radius).sunlight;
  };
  const auto first = at(10.0, kRadius), second = at(11.0, kRadius);
  EXPECT_NE(first, second);
  EXPECT_EQ(at(10.0, kRadius), first);
  EXPECT_EQ(at(11.0, kRadius), second);
  EXPECT_NE(at(11.0, 2.0 * kRadius), second) << "a larger disk";
  EXPECT_NE(at(10.0, kRadius), first) << "only two are kept";
}

}  // namespace
}  // namespace alpenglow::renderer
