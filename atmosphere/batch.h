// SPDX-License-Identifier: MIT
// The type in which a loop over samples is read: an xsimd batch where SIMD is on, the plain number
// where it is off (and always for double, the reference).
#pragma once

#include <cstddef>

#ifdef ALPENGLOW_SIMD
#include <xsimd/xsimd.hpp>
#endif

#include "atmosphere/shared_math.h"

namespace alpenglow {

template <typename Real>
struct BatchOf {
  using Type = Real;
  static constexpr std::size_t kLanes = 1;
  static Type Load(const Real* from) { return *from; }
  static void Store(Real* to, Type value) { *to = value; }
  static Real Sum(Type value) { return value; }
};

#ifdef ALPENGLOW_SIMD
template <>
struct BatchOf<float> {
  using Type = xsimd::batch<float>;
  static constexpr std::size_t kLanes = Type::size;
  static Type Load(const float* from) { return Type::load_aligned(from); }
  static void Store(float* to, const Type& value) { value.store_aligned(to); }
  static float Sum(const Type& value) { return xsimd::hadd(value); }
};
#endif

}  // namespace alpenglow
