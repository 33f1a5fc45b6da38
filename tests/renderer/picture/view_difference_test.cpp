// SPDX-License-Identifier: MIT
#include "renderer/picture/picture_layers.h"

#include <gtest/gtest.h>

#include <cmath>

#include "atmosphere/base/error.h"
#include "tests/fixtures/flat_picture.h"

namespace alpenglow::renderer {
namespace {

constexpr int kLandSide = 10;

/// An even grey of land a kilometre away, all of it in the sun.
HdrImage EvenLand() {
  HdrImage image = tests::FlatPicture(kLandSide, kLandSide, 100.0F);
  image.layers = {{kDepthChannel, std::vector<float>(kLandSide * kLandSide, 1000.0F)},
                  {"sun_visibility.Y", std::vector<float>(kLandSide * kLandSide, 1.0F)}};
  return image;
}

std::size_t At(int x, int y) { return static_cast<std::size_t>(y * kLandSide + x); }

int EdgeCount(const std::vector<bool>& edges) {
  int count = 0;
  for (const bool is_edge : edges) count += is_edge ? 1 : 0;
  return count;
}

TEST(ViewDifference, EvenLandHasNoEdges) { EXPECT_EQ(EdgeCount(EdgesOf(EvenLand())), 0); }

TEST(ViewDifference, PixelsBesideRidgeSkylineAndShadowAreEdges) {
  HdrImage ridge = EvenLand(), skyline = EvenLand(), shadow = EvenLand();
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < kLandSide; ++x) {
      ridge.layers[0].values[At(x, y)] = 1200.0F;
      skyline.layers[0].values[At(x, y)] = INFINITY;
      shadow.layers[1].values[At(x, y)] = 0.8F;
    }
  }
  for (const HdrImage& image : {ridge, skyline, shadow}) {
    const std::vector<bool> edges = EdgesOf(image);
    EXPECT_EQ(EdgeCount(edges), 2 * kLandSide) << "the rows on both sides";
    EXPECT_TRUE(edges[At(3, 4)]);
    EXPECT_TRUE(edges[At(3, 5)]);
  }
}

TEST(ViewDifference, RecedingLandAndSkyAreNoEdges) {
  HdrImage image = EvenLand();
  for (int y = 0; y < kLandSide; ++y) {
    for (int x = 0; x < kLandSide; ++x)
      image.layers[0].values[At(x, y)] = 1000.0F * std::pow(1.04F, static_cast<float>(y));
  }
  EXPECT_EQ(EdgeCount(EdgesOf(image)), 0);
  image.layers[0].values.assign(kLandSide * kLandSide, INFINITY);
  EXPECT_EQ(EdgeCount(EdgesOf(image)), 0);
}

TEST(ViewDifference, OfAKnownDifferenceHasTheKnownNumbers) {
  const HdrImage reference = EvenLand();
  HdrImage painted = reference;
  EXPECT_EQ(DifferenceOf(reference, painted).Largest(), 0.0);
  for (int i = 0; i < 50; ++i) painted.rgb[static_cast<std::size_t>(i)] = {101.0F, 101.0F, 101.0F};
  const double one_percent = 1.0 / 100.5;
  const ErrorStatistics half = DifferenceOf(reference, painted);
  EXPECT_NEAR(half.mean(), 0.5 * one_percent, 1e-7) << "half of the pixels; floats of 100";
  EXPECT_NEAR(half.Quantile(0.99), one_percent, 1e-7);
  EXPECT_NEAR(half.Largest(), one_percent, 1e-7);
  EXPECT_EQ(half.count(), reference.rgb.size());
}

TEST(ViewDifference, DifferencesBesideAnEdgeAreIgnored) {
  HdrImage reference = EvenLand();
  reference.layers[0].values[At(5, 5)] = INFINITY;
  HdrImage painted = reference;
  painted.rgb[At(4, 6)] = {0.0F, 0.0F, 0.0F};
  const ErrorStatistics is = DifferenceOf(reference, painted);
  EXPECT_EQ(is.Largest(), 0.0);
  EXPECT_EQ(is.count(), 91U) << "a pixel and its neighbours of a hundred are left out";
}

TEST(ViewDifference, WithoutLayersPicturesCannotBeCompared) {
  const HdrImage bare(kLandSide, kLandSide);
  EXPECT_THROW(static_cast<void>(EdgesOf(bare)), InternalError);
  EXPECT_THROW(static_cast<void>(DifferenceOf(EvenLand(), HdrImage(3, 3))), InternalError);
}

}  // namespace
}  // namespace alpenglow::renderer
