// SPDX-License-Identifier: MIT
// Opens a shared source (*.glsl) in C++: the text is compiled here for double, float and SIMD
// batches, and as GLSL behind shared_prelude.glsl. There is no include guard: this file is included
// before every shared source.
//
// Rules of the shared language:
//  1. Every literal has a dimension: Number(2.0), Length(0.0).
//  2. Functions take values and return one value: no out parameters, textures, uniforms, arrays or
//     swizzles.
//  3. No branch on data: select(condition, yes, no), both sides finite or unused. The number of
//     iterations of a loop is known before it starts.
//  4. Altitude, not radius; differences of squares factored; the conjugate form of a quadratic
//     root.
//  5. Names of Alpenglow are capitalised, builtins of both languages are in lower case.
//  6. Whole numbers of 32 bits that wrap are Bits; a function of Bits alone is SHARED_BITS. A
//     named constant is SHARED_CONSTANT, and a whole number.
//  7. Kilometres inside the text (the range of float), metres in every public C++ signature.

// Number(0.1) intentionally rounds a literal to the type for which the text is compiled.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wfloat-conversion"
#ifdef __clang__  // clang has another name for the rounding of literals
#pragma GCC diagnostic ignored "-Wimplicit-float-conversion"
#endif

#define SHARED             \
  template <typename Real> \
  [[nodiscard]] inline
#define SHARED_BITS [[nodiscard]] inline
#define SHARED_CONSTANT inline constexpr
#define Number Real
#define Length Real
#define Bits std::uint32_t
