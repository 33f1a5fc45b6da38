// SPDX-License-Identifier: MIT
#include "renderer/picture/shared_samples.h"

#include <algorithm>
#include <cmath>

#include "atmosphere/base/error.h"

namespace alpenglow::renderer {

// Welford (1962), Technometrics 4, 419: no subtraction of large sums.
void RaySpread::Add(const std::array<double, 3>& rgb) {
  ++rays_;
  for (std::size_t c = 0; c < rgb.size(); ++c) {
    const double before = rgb[c] - mean_[c];
    mean_[c] += before / rays_;
    squares_ += before * (rgb[c] - mean_[c]);
  }
}

// Chan, Golub, LeVeque (1983), The American Statistician 37, 242.
void RaySpread::Add(const RaySpread& other) {
  if (other.rays_ == 0) return;
  const double share = static_cast<double>(other.rays_) / (rays_ + other.rays_);
  for (std::size_t c = 0; c < mean_.size(); ++c) {
    const double apart = other.mean_[c] - mean_[c];
    squares_ += share * rays_ * apart * apart;
    mean_[c] += share * apart;
  }
  squares_ += other.squares_;
  rays_ += other.rays_;
}

double RaySpread::RelativeVariance(double floor_cd_per_m2) const {
  const double level = std::max(std::hypot(mean_[0], mean_[1], mean_[2]), floor_cd_per_m2);
  return rays_ < 2 || level <= 0.0 ? 0.0 : squares_ / (rays_ - 1) / (level * level);
}

int RaysForNoise(double relative_variance, double noise, int first, int most) {
  constexpr double kExponent = 0.7;
  const double wanted = std::pow(relative_variance / (noise * noise), 0.5 / kExponent);
  int rays = first;
  while (rays < wanted && rays <= most / 2) rays *= 2;
  return rays;
}

namespace {

constexpr int kRaySteps = 512;  // steps over the filter's radius: linear interpolation is off by
                                // 2e-5 of its peak

// Returns 0 at crests and in hollows; else the mean of both differences, limited to twice the
// smaller one.
float LimitedSlope(float before, float here, float behind) {
  const float to = here - before, from = behind - here;
  if (to * from <= 0.0F) return 0.0F;
  const float most = 2.0F * std::min(std::abs(to), std::abs(from));
  return std::clamp(0.5F * (to + from), -most, most);
}

}  // namespace

SharedSampleFilter::SharedSampleFilter(const PixelFilter& filter, int columns, int rows,
                                       std::size_t bands)
    : columns_(columns),
      rows_(rows),
      bands_(bands),
      stride_(kLight + (bands + 3) / 4 * 4),
      radius_(filter.radius()) {
  ALPENGLOW_ENSURE(radius_, <=, 0.5 * kReach);
  for (int i = 0; i < kRaySteps; ++i)
    filter_.push_back(static_cast<float>(filter.Weight(radius_ * i / kRaySteps)));
  filter_.push_back(filter_.back());  // a box filter ends at its full height
  expected_.assign(Index(0, rows), 0.0F);
  sums_.assign(expected_.size() * stride_, 0.0F);
  skies_.resize(expected_.size());
}

void SharedSampleFilter::Expect(int column, int row, int rays) {
  expected_[Index(column, row)] = static_cast<float>(rays);
}

SharedSampleFilter::Weights SharedSampleFilter::Around(double at, int end) const {
  Weights weights{static_cast<int>(std::lround(at)) - kReach / 2, {}};
  for (int i = 0; i < kReach; ++i) {
    const int pixel = weights.first + i;
    const double step = std::abs(at - pixel) / radius_ * kRaySteps;
    if (pixel < 0 || pixel >= end || step > kRaySteps) continue;
    const auto low = std::min(static_cast<std::size_t>(step), filter_.size() - 2);
    const auto share = static_cast<float>(step - static_cast<double>(low));
    weights.of[static_cast<std::size_t>(i)] =
        filter_[low] + share * (filter_[low + 1] - filter_[low]);
  }
  return weights;
}

void SharedSampleFilter::Add(int column, int row, const SeenRay& ray) {
  const double x = column + ray.right, y = row + ray.down;
  const Weights across = Around(x, columns_), along = Around(y, rows_);
  alignas(16) std::array<float, kLight + kMaxBands> values{
      1.0F, static_cast<float>(x), static_cast<float>(y), ray.sees_sky ? 1.0F : 0.0F};
  std::copy_n(ray.radiance.values().begin(), bands_, values.begin() + kLight);
  struct Share {
    std::size_t pixel;
    float weight;
  };
  std::array<Share, kReach * kReach> shares;
  std::size_t count = 0;
  float density = 0.0F;
  for (int j = 0; j < kReach; ++j) {
    for (int i = 0; i < kReach; ++i) {
      const float weight =
          across.of[static_cast<std::size_t>(i)] * along.of[static_cast<std::size_t>(j)];
      if (weight <= 0.0F) continue;
      shares[count++] = {Index(across.first + i, along.first + j), weight};
      density += weight * expected_[shares[count - 1].pixel];
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    const float weight = shares[i].weight / density;
    float* sums = &sums_[shares[i].pixel * stride_];
    for (std::size_t block = 0; block < stride_; block += 4) {
      for (std::size_t k = 0; k < 4; ++k) sums[block + k] += weight * values[block + k];
    }
  }
}

void SharedSampleFilter::SetSky(int column, int row, const Spectrum& sky) {
  skies_[Index(column, row)] = sky;
}

Spectrum SharedSampleFilter::SkyAt(int column, int row) const {
  if (const auto& own = skies_[Index(column, row)]) return *own;
  Spectrum sum(bands_);
  float skies = 0.0F;
  for (int y = std::max(row - 1, 0); y <= std::min(row + 1, rows_ - 1); ++y) {
    for (int x = std::max(column - 1, 0); x <= std::min(column + 1, columns_ - 1); ++x) {
      const auto& sky = skies_[Index(x, y)];
      if (!sky) continue;
      sum = sum + *sky;
      skies += 1.0F;
    }
  }
  return skies > 0.0F ? (1.0F / skies) * sum : sum;
}

Spectrum SharedSampleFilter::Light(int column, int row) const {
  constexpr float kMostOff = 0.25F;  // keeps light positive if both axes are corrected
  const std::size_t here = Index(column, row);
  const auto off = [&](std::size_t sum, int middle) {
    return std::clamp(Mean(here, sum) - static_cast<float>(middle), -kMostOff, kMostOff);
  };
  const bool has_sides = column > 0 && column + 1 < columns_;
  const bool has_ends = row > 0 && row + 1 < rows_;
  const float right = has_sides ? off(kColumn, column) : 0.0F;
  const float down = has_ends ? off(kRow, row) : 0.0F;
  const Spectrum sky = SkyAt(column, row);
  Spectrum light(bands_);
  for (std::size_t band = 0; band < bands_; ++band) {
    const auto mean = [&](std::size_t pixel) {
      return Mean(pixel, kLight + band) + Mean(pixel, kSky) * sky[band];
    };
    light[band] = mean(here);
    if (has_sides) light[band] -= right * LimitedSlope(mean(here - 1), mean(here), mean(here + 1));
    if (!has_ends) continue;
    const float above = mean(Index(column, row - 1)), below = mean(Index(column, row + 1));
    light[band] -= down * LimitedSlope(above, mean(here), below);
  }
  return light;
}

}  // namespace alpenglow::renderer
