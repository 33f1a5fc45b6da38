// SPDX-License-Identifier: MIT
// This header provides gradient noise from an integer hash. It is bit-identical on every machine
// with IEEE arithmetic, because it uses only +, -, * and comparisons.
//
// Gradient noise and fractal sums: Perlin (1985, 2002); ridged sums: Musgrave in Ebert et al.,
// Texturing and Modeling (2003), ch. 16.
//
// This header also includes the shared text lattice_noise.glsl as C++.
#pragma once

#include <cstdint>

#include "atmosphere/shared_glsl/shared_math.h"

namespace alpenglow::shared {
// clang-format off
#include "atmosphere/shared_glsl/shared_begin.h"
#include "renderer/procedural_mountains/lattice_noise.glsl"
#include "atmosphere/shared_glsl/shared_end.h"
// clang-format on
}  // namespace alpenglow::shared

namespace alpenglow::renderer {

/// Returns a well-mixed 32-bit value of a lattice point and a seed.
[[nodiscard]] std::uint32_t LatticeHash(std::int32_t x, std::int32_t y, std::uint32_t seed);

/// Returns a value uniform in [0, 1), from LatticeHash.
[[nodiscard]] double LatticeUniform(std::int32_t x, std::int32_t y, std::uint32_t seed);

/// Returns smooth noise of wavelength about 1.5, mean 0, in (-1, 1); 0 at the lattice points.
[[nodiscard]] double GradientNoise(double x, double y, std::uint32_t seed);

/// GradientNoise and its derivatives by x and y.
struct NoiseSlope {
  double value, by_x, by_y;
};
[[nodiscard]] NoiseSlope GradientNoiseSlope(double x, double y, std::uint32_t seed);

/// Returns a sum of `octaves` noises, each of twice the frequency and half the amplitude of the one
/// before.
[[nodiscard]] double FractalNoise(double x, double y, int octaves, std::uint32_t seed);

/// Returns a sum of octaves of (1 - |noise|)^2, each weighted by the one before: crests and smooth
/// depressions, in [0, 1].
[[nodiscard]] double RidgedNoise(double x, double y, int octaves, std::uint32_t seed);

}  // namespace alpenglow::renderer
