// SPDX-License-Identifier: MIT
#include "viewer/window_icon.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec3.hpp>

namespace alpenglow::viewer {
namespace {

// x to the right, y upwards, both in [0, 1]; sRGB.
glm::dvec3 Sky(double y) {
  constexpr glm::dvec3 kZenith{28.0, 44.0, 96.0}, kGlow{255.0, 164.0, 112.0};
  return glm::mix(kGlow, kZenith, std::clamp(1.4 * (y - 0.25), 0.0, 1.0));
}

double Ridge(double x) {
  const double peak = 0.82 - 1.25 * std::abs(x - 0.45);
  const double shoulder = 0.5 - 0.9 * std::abs(x - 0.86);
  return std::max({peak, shoulder, 0.12});
}

glm::dvec3 Rock(double x, double y) {
  constexpr glm::dvec3 kShade{52.0, 40.0, 74.0}, kLit{236.0, 112.0, 122.0};
  const bool faces_sun = x > 0.45 + 0.1 * (0.82 - y) && (x < 0.66 || x > 0.86);
  return faces_sun && y > 0.25 + 0.4 * (x - 0.45) ? kLit : kShade;
}

}  // namespace

std::vector<std::uint8_t> WindowIcon(int side) {
  constexpr int kSamples = 4;  // a side of a pixel
  std::vector<std::uint8_t> bytes;
  const double step = 1.0 / (kSamples * side);
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      glm::dvec3 sum(0.0);
      for (int sample = 0; sample < kSamples * kSamples; ++sample) {
        const double x = (kSamples * column + sample % kSamples + 0.5) * step;
        const double y = 1.0 - (kSamples * row + sample / kSamples + 0.5) * step;
        sum += y > Ridge(x) ? Sky(y) : Rock(x, y);
      }
      for (int channel = 0; channel < 3; ++channel) {
        bytes.push_back(static_cast<std::uint8_t>(sum[channel] / (kSamples * kSamples)));
      }
      bytes.push_back(255);
    }
  }
  return bytes;
}

}  // namespace alpenglow::viewer
