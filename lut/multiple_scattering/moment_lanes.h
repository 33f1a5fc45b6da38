// SPDX-License-Identifier: MIT
// This header provides vectors of eight floats and the functions that marches and look-ups of
// multiply scattered light share. It is a part of moment_kernel.cpp, which is compiled once per
// instruction set.
#pragma once

#include <cmath>
#include <cstddef>
#include <type_traits>

#include "atmosphere/ray/batch.h"
#include "lut/multiple_scattering/cubic_lanes.h"
#include "lut/multiple_scattering/moment_kernel.h"

namespace alpenglow::lut {
namespace {

// Number of lanes of a vector: eight, or fewer if the instruction set has fewer.
#ifdef ALPENGLOW_BATCHES
constexpr std::size_t kWidth = BatchOf<float>::kLanes < 8 ? BatchOf<float>::kLanes : 8;
using V = xsimd::make_sized_batch_t<float, kWidth>;
V Load(const float* from) { return V::load_aligned(from); }
void Store(float* to, const V& value) { value.store_aligned(to); }
V Floor(const V& value) { return xsimd::floor(value); }
V Clamped(const V& value, const V& low, const V& high) {
  return xsimd::min(xsimd::max(value, low), high);
}
#else
constexpr std::size_t kWidth = 1;
using V = float;
V Load(const float* from) { return *from; }
void Store(float* to, const V& value) { *to = value; }
V Floor(const V& value) { return std::floor(value); }
V Clamped(const V& value, const V& low, const V& high) {
  return value < low ? low : high < value ? high : value;
}
#endif

constexpr std::size_t kParts = 8 / kWidth;

/// Eight floats: four bands of an even m, four of the next.
struct Eight {
  V part[kParts];
};

Eight LoadEight(const float* from) {
  Eight value;
  for (std::size_t i = 0; i < kParts; ++i) value.part[i] = Load(from + i * kWidth);
  return value;
}

void StoreEight(float* to, const Eight& value) {
  for (std::size_t i = 0; i < kParts; ++i) Store(to + i * kWidth, value.part[i]);
}

// sum + factor * value
void Add(Eight& sum, const V& factor, const Eight& value) {
  for (std::size_t i = 0; i < kParts; ++i) sum.part[i] += factor * value.part[i];
}
void Add(Eight& sum, const Eight& factor, const Eight& value) {
  for (std::size_t i = 0; i < kParts; ++i) sum.part[i] += factor.part[i] * value.part[i];
}

Eight Zero() {
  Eight zero;
  for (std::size_t i = 0; i < kParts; ++i) zero.part[i] = V(0.0F);
  return zero;
}

#ifdef ALPENGLOW_BATCHES
// Returns a four times, then b four times.
Eight Pair(float a, float b) {
  Eight value;
  if constexpr (kWidth == 8) {
    alignas(64) constexpr float kHalf[8] = {0.0F, 0.0F, 0.0F, 0.0F, 1.0F, 1.0F, 1.0F, 1.0F};
    value.part[0] = xsimd::select(Load(kHalf) > V(0.5F), V(b), V(a));
  } else {
    for (std::size_t i = 0; i < kParts; ++i) value.part[i] = V(i * kWidth < 4 ? a : b);
  }
  return value;
}
#else
Eight Pair(float a, float b) {
  Eight value;
  for (std::size_t i = 0; i < kParts; ++i) value.part[i] = i < 4 ? a : b;
  return value;
}
#endif

template <typename T>
T SunPosition(const MomentGrid& grid, const T& mu_s) {
  using namespace shared;
  const T x = (mu_s - T(grid.sun_centre)) * T(1.0F / grid.sun_width);
  const T magnitude = abs(x);
  const T asinh = log(magnitude + sqrt(magnitude * magnitude + T(1.0F)));
  const T signed_asinh = select(x < T(0.0F), T(-asinh), asinh);
  return (signed_asinh - T(grid.first_asinh)) * T(grid.cells_a_unit);
}

// A batch of half the width of this instruction set belongs to another set, and functions on it
// that the compiler does not inline would carry the name of that set. Its exponential is therefore
// computed in lanes of this set.
template <typename T>
T Exponential(const T& value) {
  using namespace shared;
  using Lanes = BatchOf<float>;
  if constexpr (std::is_same_v<T, Lanes::Type>) {
    return exp(value);
  } else {
    alignas(64) float lanes[Lanes::kLanes] = {};
    Store(lanes, value);
    Lanes::Store(lanes, exp(Lanes::Load(lanes)));
    return Load(lanes);
  }
}

template <typename T>
T Twilight(const MomentGrid& grid, const T& mu_s) {
  using namespace shared;
  const T x = T(grid.twilight_start) - mu_s;
  const T width(grid.twilight_width);
  return Exponential<T>(T(-0.5F * grid.twilight_fall) * (x + sqrt(x * x + width * width)));
}

template <typename T>
T CosineOfAzimuth(const T& mu, const T& sine, const T& mu_s, const T& nu) {
  using namespace shared;
  const T sine_s_squared = (T(1.0F) - mu_s) * (T(1.0F) + mu_s);
  const T sines = sine * sqrt(max(sine_s_squared, T(1e-12F)));
  return AzimuthCosine<T>(mu, mu_s, nu, max(sines, T(1e-6F)));
}

// Calls `run` with the degree, and with whether light is polarised, as compile-time constants.
template <typename Run>
void OfDegree(const MomentGrid& grid, const Run& run) {
  const auto of = [&](auto degree) {
    return grid.polarised ? run(degree, std::true_type{}) : run(degree, std::false_type{});
  };
  switch (grid.degree) {
    case 2:
      return of(std::integral_constant<std::size_t, 2>{});
    case 4:
      return of(std::integral_constant<std::size_t, 4>{});
    case 6:
      return of(std::integral_constant<std::size_t, 6>{});
    case 8:
      return of(std::integral_constant<std::size_t, 8>{});
    default:
      return of(std::integral_constant<std::size_t, kMaxDegree>{});
  }
}

}  // namespace
}  // namespace alpenglow::lut
