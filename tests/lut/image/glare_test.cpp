// SPDX-License-Identifier: MIT
#include "lut/image/eye.h"

#include <gtest/gtest.h>

#include <cmath>

#include "atmosphere/math/constants.h"
#include "lut/layer.h"

namespace alpenglow::lut {
namespace {

constexpr double kGlarePixel_rad = 0.05 * kRadiansPerDegree;

TEST(Glare, SpreadsAllLightOverTheHemisphere) {
  double sum = 0.0;
  // Steps even in the logarithm, from a thousandth of the core's width.
  constexpr double kStep = 0.001;
  for (double log_deg = std::log(2e-5); log_deg < std::log(90.0); log_deg += kStep) {
    const double angle = std::exp(log_deg) * kRadiansPerDegree;
    sum += GlareOfEye(angle) * 2.0 * kPi * angle * angle * kStep;
  }
  EXPECT_NEAR(sum, 1.0, 0.01) << "as published, with plane angles for the solid angle";
}

TEST(Glare, IsTheSumOverAllPixels) {
  Image image(13, 9);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x)
      image.at(x, y) = {static_cast<float>(x), static_cast<float>(y + 1), 2.0F};
  }
  image.at(4, 6) = {3e5F, 2e5F, 1e5F};
  const Image seen = WithGlareOfEye(image, kGlarePixel_rad);
  // What a pixel keeps: all that it does not send to the torus of 32 x 32.
  double sent = 0.0;
  for (int v = -15; v <= 16; ++v) {
    for (int u = -15; u <= 16; ++u) {
      if (u != 0 || v != 0)
        sent += GlareOfEye(kGlarePixel_rad * std::hypot(u, v)) * kGlarePixel_rad * kGlarePixel_rad;
    }
  }
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      for (std::size_t c = 0; c < 3; ++c) {
        double sum = (1.0 - sent) * static_cast<double>(image.at(x, y).at(c));
        for (int v = 0; v < image.height; ++v) {
          for (int u = 0; u < image.width; ++u) {
            if (u == x && v == y) continue;
            sum += GlareOfEye(kGlarePixel_rad * std::hypot(u - x, v - y)) * kGlarePixel_rad *
                   kGlarePixel_rad * static_cast<double>(image.at(u, v).at(c));
          }
        }
        EXPECT_NEAR(static_cast<double>(seen.at(x, y).at(c)) / sum, 1.0, 1e-6) << x << " " << y;
      }
    }
  }
}

TEST(Glare, OfASunOnABlackSkyFallsAsTheSquareOfTheAngleFarFromIt) {
  Image image(200, 3);
  image.at(0, 1) = {1e9F, 1e9F, 1e9F};
  const Image seen = WithGlareOfEye(image, 0.2 * kRadiansPerDegree);
  const double near = static_cast<double>(seen.at(80, 1)[1]);
  const double far = static_cast<double>(seen.at(160, 1)[1]);
  EXPECT_NEAR(near / far, 4.0, 0.2) << "from 16 to 32 degrees";
}

TEST(Glare, LeavesDarknessDark) {
  const Image seen = WithGlareOfEye(Image(17, 5), kGlarePixel_rad);
  for (const auto& pixel : seen.rgb) EXPECT_EQ(pixel[1], 0.0F);
}

}  // namespace
}  // namespace alpenglow::lut
