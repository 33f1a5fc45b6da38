// SPDX-License-Identifier: MIT
#include "renderer/report/traced_light.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "atmosphere/math/numerics.h"

namespace alpenglow::renderer {

CloudRadiance TracedLight(const CloudPathTracer& tracer, const CloudRay& ray, std::uint64_t seed,
                          std::size_t batches, std::size_t paths_per_batch) {
  std::array<std::array<double, 2>, 3> sums{};  // of sun, sky and ground: means and their squares
  const std::size_t stride = atmosphere::reference::kPathsPerBatch / paths_per_batch;
  for (std::size_t batch = 0; batch < batches; ++batch) {
    CloudPathLight sum;
    for (std::size_t path = 0; path < paths_per_batch; ++path) {
      CloudPathTracer::PathRandom random(seed, batch, stride * path);
      const CloudPathLight light = tracer.OnePath(ray, random);
      sum.sun += light.sun;
      sum.sky += light.sky;
      sum.ground += light.ground;
    }
    const std::array<double, 3> values{sum.sun, sum.sky, sum.ground};
    for (std::size_t i = 0; i < 3; ++i) {
      const double mean = values[i] / static_cast<double>(paths_per_batch);
      sums[i][0] += mean;
      sums[i][1] += mean * mean;
    }
  }
  const auto estimate = [&](const std::array<double, 2>& sum) -> CloudEstimate {
    const auto count = static_cast<double>(batches);
    const double mean = sum[0] / count;
    const double variance = std::max(0.0, sum[1] / count - mean * mean);
    return {mean, batches > 1 ? std::sqrt(variance / (count - 1.0)) : 0.0};
  };
  return {estimate(sums[0]), estimate(sums[1]), estimate(sums[2]), {}, batches * paths_per_batch};
}

std::uint64_t SeedOf(const CloudRay& ray) {
  Fnv1a seed;
  for (const glm::dvec3& vector : {ray.direction, ray.origin}) {
    for (int axis = 0; axis < 3; ++axis) seed.Add(std::bit_cast<std::uint64_t>(vector[axis]));
  }
  return seed.hash();
}

}  // namespace alpenglow::renderer
