// SPDX-License-Identifier: MIT
#include "renderer/camera/camera_rays.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

namespace alpenglow::renderer {
namespace {

using Points = std::vector<std::array<double, 2>>;

Points OfPixel(int x, int y, int samples, SampleOf decision) {
  const PixelSamples pixel(x, y, samples);
  Points points;
  for (int s = 0; s < samples; ++s) points.push_back(pixel.Point(s, decision));
  return points;
}

/// Of an aligned square of pixels.
Points OfSquare(int x0, int y0, int side, int samples, SampleOf decision) {
  Points points;
  for (int y = y0; y < y0 + side; ++y) {
    for (int x = x0; x < x0 + side; ++x) {
      const Points more = OfPixel(x, y, samples, decision);
      points.insert(points.end(), more.begin(), more.end());
    }
  }
  return points;
}

/// Whether each of the points has a rectangle of its own, for every shape of 2^j x 2^(k - j).
bool IsNet(const Points& points) {
  const std::size_t count = points.size();
  for (std::size_t columns = 1; columns <= count; columns *= 2) {
    const std::size_t rows = count / columns;
    std::set<std::size_t> taken;
    for (const auto& [u, v] : points) {
      taken.insert(static_cast<std::size_t>(u * static_cast<double>(columns)) * rows +
                   static_cast<std::size_t>(v * static_cast<double>(rows)));
    }
    if (taken.size() != count) return false;
  }
  return true;
}

TEST(PixelSamples, OfAPixelAreOneInEveryRectangleOfEveryShape) {
  for (const SampleOf decision :
       {SampleOf::kPixel, SampleOf::kLens, SampleOf::kSunDisk, SampleOf::kTime}) {
    for (const int samples : {1, 2, 4, 16, 64, 1024}) {
      for (const int x : {0, 1, 255, 256, 16383}) {
        EXPECT_TRUE(IsNet(OfPixel(x, 77, samples, decision))) << samples << " at " << x;
      }
    }
  }
}

TEST(PixelSamples, OfAlignedSquaresOfPixelsAreOneInEveryRectangleToo) {
  for (const int side : {2, 4, 8}) {
    EXPECT_TRUE(IsNet(OfSquare(3 * side, 5 * side, side, 4, SampleOf::kPixel))) << side;
  }
}

TEST(PixelSamples, OfOtherCountsAreAsEvenAsThePowerBelow) {
  for (const int samples : {3, 9, 100}) {
    Points points = OfPixel(11, 12, samples, SampleOf::kPixel);
    points.resize(samples == 3 ? 2 : samples == 9 ? 8 : 64);
    EXPECT_TRUE(IsNet(points)) << samples;
  }
}

TEST(PixelSamples, OfDifferentDecisionsAreNotCorrelated) {
  // 64 x 64 pixels of 4 samples: chance alone gives a coefficient of 1 / sqrt(16384) = 0.008.
  const std::array<SampleOf, 4> decisions{SampleOf::kPixel, SampleOf::kLens, SampleOf::kSunDisk,
                                          SampleOf::kTime};
  for (std::size_t i = 0; i < decisions.size(); ++i) {
    for (std::size_t j = i + 1; j < decisions.size(); ++j) {
      const Points a = OfSquare(0, 0, 64, 4, decisions[i]);
      const Points b = OfSquare(0, 0, 64, 4, decisions[j]);
      for (std::size_t k = 0; k < 4; ++k) {
        double product = 0.0;
        for (std::size_t n = 0; n < a.size(); ++n) {
          product += (a[n][k / 2] - 0.5) * (b[n][k % 2] - 0.5);
        }
        EXPECT_LT(std::abs(12.0 * product / static_cast<double>(a.size())), 0.03) << i << j << k;
      }
    }
  }
}

/// Root mean square error over pixels of the mean over a pixel's samples.
template <typename Function>
double RmsError(int samples, double truth, const Function& function) {
  constexpr int kSide = 48;
  double squares = 0.0;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      double sum = 0.0;
      for (const auto& point : OfPixel(x, y, samples, SampleOf::kLens)) sum += function(point);
      squares += (sum / samples - truth) * (sum / samples - truth);
    }
  }
  return std::sqrt(squares) / kSide;
}

TEST(PixelSamples, IntegrateASmoothFunctionTenTimesBetterThanChanceWithSixteen) {
  const auto smooth = [](const std::array<double, 2>& p) { return std::exp(p[0] + p[1]); };
  const double truth = std::pow(std::exp(1.0) - 1.0, 2);
  const double variance = std::pow(0.5 * (std::exp(2.0) - 1.0), 2) - truth * truth;
  EXPECT_LT(RmsError(16, truth, smooth), 0.1 * std::sqrt(variance / 16.0))
      << "a scrambled net's error falls as n^-3/2 (Owen 1997), chance's as n^-1/2";
  EXPECT_LT(RmsError(4, truth, smooth), 0.35 * std::sqrt(variance / 4.0));
}

TEST(PixelSamples, SeeAnEdgeAsCellsThatItCrossesAllow) {
  const auto edge = [](const std::array<double, 2>& p) {
    return p[0] + 0.6 * p[1] < 0.7 ? 1.0 : 0.0;
  };
  // Under the line u = 0.7 - 0.6 v: 0.7 - 0.3.
  constexpr double kTruth = 0.4;
  for (const int samples : {16, 64}) {
    const double crossed = 1.6 * std::sqrt(samples) + 1.0;
    EXPECT_LT(RmsError(samples, kTruth, edge), std::sqrt(0.25 * crossed) / samples)
        << "only squares of 1/n that the edge crosses have a variance, at most 1/4 each";
  }
}

TEST(PixelSamples, MissTheirMeanTogetherLessThanApart) {
  // Over 2 x 2 pixels of 4 samples the error is that of 16, not half that of 4.
  const auto f = [](const std::array<double, 2>& p) { return std::exp(p[0] + p[1]); };
  const double truth = std::pow(std::exp(1.0) - 1.0, 2);
  double alone = 0.0, together = 0.0;
  for (int y = 0; y < 64; y += 2) {
    for (int x = 0; x < 64; x += 2) {
      double square = 0.0;
      for (int k = 0; k < 4; ++k) {
        double sum = 0.0;
        for (const auto& p : OfPixel(x + k % 2, y + k / 2, 4, SampleOf::kSunDisk)) sum += f(p);
        alone += (sum / 4.0 - truth) * (sum / 4.0 - truth) / 4.0;
        square += sum / 16.0;
      }
      together += (square - truth) * (square - truth);
    }
  }
  EXPECT_LT(std::sqrt(together / alone), 0.25) << "independent pixels: 0.5";
}

TEST(PixelSamples, AreTheSameOnEveryMachine) {
  const auto first = PixelSamples(0, 0, 4).Point(0, SampleOf::kPixel);
  const auto later = PixelSamples(1279, 719, 16).Point(15, SampleOf::kTime);
  constexpr double kUnit = 4294967296.0;
  EXPECT_EQ(first[0], 3773744660.0 / kUnit) << "as integers of any language compute it";
  EXPECT_EQ(first[1], 433932416.0 / kUnit);
  EXPECT_EQ(later[0], 2297610576.0 / kUnit);
  EXPECT_EQ(later[1], 2934753692.0 / kUnit);
}

}  // namespace
}  // namespace alpenglow::renderer
