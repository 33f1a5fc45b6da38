// SPDX-License-Identifier: MIT
// This header defines sums and products of light in bands, band by band.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include "atmosphere/ray/single_scattering.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Light, or a factor of light, in each band of a picture.
using BandLight = Bands<float>;

[[nodiscard]] inline BandLight operator+(const BandLight& a, const BandLight& b) {
  BandLight sum(a.count);
  for (std::size_t band = 0; band < a.count; ++band) sum[band] = a[band] + b[band];
  return sum;
}

[[nodiscard]] inline BandLight operator*(const BandLight& a, const BandLight& b) {
  BandLight product(a.count);
  for (std::size_t band = 0; band < a.count; ++band) product[band] = a[band] * b[band];
  return product;
}

[[nodiscard]] inline BandLight operator*(float scale, const BandLight& a) {
  BandLight product(a.count);
  for (std::size_t band = 0; band < a.count; ++band) product[band] = scale * a[band];
  return product;
}

/// A view of band light in double precision, for functions that sum colours.
class InDouble {
 public:
  explicit InDouble(const BandLight& light) : count_(light.count) {  // NOLINT: value_ is set below
    std::copy_n(light.value.begin(), count_, value_.begin());
  }
  operator std::span<const double>() const { return {value_.data(), count_}; }  // NOLINT: a view

 private:
  std::array<double, kMaxBands> value_;  // the first `count_` entries; the others are never read
  std::size_t count_;
};

}  // namespace alpenglow::renderer
