// SPDX-License-Identifier: MIT
#include "renderer/picture/shared_rays.h"

#include <algorithm>
#include <cmath>

#include "atmosphere/text/error.h"

namespace alpenglow {
namespace {

constexpr int kSteps = 512;  // of the filter's half: off by 2e-5 of its peak between them

// 0 at crests and in hollows; the mean of both differences, at most twice the lesser.
float LimitedSlope(float before, float here, float behind) {
  const float to = here - before, from = behind - here;
  if (to * from <= 0.0F) return 0.0F;
  const float most = 2.0F * std::min(std::abs(to), std::abs(from));
  return std::clamp(0.5F * (to + from), -most, most);
}

}  // namespace

SharedRays::SharedRays(const PixelFilter& filter, int columns, int rows, std::size_t bands)
    : columns_(columns), rows_(rows), bands_(bands), radius_(filter.radius()) {
  ALPENGLOW_ENSURE(radius_, <=, 0.5 * kReach);
  for (int i = 0; i < kSteps; ++i)
    filter_.push_back(static_cast<float>(filter.Weight(radius_ * i / kSteps)));
  filter_.push_back(filter_.back());  // a box ends at its full height
  const std::size_t pixels = Index(0, rows);
  expected_.assign(pixels, 0.0F);
  weights_ = right_ = down_ = expected_;
  light_.assign(pixels * bands, 0.0F);
}

void SharedRays::Expect(int column, int row, int rays) {
  expected_[Index(column, row)] = static_cast<float>(rays);
}

SharedRays::Weights SharedRays::Around(double at, int end) const {
  Weights weights{static_cast<int>(std::lround(at)) - kReach / 2, {}};
  for (int i = 0; i < kReach; ++i) {
    const int pixel = weights.first + i;
    const double step = std::abs(at - pixel) / radius_ * kSteps;
    if (pixel < 0 || pixel >= end || step > kSteps) continue;
    const auto low = std::min(static_cast<std::size_t>(step), filter_.size() - 2);
    const auto share = static_cast<float>(step - static_cast<double>(low));
    weights.of[static_cast<std::size_t>(i)] =
        filter_[low] + share * (filter_[low + 1] - filter_[low]);
  }
  return weights;
}

void SharedRays::Add(int column, int row, const SeenRay& ray) {
  const double x = column + ray.right, y = row + ray.down;
  const Weights across = Around(x, columns_), along = Around(y, rows_);
  struct Share {
    std::size_t pixel;
    float weight, right, down;
  };
  std::array<Share, kReach * kReach> shares;
  std::size_t count = 0;
  float density = 0.0F;
  for (int j = 0; j < kReach; ++j) {
    for (int i = 0; i < kReach; ++i) {
      const float weight =
          across.of[static_cast<std::size_t>(i)] * along.of[static_cast<std::size_t>(j)];
      if (weight <= 0.0F) continue;
      const int u = across.first + i, v = along.first + j;
      shares[count++] = {Index(u, v), weight, static_cast<float>(x - u), static_cast<float>(y - v)};
      density += weight * expected_[Index(u, v)];
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    const Share& of = shares[i];
    const float weight = of.weight / density;
    weights_[of.pixel] += weight;
    right_[of.pixel] += weight * of.right;
    down_[of.pixel] += weight * of.down;
    for (std::size_t band = 0; band < bands_; ++band)
      light_[of.pixel * bands_ + band] += weight * ray.radiance[band];
  }
}

BandLight SharedRays::Light(int column, int row) const {
  constexpr float kMostOff = 0.25F;  // that both together leave light positive
  const std::size_t here = Index(column, row);
  const auto off = [&](float sum) { return std::clamp(sum / weights_[here], -kMostOff, kMostOff); };
  const bool has_sides = column > 0 && column + 1 < columns_;
  const bool has_ends = row > 0 && row + 1 < rows_;
  BandLight light(bands_);
  for (std::size_t band = 0; band < bands_; ++band) {
    const float mean = Mean(here, band);
    light[band] = mean;
    if (has_sides) {
      light[band] -=
          off(right_[here]) * LimitedSlope(Mean(here - 1, band), mean, Mean(here + 1, band));
    }
    if (has_ends) {
      light[band] -= off(down_[here]) * LimitedSlope(Mean(Index(column, row - 1), band), mean,
                                                     Mean(Index(column, row + 1), band));
    }
  }
  return light;
}

}  // namespace alpenglow
