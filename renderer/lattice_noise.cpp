// SPDX-License-Identifier: MIT
#include "renderer/lattice_noise.h"

#include <algorithm>
#include <cmath>

namespace alpenglow {
namespace {

// Finaliser of MurmurHash3 (Appleby, public domain): every input bit moves every output bit.
std::uint32_t Mixed(std::uint32_t bits) {
  bits ^= bits >> 16;
  bits *= 0x85ebca6bU;
  bits ^= bits >> 13;
  bits *= 0xc2b2ae35U;
  bits ^= bits >> 16;
  return bits;
}

double Fade(double t) { return t * t * t * (t * (t * 6.0 - 15.0) + 10.0); }

// Dot of the offset with the lattice point's gradient, whose components are uniform in [-1, 1).
double GradientDot(std::int32_t x, std::int32_t y, double dx, double dy, std::uint32_t seed) {
  const std::uint32_t hash = LatticeHash(x, y, seed);
  const double gx = static_cast<double>(hash & 0xffffU) / 32768.0 - 1.0;
  const double gy = static_cast<double>(hash >> 16) / 32768.0 - 1.0;
  return gx * dx + gy * dy;
}

}  // namespace

std::uint32_t LatticeHash(std::int32_t x, std::int32_t y, std::uint32_t seed) {
  return Mixed(static_cast<std::uint32_t>(x) +
               Mixed(static_cast<std::uint32_t>(y) + Mixed(seed + 0x9e3779b9U)));
}

double LatticeUniform(std::int32_t x, std::int32_t y, std::uint32_t seed) {
  return static_cast<double>(LatticeHash(x, y, seed)) / 4294967296.0;
}

double GradientNoise(double x, double y, std::uint32_t seed) {
  const double floor_x = std::floor(x);
  const double floor_y = std::floor(y);
  const auto ix = static_cast<std::int32_t>(floor_x);
  const auto iy = static_cast<std::int32_t>(floor_y);
  const double dx = x - floor_x;
  const double dy = y - floor_y;
  const double u = Fade(dx);
  const double v = Fade(dy);
  const double south = (1.0 - u) * GradientDot(ix, iy, dx, dy, seed) +
                       u * GradientDot(ix + 1, iy, dx - 1.0, dy, seed);
  const double north = (1.0 - u) * GradientDot(ix, iy + 1, dx, dy - 1.0, seed) +
                       u * GradientDot(ix + 1, iy + 1, dx - 1.0, dy - 1.0, seed);
  return (1.0 - v) * south + v * north;
}

double FractalNoise(double x, double y, int octaves, std::uint32_t seed) {
  double sum = 0.0;
  double amplitude = 1.0;
  double frequency = 1.0;
  for (int octave = 0; octave < octaves; ++octave) {
    sum += amplitude *
           GradientNoise(frequency * x, frequency * y, seed + static_cast<std::uint32_t>(octave));
    amplitude *= 0.5;
    frequency *= 2.0;
  }
  return sum;
}

double RidgedNoise(double x, double y, int octaves, std::uint32_t seed) {
  double sum = 0.0;
  double norm = 0.0;
  double weight = 1.0;
  double amplitude = 1.0;
  double frequency = 1.0;
  for (int octave = 0; octave < octaves; ++octave) {
    const double noise =
        GradientNoise(frequency * x, frequency * y, seed + static_cast<std::uint32_t>(octave));
    const double crest = 1.0 - std::min(1.0, 1.6 * std::abs(noise));
    sum += amplitude * weight * crest * crest;
    norm += amplitude;
    weight = crest;
    amplitude *= 0.5;
    frequency *= 2.0;
  }
  return sum / norm;
}

}  // namespace alpenglow
