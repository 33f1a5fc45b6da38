// SPDX-License-Identifier: MIT
#include "renderer/terrain/lattice_noise.h"

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

double FadeSlope(double t) { return 30.0 * t * t * (t - 1.0) * (t - 1.0); }

// The lattice point's gradient: components uniform in [-1, 1).
struct Gradient {
  double x, y;

  [[nodiscard]] double At(double dx, double dy) const { return x * dx + y * dy; }
};

Gradient GradientOf(std::uint32_t hash) {
  constexpr double kUnit = 1.0 / 32768.0;
  return {static_cast<double>(hash & 0xffffU) * kUnit - 1.0,
          static_cast<double>(hash >> 16) * kUnit - 1.0};
}

/// A place in its cell of the lattice, and the gradients at the cell's corners.
struct Cell {
  double dx, dy;
  Gradient south_west, south_east, north_west, north_east;

  Cell(double x, double y, std::uint32_t seed) {
    // A conversion and a comparison: without SSE4 the library's floor is a call.
    const auto floor_of = [](double value) {
      const auto truncated = static_cast<std::int32_t>(value);
      return truncated - (value < static_cast<double>(truncated) ? 1 : 0);
    };
    const std::int32_t ix = floor_of(x);
    const std::int32_t iy = floor_of(y);
    dx = x - static_cast<double>(ix);
    dy = y - static_cast<double>(iy);
    const std::uint32_t of_seed = Mixed(seed + 0x9e3779b9U);
    const auto west = static_cast<std::uint32_t>(ix);
    const std::uint32_t south = Mixed(static_cast<std::uint32_t>(iy) + of_seed);
    const std::uint32_t north = Mixed(static_cast<std::uint32_t>(iy) + 1U + of_seed);
    south_west = GradientOf(Mixed(west + south));
    south_east = GradientOf(Mixed(west + 1U + south));
    north_west = GradientOf(Mixed(west + north));
    north_east = GradientOf(Mixed(west + 1U + north));
  }
};

}  // namespace

std::uint32_t LatticeHash(std::int32_t x, std::int32_t y, std::uint32_t seed) {
  return Mixed(static_cast<std::uint32_t>(x) +
               Mixed(static_cast<std::uint32_t>(y) + Mixed(seed + 0x9e3779b9U)));
}

double LatticeUniform(std::int32_t x, std::int32_t y, std::uint32_t seed) {
  return static_cast<double>(LatticeHash(x, y, seed)) / 4294967296.0;
}

double GradientNoise(double x, double y, std::uint32_t seed) {
  const Cell cell(x, y, seed);
  const double dx = cell.dx;
  const double dy = cell.dy;
  const double u = Fade(dx);
  const double v = Fade(dy);
  const double south =
      (1.0 - u) * cell.south_west.At(dx, dy) + u * cell.south_east.At(dx - 1.0, dy);
  const double north =
      (1.0 - u) * cell.north_west.At(dx, dy - 1.0) + u * cell.north_east.At(dx - 1.0, dy - 1.0);
  return (1.0 - v) * south + v * north;
}

NoiseSlope GradientNoiseSlope(double x, double y, std::uint32_t seed) {
  const Cell cell(x, y, seed);
  const double dx = cell.dx;
  const double dy = cell.dy;
  const double u = Fade(dx);
  const double v = Fade(dy);
  const double south_west = cell.south_west.At(dx, dy);
  const double south_east = cell.south_east.At(dx - 1.0, dy);
  const double north_west = cell.north_west.At(dx, dy - 1.0);
  const double north_east = cell.north_east.At(dx - 1.0, dy - 1.0);
  const double south = (1.0 - u) * south_west + u * south_east;
  const double north = (1.0 - u) * north_west + u * north_east;
  const auto mixed = [&](double sw, double se, double nw, double ne) {
    return (1.0 - v) * ((1.0 - u) * sw + u * se) + v * ((1.0 - u) * nw + u * ne);
  };
  return {
      (1.0 - v) * south + v * north,
      mixed(cell.south_west.x, cell.south_east.x, cell.north_west.x, cell.north_east.x) +
          FadeSlope(dx) * ((1.0 - v) * (south_east - south_west) + v * (north_east - north_west)),
      mixed(cell.south_west.y, cell.south_east.y, cell.north_west.y, cell.north_east.y) +
          FadeSlope(dy) * (north - south)};
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
