// SPDX-License-Identifier: MIT
#include "lut/multiple_scattering/azimuth_fan_kernel.h"

#include "atmosphere/ray/batch.h"
#include "lut/multiple_scattering/cubic_lanes.h"
#include "lut/multiple_scattering/four_bands.h"
#include "lut/multiple_scattering/polarised_scattering.h"

namespace alpenglow::lut {
namespace {

inline Four BetweenAltitudes(const FanContraction& work, std::size_t offset) {
  return work.weights[0] * LoadFour(work.nodes[0] + offset) +
         work.weights[1] * LoadFour(work.nodes[1] + offset) +
         work.weights[2] * LoadFour(work.nodes[2] + offset) +
         work.weights[3] * LoadFour(work.nodes[3] + offset);
}

void Contract(const FanContraction& work) {
  const int orders = work.degree + 1;
  for (std::size_t sun = 0; sun < work.suns; ++sun) {
    const std::size_t at = sun * work.sun_stride;
    float* row = work.rows + 4 * sun * static_cast<std::size_t>(orders);
    for (int m = 0; m < orders; ++m) {
      Four sum = {};
      for (int l = m; l < orders; ++l) {
        const auto moment = static_cast<std::size_t>(l * (l + 1) / 2 + m);
        const std::size_t offset = at + moment * work.moment_stride;
        const Four there = BetweenAltitudes(work, offset);
        sum += LoadFour(work.factors + 4 * moment) * there;
      }
      if (work.tensor > 0 && m < static_cast<int>(kTensorMoments)) {
        const std::size_t channel = work.tensor + static_cast<std::size_t>(m);
        const std::size_t offset = at + channel * work.moment_stride;
        const Four there = BetweenAltitudes(work, offset);
        sum += LoadFour(work.factors + 4 * channel) * there;
      }
      StoreFour(row + 4 * m, sum);
    }
  }
}

void FindSuns(const FanSuns& work) {
  const float view_sine2 = (1.0F - work.mu) * (1.0F + work.mu);
  for (std::size_t k = 0; k < work.count; ++k) {
    const float nu = work.nu[k];
    const float mu_s = shared::min(
        shared::max((work.radius_mu_s + work.distance * nu) * work.inverse_radius, -1.0F), 1.0F);
    const float sines = std::sqrt(shared::max(view_sine2 * (1.0F - mu_s) * (1.0F + mu_s), 1e-12F));
    work.cosine[k] = shared::AzimuthCosine<float>(work.mu, mu_s, nu, sines);
    work.position[k] = 0.5F * (1.0F + mu_s) * work.table_cells;
    if (work.sun_sine != nullptr)
      work.sun_sine[k] = std::sqrt(shared::max((1.0F - mu_s) * (1.0F + mu_s), 0.0F));
  }
  for (std::size_t k = 0; k < work.count; ++k) {
    const float x = shared::min(work.position[k], work.table_cells - 1.0F);
    const auto cell = static_cast<std::int32_t>(x);
    const float t = work.position[k] - static_cast<float>(cell);
    const float* table = work.coordinate_of_mu_s + cell;
    work.position[k] = table[0] + t * (table[1] - table[0]);
    const float* twilight = work.twilight_of_mu_s + cell;
    work.twilight[k] = twilight[0] + t * (twilight[1] - twilight[0]);
  }
}

// Catmull-Rom interpolation between the rows of four nodes.
void Gather(const FanGathering& work) {
  const auto orders = static_cast<std::size_t>(work.degree + 1);
  for (std::size_t k = 0; k < work.count; ++k) {
    const float x = work.position[k] - static_cast<float>(work.first_sun);
    int cell = static_cast<int>(x);
    cell = cell < 1 ? 1 : cell;
    cell = cell > work.suns - 3 ? work.suns - 3 : cell;
    const float t = x - static_cast<float>(cell);
    const Weights<float> weight = Cubic<float>(t);
    const float* row = work.rows + 4 * orders * static_cast<std::size_t>(cell - 1);
    const float cosine = work.cosine[k];
    const float sine = work.sun_sine == nullptr ? 1.0F : work.sun_sine[k];
    float before = cosine, now = 1.0F;  // cos((m - 1) phi), cos(m phi)
    Four sum = {};
    for (std::size_t m = 0; m < orders; ++m, row += 4) {
      const Four there = weight.w0 * LoadFour(row) + weight.w1 * LoadFour(row + 4 * orders) +
                         weight.w2 * LoadFour(row + 8 * orders) +
                         weight.w3 * LoadFour(row + 12 * orders);
      sum += now * SinePower(m, sine) * there;
      const float next = 2.0F * cosine * now - before;
      before = now;
      now = next;
    }
    sum *= work.twilight[k];
    const Four dark = {};
    float* light = work.light + 4 * k;
    StoreFour(light, LoadFour(light) + (sum > dark ? sum : dark));
  }
}

}  // namespace

const AzimuthFanKernel& KernelOf(KernelName<AzimuthFanKernel, kThisSet> /*name*/) {
  static constexpr AzimuthFanKernel kernel{Contract, FindSuns, Gather};
  return kernel;
}

}  // namespace alpenglow::lut
