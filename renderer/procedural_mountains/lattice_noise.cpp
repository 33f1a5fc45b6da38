// SPDX-License-Identifier: MIT
#include "renderer/procedural_mountains/lattice_noise.h"

#include <algorithm>
#include <cmath>

namespace alpenglow::renderer {
namespace {

/// A position within its cell of the lattice, and the hashes of the cell's corners.
struct Cell {
  double dx, dy;
  std::uint32_t south_west, south_east, north_west, north_east;

  Cell(double x, double y, std::uint32_t seed) {
    // A conversion and a comparison are used, because without SSE4 the library's floor is a
    // function call.
    const auto floor_of = [](double value) {
      const auto truncated = static_cast<std::int32_t>(value);
      return truncated - (value < static_cast<double>(truncated) ? 1 : 0);
    };
    const std::int32_t ix = floor_of(x);
    const std::int32_t iy = floor_of(y);
    dx = x - static_cast<double>(ix);
    dy = y - static_cast<double>(iy);
    const auto west = static_cast<std::uint32_t>(ix);
    const auto south = static_cast<std::uint32_t>(iy);
    south_west = shared::LatticePoint(west, south, seed);
    south_east = shared::LatticePoint(west + 1U, south, seed);
    north_west = shared::LatticePoint(west, south + 1U, seed);
    north_east = shared::LatticePoint(west + 1U, south + 1U, seed);
  }

  /// Evaluates a function of lattice_noise.glsl at this position.
  template <typename Function>
  [[nodiscard]] double At(const Function& function) const {
    return function(south_west, south_east, north_west, north_east, dx, dy);
  }
};

}  // namespace

std::uint32_t LatticeHash(std::int32_t x, std::int32_t y, std::uint32_t seed) {
  return shared::LatticePoint(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), seed);
}

double LatticeUniform(std::int32_t x, std::int32_t y, std::uint32_t seed) {
  return static_cast<double>(LatticeHash(x, y, seed)) / 4294967296.0;
}

double GradientNoise(double x, double y, std::uint32_t seed) {
  return Cell(x, y, seed).At(shared::NoiseInCell<double>);
}

NoiseSlope GradientNoiseSlope(double x, double y, std::uint32_t seed) {
  const Cell cell(x, y, seed);
  return {cell.At(shared::NoiseInCell<double>), cell.At(shared::NoiseSlopeEast<double>),
          cell.At(shared::NoiseSlopeNorth<double>)};
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

}  // namespace alpenglow::renderer
