// SPDX-License-Identifier: MIT
// This header provides vectors of four bands. Kernels, which are compiled once per instruction set,
// include it; hence the unnamed namespace.
#pragma once

namespace alpenglow::lut {
namespace {

/// Four floats that gcc and clang process by one instruction. Lanes of a glm vector are processed
/// one by one, and the sanitizers check each.
using Four = float __attribute__((vector_size(16)));

inline Four LoadFour(const float* from) {
  Four four;
  __builtin_memcpy(&four, from, sizeof four);
  return four;
}

inline void StoreFour(float* to, Four four) { __builtin_memcpy(to, &four, sizeof four); }

}  // namespace
}  // namespace alpenglow::lut
