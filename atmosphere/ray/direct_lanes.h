// SPDX-License-Identifier: MIT
// Sixteen or eight lanes as vectors of the instruction set, and powers of two in these vectors.
// Only direct_kernel.cpp may include this header.
#pragma once

#include <bit>
#include <cstdint>
#include <type_traits>

#include "atmosphere/ray/batch.h"

namespace alpenglow::atmosphere {
namespace {

/// Number of bands that are summed over lanes together; kMaxBands is a multiple.
inline constexpr std::size_t kFour = 4;

#ifdef ALPENGLOW_BATCHES
/// The vector for groups of `count` lanes: as wide as the processor supports, at most `count`.
template <std::size_t count>
using LaneVector =
    xsimd::make_sized_batch_t<float,
                              (BatchOf<float>::kLanes < count ? BatchOf<float>::kLanes : count)>;

template <typename T>
T LoadLanes(const float* from) {
  return T::load_aligned(from);
}
template <typename A>
void StoreLanes(float* to, const xsimd::batch<float, A>& value) {
  value.store_unaligned(to);
}
// Stores four sums over lanes, times four factors.
template <typename A>
void StoreSums(const xsimd::batch<float, A>* value, const float* factor, float* to) {
  using Four = xsimd::make_sized_batch_t<float, kFour>;
  constexpr std::size_t kLanes = xsimd::batch<float, A>::size;
  alignas(64) float lanes[kLanes];
  Four quarter[kFour];
  for (std::size_t i = 0; i < kFour; ++i) {
    value[i].store_aligned(lanes);
    quarter[i] = Four::load_aligned(lanes);
    for (std::size_t at = kFour; at < kLanes; at += kFour)
      quarter[i] += Four::load_aligned(lanes + at);
  }
  (xsimd::haddp(quarter) * Four::load_unaligned(factor)).store_unaligned(to);
}
template <typename A>
float LaneOf(const xsimd::batch<float, A>& value, std::size_t lane) {
  return value.get(lane);
}
template <typename A>
bool AnyLane(const xsimd::batch_bool<float, A>& condition) {
  return xsimd::any(condition);
}
// Returns value 2^n, where n is in the low bits of `shifted`.
template <typename A>
xsimd::batch<float, A> TimesPowerOfTwo(const xsimd::batch<float, A>& value,
                                       const xsimd::batch<float, A>& shifted) {
  using Whole = xsimd::batch<std::int32_t, A>;
  const Whole exponent = xsimd::bitwise_cast<Whole>(shifted) << 23;
  return xsimd::bitwise_cast<xsimd::batch<float, A>>(xsimd::bitwise_cast<Whole>(value) + exponent);
}
#else
template <std::size_t count>
using LaneVector = float;

template <typename T>
T LoadLanes(const float* from) {
  return *from;
}
void StoreLanes(float* to, float value) { *to = value; }
void StoreSums(const float* value, const float* factor, float* to) {
  for (std::size_t i = 0; i < kFour; ++i) to[i] = value[i] * factor[i];
}
float LaneOf(float value, std::size_t) { return value; }
bool AnyLane(bool condition) { return condition; }
float TimesPowerOfTwo(float value, float shifted) {
  const std::uint32_t exponent = std::bit_cast<std::uint32_t>(shifted) << 23;
  return std::bit_cast<float>(std::bit_cast<std::uint32_t>(value) + exponent);
}
#endif

template <typename T>
constexpr std::size_t kLanesOf = sizeof(T) / sizeof(float);

// Returns 2^x for x < 100, relative error 3e-7. Below 2^-60 the result is clamped: products of
// three such numbers are then not subnormal, which would be slow.
template <typename T>
T PowerOfTwo(const T& x) {
  using namespace shared;
  const T rounding(
      12582912.0F);  // 1.5 2^23: adding it moves the nearest whole number into the low bits
  const T bounded = max(x, T(-60.0F));
  const T shifted = bounded + rounding;
  const T f = bounded - (shifted - rounding);
  T p = T(0.00967151299F) + f * T(0.00132647285F);
  p = T(0.0555073358F) + f * p;
  p = T(0.240222424F) + f * p;
  p = T(0.693147004F) + f * p;
  p = T(1.0F) + f * p;
  return TimesPowerOfTwo(p, shifted);
}

}  // namespace
}  // namespace alpenglow::atmosphere
