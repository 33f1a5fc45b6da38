// SPDX-License-Identifier: MIT
// The shapes of all genera share cubes of noise, which are made once, random numbers by count, and
// the direction of the wind.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>

#include "renderer/clouds/cloud_noise.h"
#include "renderer/clouds/cloud_options.h"

namespace alpenglow::renderer {

/// Periods of a cube when it is laid over a field; both divide kPeriodStep_m.
inline constexpr double kLargeTile_m = 2560.0, kSmallTile_m = 640.0;

/// Cubes of noise. The first call makes them; later ones return the same.
struct ShapeNoise {
  /// Bumps of a quarter of the period and less.
  [[nodiscard]] static const TilingNoise& Billow();
  /// Smooth offsets with waves of a quarter of the period and less.
  [[nodiscard]] static const TilingVectorNoise& Smooth();
};

/// Random numbers by count: number i of a stream depends on nothing else.
class CountedRandom {
 public:
  CountedRandom(std::uint32_t seed, std::uint32_t stream) : seed_(seed), stream_(stream) {}

  /// Returns the next number, uniform in [0, 1).
  [[nodiscard]] double Uniform() {
    return LatticeUniform(static_cast<std::int32_t>(count_++), static_cast<std::int32_t>(stream_),
                          seed_);
  }
  [[nodiscard]] double Between(double low, double high) { return low + (high - low) * Uniform(); }

 private:
  std::uint32_t seed_, stream_, count_ = 0;
};

/// Returns the direction to which the wind blows, as a unit vector; east if there is no wind.
[[nodiscard]] glm::dvec2 WindDirection(const CloudOptions& options);

}  // namespace alpenglow::renderer
