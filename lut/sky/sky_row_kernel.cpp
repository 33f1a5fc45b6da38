// SPDX-License-Identifier: MIT
#include "lut/sky/sky_row_kernel.h"

#include "atmosphere/ray/batch.h"
#include "lut/multiple_scattering/four_bands.h"

namespace alpenglow::lut {
namespace {

constexpr std::size_t kAtOnce = 64;

/// Phase function values of a group of look-ups: Rayleigh's value, and the position of the
/// aerosol's in its table.
struct Angles {
  float rayleigh[kAtOnce], fraction[kAtOnce];
  std::int32_t node[kAtOnce];
};

// Returns asin(s) from s^2: s times a polynomial of degree 5 in s^2, Chebyshev interpolation of
// asin(s) / s on [0, 1/2], error below 1e-6; beyond 1/2, by the complementary angle.
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
  const float* half_sine2 = work.half_sine2 + first;
  const float offset = work.offset;
  const float scale = work.scale;
  for (std::size_t i = 0; i < count; ++i) {
    const float s2 = shared::min(shared::max(offset + scale * half_sine2[i], 0.0F), 1.0F);
    const float nu = 1.0F - 2.0F * s2;
    angles.rayleigh[i] = 0.05968310365946075F * (1.0F + nu * nu);
    const float position = kNodes * std::sqrt(kPerAngle * ArcSineOfRoot(s2));
    const float lower = shared::min(position, kNodes - 1.0F);
    angles.node[i] = static_cast<std::int32_t>(lower);
    angles.fraction[i] = position - static_cast<float>(angles.node[i]);
  }
}

template <std::size_t kNodeFloats>
inline Four Weighted(const float* weight, const float* node) {
  return weight[0] * LoadFour(node) + weight[1] * LoadFour(node + kNodeFloats) +
         weight[2] * LoadFour(node + 2 * kNodeFloats) +
         weight[3] * LoadFour(node + 3 * kNodeFloats);
}

template <std::size_t kTerms>
void FillTerms(const SkyRowWork& work) {
  constexpr std::size_t kNode = SkyNodeFloats(kTerms), kPhases = 4 * kTerms;
  Angles angles;
  for (std::size_t first = 0; first < work.count; first += kAtOnce) {
    const std::size_t count = work.count - first < kAtOnce ? work.count - first : kAtOnce;
    FindAngles(work, first, count, angles);
    for (std::size_t i = 0; i < count; ++i) {
      const float* node = work.row + kNode * static_cast<std::size_t>(work.cell[first + i]);
      const float* weight = work.weights + 4 * (first + i);
      const float* phase = work.phase + kPhases * static_cast<std::size_t>(angles.node[i]);
      Four light =
          angles.rayleigh[i] * Weighted<kNode>(weight, node) + Weighted<kNode>(weight, node + 4);
      for (std::size_t term = 0; term < kTerms; ++term) {
        const Four lower = LoadFour(phase + 4 * term);
        const Four upper = LoadFour(phase + kPhases + 4 * term);
        light = light + (lower + angles.fraction[i] * (upper - lower)) *
                            Weighted<kNode>(weight, node + 8 + 4 * term);
      }
      const Four dark = {};
      const Four radiance = dark > light ? dark : light;  // light that is not a number stays so
      StoreFour(work.radiance + work.radiance_stride * (first + i), radiance);
    }
  }
}

void Fill(const SkyRowWork& work) {
  if (work.terms == 1) {
    FillTerms<1>(work);
  } else if (work.terms == kSkyPeakTerms) {
    FillTerms<kSkyPeakTerms>(work);
  } else {
    FillTerms<kSkyLobeTerms>(work);
  }
}

void Blend(const SkyBlendWork& work) {
  const float* rows = work.rows;
  const std::size_t stride = work.stride;
  for (std::size_t k = 0; k < work.count; ++k) {
    work.sum[k] = work.weights[0] * rows[k] + work.weights[1] * rows[stride + k] +
                  work.weights[2] * rows[2 * stride + k] + work.weights[3] * rows[3 * stride + k];
  }
}

}  // namespace

const SkyRowKernel& KernelOf(KernelName<SkyRowKernel, kThisSet> /*name*/) {
  static constexpr SkyRowKernel kernel{Fill, Blend};
  return kernel;
}

}  // namespace alpenglow::lut
