// SPDX-License-Identifier: MIT
// This header provides vectors of four bands. It is a part of the kernels, which are compiled once per instruction
// set; hence the unnamed namespace.
#pragma once

namespace alpenglow::lut {
namespace {

/// Four floats that are processed by one instruction on processors that support it (gcc and clang).
using Four = float __attribute__((vector_size(16)));

inline Four LoadFour(const float* from) {
  Four four;
  __builtin_memcpy(&four, from, sizeof four);
  return four;
}

inline void StoreFour(float* to, Four four) { __builtin_memcpy(to, &four, sizeof four); }

}  // namespace
}  // namespace alpenglow::lut
