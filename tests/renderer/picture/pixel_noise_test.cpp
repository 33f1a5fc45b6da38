// SPDX-License-Identifier: MIT
// The noise of pixels, and rays that neighbouring pixels share.
#include "renderer/picture/shared_samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <string>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "renderer/effects/effect_choice.h"
#include "renderer/picture/render.h"
#include "tests/fixtures/bare_scene.h"
#include "tests/fixtures/effect_scenes.h"
#include "tests/fixtures/luminance.h"
#include "tests/fixtures/sanitized.h"
#include "tests/fixtures/temporary_folder.h"
#include "tests/fixtures/thread_counts.h"
#include "tests/renderer/picture/sun_seen.h"

namespace alpenglow::renderer {
namespace {

TEST(RaySpread, IsTheVarianceOfColoursRelativeToTheirMean) {
  RaySpread spread;
  EXPECT_EQ(spread.RelativeVariance(0.0), 0.0) << "of nothing";
  spread.Add({3.0, 0.0, 4.0});
  EXPECT_EQ(spread.RelativeVariance(0.0), 0.0) << "of one ray";
  spread.Add({3.0, 0.0, 4.0});
  spread.Add({6.0, 0.0, 8.0});
  // The lengths are 5, 5, 10, all in one direction: mean 20 / 3, variance 25 / 3.
  EXPECT_NEAR(spread.RelativeVariance(0.0), 25.0 / 3.0 / (400.0 / 9.0), 1e-12);
  EXPECT_NEAR(spread.RelativeVariance(20.0), 25.0 / 3.0 / 400.0, 1e-12) << "darker than the floor";
  RaySpread dark;
  for (int i = 0; i < 4; ++i) dark.Add({0.0, 0.0, 0.0});
  EXPECT_EQ(dark.RelativeVariance(0.0), 0.0);
}

TEST(RaySpread, SpreadOfSeveralPixelsIsThatOfAllTheirRays) {
  RaySpread all, left, right;
  const auto add = [&](RaySpread& spread, const std::array<double, 3>& rgb) {
    spread.Add(rgb);
    all.Add(rgb);
  };
  add(left, {1.0, 2.0, 3.0});
  add(left, {2.0, 2.5, 1.0});
  add(left, {0.5, 0.25, 4.0});
  add(right, {9.0, 8.0, 7.0});
  add(right, {5.0, 8.5, 6.0});
  RaySpread merged;
  for (const RaySpread& part : {left, RaySpread{}, right}) merged.Add(part);
  EXPECT_NEAR(merged.RelativeVariance(0.0), all.RelativeVariance(0.0), 1e-14);
  EXPECT_GT(merged.RelativeVariance(0.0), 0.1);
}

TEST(RaysForNoise, GrowInPowersOfTwoUntilTheNoiseIsReached) {
  EXPECT_EQ(RaysForNoise(0.0, 0.01, 4, 256), 4);
  EXPECT_EQ(RaysForNoise(1e9, 0.01, 4, 256), 256);
  EXPECT_EQ(RaysForNoise(1e9, 0.01, 3, 256), 192) << "not more than the most";
  EXPECT_EQ(RaysForNoise(1e9, 0.01, 512, 512), 512);
  for (const double variance : {1e-4, 1e-3, 1e-2, 1e-1}) {
    const int rays = RaysForNoise(variance, 0.02, 4, 1024);
    EXPECT_LE(std::sqrt(variance) * std::pow(rays, -0.7), 0.02) << variance;
    if (rays == 4) continue;
    EXPECT_GT(std::sqrt(variance) * std::pow(0.5 * rays, -0.7), 0.02) << variance;
  }
}

const UtcTime kEvening = ParseInstant("2026-06-21T17:40:00Z");

class NoisyPicture : public TemporaryFolder {
 protected:
  /// Returns ridges before an evening sky, seen along the boundary of shade and light.
  const SceneRenderer& Ridges() {
    static const SceneRenderer kRenderer([&] {
      const std::string file = (folder_ / "ridges.tif").string();
      WriteRidges(file);
      return RidgeScene(file, {400.0, true}, 300.0, 0.0, 40.0);
    }());
    return kRenderer;
  }

  /// Returns the picture of 256 rays per pixel.
  const HdrImage& Truth() {
    static const HdrImage kTruth = Ridges().Render(kEvening, Small(256));
    return kTruth;
  }
  static RenderSettings Small(int rays) {
    return {.width = 32, .height = 18, .samples_per_pixel = rays, .air_nodes = 8, .layers = {}};
  }
  static RenderSettings Held(double noise) {
    RenderSettings settings = Small(4);
    settings.noise = noise;
    return settings;
  }
};

TEST_F(NoisyPicture, NoiseIsWithinTheLimitAndBelowThatOfEqualRays) {
  const HdrImage& truth = Truth();
  const CountedPicture held = Ridges().RenderCounted(kEvening, Held(0.03));
  const double noise = ChangeOf(truth, held.image).Rms();
  const auto as_many = static_cast<int>(held.rays.rays / (32U * 18U)) + 1;
  const CountedPicture even = Ridges().RenderCounted(kEvening, Small(as_many));
  EXPECT_LT(noise, 0.03);
  EXPECT_LT(noise, ChangeOf(truth, even.image).Rms());
  EXPECT_LT(held.rays.rays, even.rays.rays);
}

TEST_F(NoisyPicture, ReportsItsNumberOfRays) {
  // A pixel is 1.3 degrees wide: between neighbours a clear sky changes by some per cent.
  RenderSettings settings = Held(0.05);
  settings.layers = {PictureLayer::kRays};
  const CountedPicture held = Ridges().RenderCounted(kEvening, settings);
  const std::vector<float>& rays = held.image.layers.front().values;
  double sum = 0.0;
  for (const float count : rays) sum += static_cast<double>(count);
  EXPECT_EQ(static_cast<double>(held.rays.rays), sum);
  EXPECT_EQ(held.rays.least, 2U);
  EXPECT_EQ(static_cast<float>(held.rays.most), *std::max_element(rays.begin(), rays.end()));
  EXPECT_EQ(rays.front(), 2.0F) << "a clear sky, some pixels over a ridge";
  const RayCount even = Ridges().RenderCounted(kEvening, Small(3)).rays;
  EXPECT_EQ(even.rays, 3U * 32U * 18U);
  EXPECT_EQ(even.least, even.most);
}

TEST_F(NoisyPicture, IsTheSameBytesForAnyNumberOfThreads) {
  RenderSettings settings = Held(0.05);
  settings.width = 48;  // more than one tile
  static_cast<void>(
      tests::SameForAnyNumberOfThreads([&] { return Ridges().Render(kEvening, settings); }));
}

TEST_F(NoisyPicture, HasTheBrightnessOfOneWithManyRays) {
  const HdrImage& truth = Truth();
  const HdrImage held = Ridges().Render(kEvening, Held(0.05));
  double difference = 0.0, light = 0.0;
  for (std::size_t i = 0; i < truth.rgb.size(); ++i) {
    difference += tests::Luminance(held.rgb[i]) - tests::Luminance(truth.rgb[i]);
    light += tests::Luminance(truth.rgb[i]);
  }
  EXPECT_LT(std::abs(difference / light), 1e-3) << "5 % in a tenth of 576 pixels: 7e-4 by chance";
}

TEST_F(NoisyPicture, SharedAirIsThatOfEachPixel) {
  // Every pixel has the largest number of rays, with air of its own or shared.
  RenderSettings settings = Small(kMostRaysForNoise);
  settings.layers = {PictureLayer::kInscatter};
  settings.noise = 1e-8;
  const HdrImage shared = Ridges().Render(kEvening, settings);
  settings.share_air_of_pixels = false;
  const HdrImage alone = Ridges().Render(kEvening, settings);
  double square = 0.0, mean = 0.0;
  for (std::size_t i = 0; i < alone.rgb.size(); ++i) {
    const double truth = static_cast<double>(alone.layers[1].values[i]);
    square += std::pow(static_cast<double>(shared.layers[1].values[i]) - truth, 2);
    mean += truth;
  }
  const auto pixels = static_cast<double>(alone.rgb.size());
  EXPECT_GT(square, 0.0) << "some cells are smooth";
  EXPECT_LT(std::sqrt(square / pixels) / (mean / pixels), 1e-3)
      << "cells are held to 2e-3 in their middle, where they are wrong most";
}

TEST_F(NoisyPicture, HasTheSkyOfAllItsRays) {
  RenderSettings settings = Held(0.05);
  settings.width = 96;
  settings.height = 54;
  const CountedPicture skipped = Ridges().RenderCounted(kEvening, settings);
  settings.skips_open_sky = false;
  const CountedPicture traced = Ridges().RenderCounted(kEvening, settings);
  EXPECT_LT(skipped.rays.rays, traced.rays.rays - 500U);
  EXPECT_EQ(skipped.rays.least, 1U);
  for (std::size_t i = 0; i < traced.image.rgb.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(skipped.image.rgb[i][c], traced.image.rgb[i][c], 1e-5F * traced.image.rgb[i][c])
          << "one ray through the middle of a pixel and the mean of its rays: roundings";
    }
  }
}

TEST_F(NoisyPicture, TheSunsLimbCoversPartsOfPixels) {
  Scene scene = QuickScene(1000.0, 0.0, 0.0, 3.0);
  const SunInSky sun = tests::SunSeenIn(scene, kEvening);
  scene.camera =
      CameraFromDegrees({1000.0, false}, sun.azimuth_deg + 0.1, sun.elevation_deg, 0.0, 3.0);
  const SceneRenderer renderer(scene);
  const HdrImage truth = renderer.Render(kEvening, Small(tests::ScaledDown(1024, 512)));
  double brightest = 0.0;
  for (const auto& pixel : truth.rgb) brightest = std::max(brightest, tests::Luminance(pixel));
  EXPECT_GT(brightest, 1e6) << "it is there";
  const auto worst = [&](const HdrImage& image) {
    double most = 0.0;
    for (std::size_t i = 0; i < image.rgb.size(); ++i) {
      most =
          std::max(most, std::abs(tests::Luminance(image.rgb[i]) - tests::Luminance(truth.rgb[i])));
    }
    return most / brightest;
  };
  EXPECT_GT(worst(renderer.Render(kEvening, Small(4))), 0.1) << "in steps of a quarter";
  EXPECT_LT(worst(renderer.Render(kEvening, Held(0.02))), 0.015) << "256 rays across the limb";
}

TEST_F(NoisyPicture, RefusesZeroNoiseAndASingleFirstRay) {
  EXPECT_THROW((void)Ridges().Render(kEvening, Held(0.0)), InputError);
  RenderSettings settings = Held(0.01);
  settings.samples_per_pixel = 1;
  EXPECT_THROW((void)Ridges().Render(kEvening, settings), InputError)
      << "one ray says nothing of noise";
}

constexpr int kSharedSide = 7;

/// Returns pixels of a square whose rays, at places of its filter, see light(x, y).
SharedSampleFilter Seen(PixelFilter::Kind kind, int rays,
                        const std::function<double(double, double)>& light) {
  const PixelFilter filter(kind);
  SharedSampleFilter shared(filter, kSharedSide, kSharedSide, 2);
  std::minstd_rand random(7);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const auto rays_at = [&](int x, int y) { return rays * (1 + (x + y) % 3); };
  for (int y = 0; y < kSharedSide; ++y) {
    for (int x = 0; x < kSharedSide; ++x) shared.Expect(x, y, rays_at(x, y));
  }
  for (int y = 0; y < kSharedSide; ++y) {
    for (int x = 0; x < kSharedSide; ++x) {
      for (int i = 0; i < rays_at(x, y); ++i) {
        SeenRay ray{filter.Offset(uniform(random)), filter.Offset(uniform(random)), Spectrum(2)};
        ray.radiance[0] = static_cast<float>(light(x + ray.right, y + ray.down));
        ray.radiance[1] = 1.0F;
        shared.Add(x, y, ray);
      }
    }
  }
  return shared;
}

TEST(SharedSampleFilter, EvenLightStaysEven) {
  for (const auto kind : {PixelFilter::Kind::kBox, PixelFilter::Kind::kGaussian,
                          PixelFilter::Kind::kBlackmanHarris}) {
    const SharedSampleFilter shared = Seen(kind, 1, [](double, double) { return 3.0; });
    for (int y = 0; y < kSharedSide; ++y) {
      for (int x = 0; x < kSharedSide; ++x) {
        EXPECT_NEAR(shared.Light(x, y)[0], 3.0, 1e-5) << x << ' ' << y;
        EXPECT_NEAR(shared.Light(x, y)[1], 1.0, 1e-5) << "bands do not mix";
      }
    }
  }
}

TEST(SharedSampleFilter, SamplesOnASlopeNearlyEqualTheMiddle) {
  // A single ray is off by 0.43 pixels rms, four rays by 0.22 and, shared, by about 0.15. The slope
  // to the neighbours leaves a second-order error of it, because their own rays are off as well.
  const SharedSampleFilter shared = Seen(PixelFilter::Kind::kBlackmanHarris, 4,
                                         [](double x, double y) { return 20.0 + x - 0.5 * y; });
  double squares = 0.0;
  for (int y = 1; y + 1 < kSharedSide; ++y) {
    for (int x = 1; x + 1 < kSharedSide; ++x)
      squares += std::pow(static_cast<double>(shared.Light(x, y)[0]) - (20.0 + x - 0.5 * y), 2);
  }
  EXPECT_LT(std::sqrt(squares / ((kSharedSide - 2) * (kSharedSide - 2))), 0.05);
}

TEST(SharedSampleFilter, ManySamplesNearlyEqualTheFilteredLight) {
  // The mean of x^2 over the filter is x^2 and its variance, 0.186 for each axis. 2000 rays and
  // those of neighbours have an error of 0.02.
  const PixelFilter filter(PixelFilter::Kind::kBlackmanHarris);
  double variance = 0.0;
  constexpr int kParts = 1000;
  for (int i = 0; i < kParts; ++i)
    variance += std::pow(filter.Offset((i + 0.5) / kParts), 2) / kParts;
  const SharedSampleFilter shared = Seen(PixelFilter::Kind::kBlackmanHarris, 2000,
                                         [](double x, double) { return std::pow(x - 3.0, 2); });
  EXPECT_NEAR(shared.Light(3, 3)[0], variance, 0.02);
  EXPECT_NEAR(shared.Light(2, 3)[0], 1.0 + variance, 0.03);
}

TEST(SharedSampleFilter, SharesThePositionOfSkyButNotItsLight) {
  // Each row has its own sky, a quarter brighter than the row above; the lowest rows have many
  // rays.
  const auto sky_of = [](int row) { return static_cast<float>(std::pow(1.25, row)); };
  const auto rays_of = [](int row) { return row < 4 ? 4 : 256; };
  const PixelFilter filter(PixelFilter::Kind::kBlackmanHarris);
  SharedSampleFilter shared(filter, kSharedSide, kSharedSide, 1);
  std::minstd_rand random(7);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int y = 0; y < kSharedSide; ++y) {
    for (int x = 0; x < kSharedSide; ++x) shared.Expect(x, y, rays_of(y));
  }
  for (int y = 0; y < kSharedSide; ++y) {
    for (int x = 0; x < kSharedSide; ++x) {
      for (int i = 0; i < rays_of(y); ++i) {
        shared.Add(
            x, y,
            {filter.Offset(uniform(random)), filter.Offset(uniform(random)), Spectrum(1), true});
      }
      Spectrum sky(1);
      sky[0] = sky_of(y);
      if (x != 3 || y != 5) shared.SetSky(x, y, sky);
    }
  }
  for (int y = 0; y < kSharedSide; ++y)
    EXPECT_NEAR(shared.Light(2, y)[0], sky_of(y), 1e-5F * sky_of(y));
  const float around = (sky_of(4) * 3.0F + sky_of(5) * 2.0F + sky_of(6) * 3.0F) / 8.0F;
  EXPECT_NEAR(shared.Light(3, 5)[0], around, 1e-5F) << "has no sky of its own";
}

TEST(SharedSampleFilter, StaysPositiveNextToVeryBrightLight) {
  const SharedSampleFilter shared = Seen(PixelFilter::Kind::kBlackmanHarris, 4,
                                         [](double x, double) { return x > 3.2 ? 1e6 : 1.0; });
  for (int y = 0; y < kSharedSide; ++y) {
    for (int x = 0; x < kSharedSide; ++x) EXPECT_GT(shared.Light(x, y)[0], 0.5F) << x << ' ' << y;
    EXPECT_NEAR(shared.Light(1, y)[0], 1.0, 1e-4) << "two pixels off no ray sees it";
  }
}

}  // namespace
}  // namespace alpenglow::renderer
