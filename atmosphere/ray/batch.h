// SPDX-License-Identifier: MIT
// The number type of kernels (instruction_set.h): a loop over samples is compiled with an xsimd
// batch or, in the scalar set, with the plain number. The shared formulas are compiled for the same
// type. Only kernels may include this header.
//
// Unlike in other headers, all definitions are in an unnamed namespace, because the same names
// stand for other instructions in every object file that includes it.
#pragma once

#ifndef ALPENGLOW_KERNEL_SET
#error "batch.h is for files of alpenglow_kernels (.cmake/targets.cmake)"
#endif

// The build defines ALPENGLOW_BATCHES for every set except the scalar one.
#ifdef ALPENGLOW_BATCHES
#include <xsimd/xsimd.hpp>
#ifdef XSIMD_NO_SUPPORTED_ARCHITECTURE
#undef ALPENGLOW_BATCHES
#endif
#endif

#include <cmath>
#include <cstddef>

#include "atmosphere/shared_glsl/instruction_set.h"

namespace alpenglow::atmosphere {
namespace {

inline constexpr InstructionSet kThisSet = InstructionSet::ALPENGLOW_KERNEL_SET;

template <typename Real>
struct PlainNumber {
  using Type = Real;
  static constexpr std::size_t kLanes = 1;
  static Type Load(const Real* from) { return *from; }
  static void Store(Real* to, Type value) { *to = value; }
  static void StoreAnywhere(Real* to, Type value) { *to = value; }
  static Real Sum(Type value) { return value; }
  static bool All(bool condition) { return condition; }
  static Real Last(Type value) { return value; }
  static Type Floor(Type value) { return std::floor(value); }
};

#ifdef ALPENGLOW_BATCHES
/// Loads and stores are aligned, except StoreAnywhere: rows begin at multiples of 64 bytes.
template <typename Real>
struct BatchOf {
  using Type = xsimd::batch<Real>;
  static constexpr std::size_t kLanes = Type::size;
  static Type Load(const Real* from) { return Type::load_aligned(from); }
  static void Store(Real* to, const Type& value) { value.store_aligned(to); }
  static void StoreAnywhere(Real* to, const Type& value) { value.store_unaligned(to); }
  static Real Sum(const Type& value) {
    // xsimd 9 calls hadd reduce_add.
    if constexpr (requires { reduce_add(value); })
      return reduce_add(value);
    else
      return hadd(value);
  }
  static bool All(const typename Type::batch_bool_type& condition) { return xsimd::all(condition); }
  static Real Last(const Type& value) { return value.get(kLanes - 1); }
  static Type Floor(const Type& value) { return xsimd::floor(value); }
};
#else
template <typename Real>
using BatchOf = PlainNumber<Real>;
#endif

/// Compiles the contents of shared_math.h and shell.h again, with the linkage that a
/// kernel needs.
namespace shared {
#include "atmosphere/shared_glsl/shared_builtins.h"

// clang-format off
#include "atmosphere/shared_glsl/shared_begin.h"
#include "atmosphere/ray/shell.glsl"
#include "atmosphere/ray/optical_depth.glsl"
#include "atmosphere/ray/ray_map.glsl"
#include "atmosphere/shared_glsl/shared_end.h"
// clang-format on
}  // namespace shared

}  // namespace
}  // namespace alpenglow::atmosphere
