// SPDX-License-Identifier: MIT
// Noise that repeats seamlessly, for the shapes of clouds. It uses integer hashes and only +, -, *,
// / and square roots, so that it is bit-identical on every machine with IEEE arithmetic.
//
// Value noise blends hashed values of lattice points (Perlin's fade). Billow noise is the sum of
// bumps 1 - d^2, d the distance to the nearest hashed point (Worley 1996, SIGGRAPH): round tops that
// meet in creases, as the tops of cumulus do.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "renderer/procedural_mountains/lattice_noise.h"

namespace alpenglow::renderer {

/// Returns a well-mixed value of a lattice point in space.
[[nodiscard]] inline std::uint32_t LatticeHash3(std::int32_t x, std::int32_t y, std::int32_t z,
                                                std::uint32_t seed) {
  return shared::MixedBits(static_cast<std::uint32_t>(x) + LatticeHash(y, z, seed));
}

/// Returns value noise in [-1, 1] that repeats after `period` cells along x and y, and never along
/// z. Its standard deviation is 0.40.
[[nodiscard]] double ValueNoise(const glm::dvec3& cells, int period, std::uint32_t seed);

/// Distances from a point to the nearest and the second nearest of points scattered one per cell,
/// in cells. Their difference is 0 on the borders of the cells that the points own (Worley 1996).
struct CellDistances {
  double nearest, second;
};
/// Returns the distances on a plane of cells that repeats after `period` of them along x and y; the
/// period is even.
/// @param time  at each whole time the points are in other places of their cells.
[[nodiscard]] CellDistances DistancesInCells(const glm::dvec2& cells, double time, int period,
                                             std::uint32_t seed);

/// Octaves of noise.
struct NoiseOctaves {
  int cells = 4;       // of the first octave, per period; each octave doubles them
  int octaves = 4;     // >= 1
  double gain = 0.55;  // of amplitude per octave
  std::uint32_t seed = 1;
};

/// A cube of noise that repeats along all axes, of mean 0 and standard deviation 1, with trilinear
/// interpolation. Immutable; safe to use from many threads.
class TilingNoise {
 public:
  /// @param side  texels per period: a power of two in [8, 256].
  [[nodiscard]] static TilingNoise Billow(int side, const NoiseOctaves& octaves);
  [[nodiscard]] static TilingNoise Value(int side, const NoiseOctaves& octaves);

  /// Returns the noise. @param periods  coordinates in periods, within 1e6.
  [[nodiscard]] double At(const glm::dvec3& periods) const;
  [[nodiscard]] int side() const { return side_; }
  /// Returns a texel; x runs fastest.
  [[nodiscard]] float Texel(std::size_t i) const { return texels_[i]; }
  /// Returns bounds of the noise.
  [[nodiscard]] double Least() const { return static_cast<double>(least_); }
  [[nodiscard]] double Largest() const { return static_cast<double>(largest_); }

 private:
  TilingNoise(int side, std::vector<float> texels);

  int side_;
  std::vector<float> texels_;
  float least_, largest_;
};

/// Three independent cubes of value noise, evaluated together. Immutable; safe to use from many
/// threads.
class TilingVectorNoise {
 public:
  /// @param side  as for TilingNoise. The cubes have the seed of the octaves and the two hundreds
  /// above.
  TilingVectorNoise(int side, const NoiseOctaves& octaves);

  /// Returns the noise. @param periods  coordinates in periods, within 1e6.
  [[nodiscard]] glm::dvec3 At(const glm::dvec3& periods) const;
  /// Returns bounds of each component.
  [[nodiscard]] double Least() const { return least_; }
  [[nodiscard]] double Largest() const { return largest_; }

 private:
  // One component is unused: four floats are processed by one instruction.
  using Four = float __attribute__((vector_size(16)));

  int side_;
  std::vector<std::array<float, 4>> texels_;
  double least_, largest_;
};

}  // namespace alpenglow::renderer
