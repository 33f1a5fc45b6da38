// SPDX-License-Identifier: MIT
#include "renderer/clouds/periodic_map.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "atmosphere/base/error.h"
#include "renderer/clouds/cloud_noise.h"
#include "renderer/clouds/periodic_index.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {
namespace {

constexpr double kFasterPerOctave = 1.5874010519681994;  // 2^(2/3)

}  // namespace

double GroundNoise::At(const glm::dvec2& point_m, double time_s, double period_m) const {
  double sum = 0.0, amplitude = 1.0, change = change_s;
  int cells = std::max(1, static_cast<int>(period_m / wavelength_m + 0.5));
  for (int octave = 0; octave < octaves; ++octave) {
    const double scale = cells / period_m;
    sum += amplitude * ValueNoise({point_m.x * scale, point_m.y * scale, time_s / change}, cells,
                                  seed + 31U * static_cast<std::uint32_t>(octave));
    amplitude *= gain;
    change /= kFasterPerOctave;
    cells *= 2;
  }
  return sum;
}

PeriodicMap::PeriodicMap(int side, double period_m,
                         const std::function<double(const glm::dvec2&)>& value)
    : side_(side), per_sample_(side / period_m) {
  ALPENGLOW_ENSURE(side, >=, 2);
  const auto n = static_cast<std::size_t>(side);
  values_.resize(n * n);
  tbb::parallel_for(0, side, [&](int y) {
    for (int x = 0; x < side; ++x) {
      values_[static_cast<std::size_t>(y) * n + static_cast<std::size_t>(x)] =
          static_cast<float>(value(glm::dvec2(x, y) / per_sample_));
    }
  });
}

double PeriodicMap::Sample(std::int32_t x, std::int32_t y) const {
  const auto row = static_cast<std::size_t>(PeriodicIndex(y, side_));
  const auto column = static_cast<std::size_t>(PeriodicIndex(x, side_));
  return static_cast<double>(values_[row * static_cast<std::size_t>(side_) + column]);
}

double PeriodicMap::At(const glm::dvec2& point_m) const {
  const glm::dvec2 at = point_m * per_sample_;
  const auto x = static_cast<std::int32_t>(std::floor(at.x));
  const auto y = static_cast<std::int32_t>(std::floor(at.y));
  const double u = at.x - x, v = at.y - y;
  return (1.0 - v) * ((1.0 - u) * Sample(x, y) + u * Sample(x + 1, y)) +
         v * ((1.0 - u) * Sample(x, y + 1) + u * Sample(x + 1, y + 1));
}

double PeriodicMap::LargestIn(const glm::dvec2& low_m, const glm::dvec2& high_m) const {
  const auto first = [&](double value) {
    return static_cast<int>(std::floor(value * per_sample_));
  };
  const auto last = [&](double value) { return static_cast<int>(std::ceil(value * per_sample_)); };
  double largest = Sample(first(low_m.x), first(low_m.y));
  for (int y = first(low_m.y); y <= last(high_m.y); ++y) {
    for (int x = first(low_m.x); x <= last(high_m.x); ++x) {
      largest = std::max(largest, Sample(x, y));
    }
  }
  return largest;
}

double PeriodicMap::Quantile(double fraction) const {
  std::vector<float> sorted = values_;
  const auto rank = static_cast<std::ptrdiff_t>(fraction * static_cast<double>(sorted.size() - 1));
  std::nth_element(sorted.begin(), sorted.begin() + rank, sorted.end());
  return static_cast<double>(sorted[static_cast<std::size_t>(rank)]);
}

}  // namespace alpenglow::renderer
