// SPDX-License-Identifier: MIT
#include "renderer/picture/pixel_noise.h"

#include <algorithm>
#include <cmath>

namespace alpenglow::renderer {

// Welford (1962), Technometrics 4, 419: nothing large is subtracted.
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

}  // namespace alpenglow::renderer
