// SPDX-License-Identifier: MIT
#include "renderer/picture/shared_samples.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace alpenglow::renderer {
namespace {

constexpr int kSide = 7;

/// Pixels of a square, each with some rays where its filter sends them, that see light(x, y).
SharedSampleFilter Seen(PixelFilter::Kind kind, int rays,
                        const std::function<double(double, double)>& light) {
  const PixelFilter filter(kind);
  SharedSampleFilter shared(filter, kSide, kSide, 2);
  std::minstd_rand random(7);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const auto rays_at = [&](int x, int y) { return rays * (1 + (x + y) % 3); };
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) shared.Expect(x, y, rays_at(x, y));
  }
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      for (int i = 0; i < rays_at(x, y); ++i) {
        SeenRay ray{filter.Offset(uniform(random)), filter.Offset(uniform(random)), BandLight(2)};
        ray.radiance[0] = static_cast<float>(light(x + ray.right, y + ray.down));
        ray.radiance[1] = 1.0F;
        shared.Add(x, y, ray);
      }
    }
  }
  return shared;
}

TEST(SharedSampleFilter, OfEvenLightAreThatLight) {
  for (const auto kind : {PixelFilter::Kind::kBox, PixelFilter::Kind::kGaussian,
                          PixelFilter::Kind::kBlackmanHarris}) {
    const SharedSampleFilter shared = Seen(kind, 1, [](double, double) { return 3.0; });
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        EXPECT_NEAR(shared.Light(x, y)[0], 3.0, 1e-5) << x << ' ' << y;
        EXPECT_NEAR(shared.Light(x, y)[1], 1.0, 1e-5) << "bands do not mix";
      }
    }
  }
}

TEST(SharedSampleFilter, OfASlopeAreNearlyWhatTheMiddleSees) {
  // A ray alone is off by 0.43 pixels rms, four rays by 0.22 and, shared, by about 0.15; what the
  // slope to the neighbours leaves of it is of second order: their own rays are off as well.
  const SharedSampleFilter shared = Seen(PixelFilter::Kind::kBlackmanHarris, 4,
                                         [](double x, double y) { return 20.0 + x - 0.5 * y; });
  double squares = 0.0;
  for (int y = 1; y + 1 < kSide; ++y) {
    for (int x = 1; x + 1 < kSide; ++x)
      squares += std::pow(static_cast<double>(shared.Light(x, y)[0]) - (20.0 + x - 0.5 * y), 2);
  }
  EXPECT_LT(std::sqrt(squares / ((kSide - 2) * (kSide - 2))), 0.05);
}

TEST(SharedSampleFilter, AreNearlyTheFilterOfARefractedLightWhereManyCome) {
  // The mean of x^2 over the filter is x^2 and its variance, 0.186 for each axis. 2000 rays and those
  // of neighbours are good for 0.02.
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

TEST(SharedSampleFilter, ShareWhereTheSkyIsButNotWhichSky) {
  // Each row has its own sky, a quarter brighter than the row above, and the lowest rows many rays.
  const auto sky_of = [](int row) { return static_cast<float>(std::pow(1.25, row)); };
  const auto rays_of = [](int row) { return row < 4 ? 4 : 256; };
  const PixelFilter filter(PixelFilter::Kind::kBlackmanHarris);
  SharedSampleFilter shared(filter, kSide, kSide, 1);
  std::minstd_rand random(7);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) shared.Expect(x, y, rays_of(y));
  }
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      for (int i = 0; i < rays_of(y); ++i) {
        shared.Add(
            x, y,
            {filter.Offset(uniform(random)), filter.Offset(uniform(random)), BandLight(1), true});
      }
      BandLight sky(1);
      sky[0] = sky_of(y);
      if (x != 3 || y != 5) shared.SetSky(x, y, sky);
    }
  }
  for (int y = 0; y < kSide; ++y) EXPECT_NEAR(shared.Light(2, y)[0], sky_of(y), 1e-5F * sky_of(y));
  const float around = (sky_of(4) * 3.0F + sky_of(5) * 2.0F + sky_of(6) * 3.0F) / 8.0F;
  EXPECT_NEAR(shared.Light(3, 5)[0], around, 1e-5F) << "has no sky of its own";
}

TEST(SharedSampleFilter, StayPositiveBesideALightAMillionTimesAsBright) {
  const SharedSampleFilter shared = Seen(PixelFilter::Kind::kBlackmanHarris, 4,
                                         [](double x, double) { return x > 3.2 ? 1e6 : 1.0; });
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) EXPECT_GT(shared.Light(x, y)[0], 0.5F) << x << ' ' << y;
    EXPECT_NEAR(shared.Light(1, y)[0], 1.0, 1e-4) << "two pixels off no ray sees it";
  }
}

}  // namespace
}  // namespace alpenglow::renderer
