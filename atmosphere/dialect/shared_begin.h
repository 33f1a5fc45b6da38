// SPDX-License-Identifier: MIT
// Opens a shared text (*.glsl) for C++: the same text is read as double, float and SIMD batch here,
// and as GLSL behind shared_prelude.glsl. No include guard: it is included before every shared
// text.
//
// Rules of the dialect:
//  1. Every literal wears its dimension: Number(2.0), Length(0.0).
//  2. Values in, one value out: no out parameters, textures, uniforms, arrays or swizzles.
//  3. No branch on data: select(condition, yes, no), both sides finite or unused. Loops have a
//  count.
//  4. Altitude, not radius; differences of squares factored; the conjugate form of a quadratic
//  root.
//  5. Capital = ours, lower case = builtin of both languages.
//  6. Whole numbers of 32 bits that wrap are Bits; a function of Bits alone is SHARED_BITS. A
//  constant with a name is SHARED_CONSTANT, and a whole number.
//  7. Kilometres inside the text (the range of float), metres in every public C++ signature.

// Number(0.1) rounds a literal to the type that is being read: that is its purpose.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wfloat-conversion"

#define SHARED             \
  template <typename Real> \
  [[nodiscard]] inline
#define SHARED_BITS [[nodiscard]] inline
#define SHARED_CONSTANT inline constexpr
#define Number Real
#define Length Real
#define Bits std::uint32_t
