// SPDX-License-Identifier: MIT
#include "lut/image/development.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lut/image/look.h"

namespace alpenglow::lut {
namespace {

constexpr std::array<float, 3> kSky{3000.0F, 6000.0F, 12000.0F};
constexpr float kDisk = 1e9F, kWhite = 4e4F;

/// The share of a pixel that a disk in the middle of a picture covers, by 32x32 rays.
float CoveredShare(int x, int y, double middle, double radius) {
  constexpr int kRays = 32;
  int covered = 0;
  for (int j = 0; j < kRays; ++j) {
    for (int i = 0; i < kRays; ++i) {
      const double dx = x + (i + 0.5) / kRays - middle, dy = y + (j + 0.5) / kRays - middle;
      if (std::hypot(dx, dy) < radius) ++covered;
    }
  }
  return static_cast<float>(covered) / (kRays * kRays);
}

/// A white disk before a sky; every pixel is the mean of its light.
Image DiskBeforeSky(int side, double radius) {
  Image image(side, side);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const float share = CoveredShare(x, y, 0.5 * side, radius);
      for (std::size_t c = 0; c < 3; ++c)
        image.at(x, y)[c] = share * kDisk + (1.0F - share) * kSky[c];
    }
  }
  return image;
}

TEST(ClippedEdge, APixelIsTheMixtureOfDiskAndSkyThatItCovers) {
  for (const double radius : {2.5, 5.3, 11.7}) {
    const Image image = DiskBeforeSky(32, radius);
    int edges = 0;
    for (int y = 0; y < 32; ++y) {
      for (int x = 0; x < 32; ++x) {
        const float share = CoveredShare(x, y, 16.0, radius);
        const auto edge = ClippedEdgeAt(image, x, y, kWhite);
        if (share < 0.01F || share > 0.99F) continue;
        ++edges;
        ASSERT_TRUE(edge.has_value()) << radius << ' ' << x << ' ' << y;
        EXPECT_NEAR(edge->share, share, 1e-3F);
        EXPECT_NEAR(edge->beside[2], kSky[2], 1e-5F * kSky[2]);
      }
    }
    EXPECT_GT(edges, 8) << radius;
  }
}

TEST(ClippedEdge, BesideADiskThatARidgeCutsIsTheLandAlongTheRidgeAndTheSkyElsewhere) {
  constexpr std::array<float, 3> kLand{400.0F, 300.0F, 200.0F};
  constexpr int kRidge = 18;  // land from this row on, which is half in the sky
  Image image = DiskBeforeSky(32, 9.0);
  for (int x = 0; x < 32; ++x) {
    for (std::size_t c = 0; c < 3; ++c)
      image.at(x, kRidge)[c] = 0.5F * (image.at(x, kRidge)[c] + kLand[c]);
    for (int y = kRidge + 1; y < 32; ++y) image.at(x, y) = kLand;
  }
  for (const int x : {13, 15, 16, 18}) {
    const auto on_ridge = ClippedEdgeAt(image, x, kRidge, kWhite);
    ASSERT_TRUE(on_ridge.has_value());
    EXPECT_NEAR(on_ridge->beside[2], kLand[2], 0.01F * kLand[2]) << x;
    EXPECT_NEAR(on_ridge->share, 0.5F, 1e-3F) << x;
  }
  const auto on_top = ClippedEdgeAt(image, 15, 7, kWhite);
  ASSERT_TRUE(on_top.has_value());
  EXPECT_NEAR(on_top->beside[2], kSky[2], 1e-5F * kSky[2]);
}

TEST(ClippedEdge, ADarkLimbIsNoMissingCover) {
  // 0.3 + 0.93 mu - 0.23 mu^2, the sun in green light (Allen 1973), at the middle of each pixel.
  for (const double radius : {8.3, 11.7, 15.2}) {
    Image image = DiskBeforeSky(36, radius);
    for (int y = 0; y < 36; ++y) {
      for (int x = 0; x < 36; ++x) {
        const double rho = std::min(std::hypot(x - 17.5, y - 17.5) / radius, 0.99);
        const double mu = std::sqrt(1.0 - rho * rho);
        for (float& channel : image.at(x, y)) {
          if (channel > kWhite) channel *= static_cast<float>(0.3 + 0.93 * mu - 0.23 * mu * mu);
        }
      }
    }
    for (int y = 0; y < 36; ++y) {
      for (int x = 0; x < 36; ++x) {
        const auto edge = ClippedEdgeAt(image, x, y, kWhite);
        if (!edge) continue;
        EXPECT_NEAR(edge->share, CoveredShare(x, y, 18.0, radius), 0.16F)
            << "a limb that is not followed is off by 0.35: " << radius << ' ' << x << ' ' << y;
      }
    }
  }
}

TEST(ClippedEdge, ADisksEdgeIsSmoothOnTheDisplay) {
  const Image image = DiskBeforeSky(32, 7.5);
  const DisplayImage shown = Develop(image, 15.0, ToneCurve::kAgx);
  const auto blue_less_red = [&](int x, int y) {
    const std::size_t at = 3 * static_cast<std::size_t>(y * 32 + x);
    return static_cast<int>(shown.rgb[at + 2]) - static_cast<int>(shown.rgb[at]);
  };
  const int sky = blue_less_red(0, 0), disk = blue_less_red(16, 16);
  int between = 0, partly = 0;
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) {
      const float share = CoveredShare(x, y, 16.0, 7.5);
      if (share < 0.2F || share > 0.8F) continue;
      ++partly;
      const int here = blue_less_red(x, y);
      if (here > disk + (sky - disk) / 8 && here < sky - (sky - disk) / 8) ++between;
    }
  }
  EXPECT_GT(partly, 10);
  EXPECT_EQ(between, partly) << "none of them is as white as the disk, none as blue as the sky";
}

// The aureole is as bright at the disk as a share of white, `fades_in` pixels farther out a third of that.
Image DiskInAnAureole(double radius, float of_white, double fades_in) {
  Image image = DiskBeforeSky(32, radius);
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) {
      const double out = std::hypot(x - 15.5, y - 15.5) - radius;
      const float glow =
          of_white * kWhite * static_cast<float>(std::exp(-std::max(out, 0.0) / fades_in));
      for (float& channel : image.at(x, y)) channel += glow;
    }
  }
  return image;
}

// The curve is stood for by its clipping. A ring would be a third darker: what lies three pixels
// behind. The sky under a sun that sets fades in four pixels of a wide picture.
TEST(ClippedEdge, ASteepAureoleHasNoDarkRingAtTheDisk) {
  constexpr double kRadius = 2.5;
  for (const double fades_in : {6.0, 4.0}) {
    for (const float of_white : {0.2F, 0.6F, 1.0F, 1.5F}) {
      const Image image = DiskInAnAureole(kRadius, of_white, fades_in);
      for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 32; ++x) {
          if (CoveredShare(x, y, 16.0, kRadius) > 0.0F) continue;
          const auto edge = ClippedEdgeAt(image, x, y, kWhite);
          if (!edge) continue;
          const float pixel = std::min(image.at(x, y)[1], kWhite);
          const float mixed = std::min(edge->share * std::min(edge->light[1], kWhite) +
                                           (1.0F - edge->share) * edge->beside[1],
                                       kWhite);
          EXPECT_GT(edge->weight * mixed + (1.0F - edge->weight) * pixel, 0.88F * pixel)
              << of_white << ' ' << fades_in << ' ' << x << ' ' << y;
        }
      }
    }
  }
}

TEST(ClippedEdge, SparklesAndPlainSkyAreNone) {
  Image image = DiskBeforeSky(32, 0.0);
  image.at(10, 10) = {kDisk, kDisk, kDisk};
  image.at(20, 21) = {kDisk, kDisk, kDisk};
  image.at(21, 20) = {kDisk, kDisk, kDisk};
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) EXPECT_FALSE(ClippedEdgeAt(image, x, y, kWhite)) << x << ' ' << y;
  }
}

TEST(ClippedEdge, NothingJumpsWhileADiskGrowsDimmer) {
  const Image image = DiskBeforeSky(32, 7.5);
  int last = -1;
  for (double ev100 = 30.0; ev100 > 10.0; ev100 -= 0.125) {
    const DisplayImage shown = Develop(image, ev100, ToneCurve::kAgx);
    const int here = shown.rgb[3 * (16 * 32 + 23) + 1];  // half of it covered
    if (last >= 0) {
      EXPECT_NEAR(here, last, 14) << ev100 << ": an eighth of a stop is 10 codes";
    }
    last = here;
  }
}

TEST(ClippedEdge, ALightThatACurveHoldsIsLeftAsItIs) {
  const Image image = DiskBeforeSky(32, 8.0);
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) EXPECT_FALSE(ClippedEdgeAt(image, x, y, kDisk)) << x << ' ' << y;
  }
}

}  // namespace
}  // namespace alpenglow::lut
