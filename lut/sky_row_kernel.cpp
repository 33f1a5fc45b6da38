// SPDX-License-Identifier: MIT
#include "lut/sky_row_kernel.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace alpenglow {
namespace {

constexpr std::size_t kAtOnce = 64;

/// Of some look-ups: Rayleigh's phase function, and where the aerosol's is in its table.
struct Angles {
  std::array<float, kAtOnce> rayleigh, fraction;
  std::array<std::int32_t, kAtOnce> node;
};

// asin(s) from s^2: s times a polynomial of degree 5 in s^2, Chebyshev's interpolation of asin(s) /
// s on [0, 1/2], error below 1e-6; beyond, the complement.
inline float ArcSineOfRoot(float s2) {
  const bool large = s2 > 0.5F;
  const float x2 = large ? 1.0F - s2 : s2;
  const float series =
      0.999999316F +
      x2 * (0.166760939F +
            x2 * (0.072926353F + x2 * (0.060887368F + x2 * (-0.024216352F + x2 * 0.096353908F))));
  const float angle = std::sqrt(x2) * series;
  return large ? 1.57079633F - angle : angle;
}

void FindAngles(const SkyRowWork& work, std::size_t first, std::size_t count, Angles& angles) {
  constexpr float kPerAngle = 2.0F / 3.14159265F;
  constexpr auto kNodes = static_cast<float>(kSkyPhaseNodes);
  for (std::size_t i = 0; i < count; ++i) {
    const float s2 =
        std::min(std::max(work.offset + work.scale * work.half_sine2[first + i], 0.0F), 1.0F);
    const float nu = 1.0F - 2.0F * s2;
    angles.rayleigh[i] = 0.05968310365946075F * (1.0F + nu * nu);
    const float position = kNodes * std::sqrt(kPerAngle * ArcSineOfRoot(s2));
    const auto node = std::min(static_cast<std::int32_t>(position), kSkyPhaseNodes - 1);
    angles.node[i] = node;
    angles.fraction[i] = position - static_cast<float>(node);
  }
}

}  // namespace

void FillSkyRow(const SkyRowWork& work) {
  Angles angles;
  for (std::size_t first = 0; first < work.count; first += kAtOnce) {
    const std::size_t count = std::min(kAtOnce, work.count - first);
    FindAngles(work, first, count, angles);
    for (std::size_t i = 0; i < count; ++i) {
      const float* node =
          work.row + kSkyNodeFloats * static_cast<std::size_t>(work.cell[first + i]);
      const float* weight = work.weights + 4 * (first + i);
      const float* phase = work.phase + 4 * static_cast<std::size_t>(angles.node[i]);
      const float t = angles.fraction[i];
      const float rayleigh = angles.rayleigh[i];
      float* out = work.radiance + work.radiance_stride * (first + i);
      std::array<float, kSkyNodeFloats> sum;
      for (std::size_t k = 0; k < kSkyNodeFloats; ++k) {
        sum[k] = weight[0] * node[k] + weight[1] * node[kSkyNodeFloats + k] +
                 weight[2] * node[2 * kSkyNodeFloats + k] +
                 weight[3] * node[3 * kSkyNodeFloats + k];
      }
      for (std::size_t k = 0; k < 4; ++k) {
        const float mie = phase[k] + t * (phase[4 + k] - phase[k]);
        out[k] = std::max(rayleigh * sum[k] + mie * sum[4 + k] + sum[8 + k], 0.0F);
      }
    }
  }
}

}  // namespace alpenglow
