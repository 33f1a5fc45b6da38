// SPDX-License-Identifier: MIT
// Values over the ground that repeat along x and y: thickness of layers, heights of bases, noise.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <vector>

namespace alpenglow::renderer {

/// Octaves of value noise over the ground, which changes slowly with time. The wavelength of an
/// octave is half of that of the one before, and it changes 2^(2/3) times as fast, as eddies of a
/// turbulent flow do (Kolmogorov 1941).
struct GroundNoise {
  double wavelength_m = 1000.0;  // of the first octave; the nearest that divides the period
  int octaves = 3;
  double gain = 0.5;         // of amplitude per octave
  double change_s = 3000.0;  // time in which the first octave becomes another
  std::uint32_t seed = 1;

  /// Returns the noise, of standard deviation 0.40 for the first octave.
  [[nodiscard]] double At(const glm::dvec2& point_m, double time_s, double period_m) const;
};

/// Samples with bilinear interpolation. Immutable; safe to use from many threads.
class PeriodicMap {
 public:
  /// @param side  samples along x and y, >= 2. @param value  at a point [m]; called from many
  /// threads.
  PeriodicMap(int side, double period_m, const std::function<double(const glm::dvec2&)>& value);

  [[nodiscard]] double At(const glm::dvec2& point_m) const;
  /// Returns an upper bound of At in a box [m].
  [[nodiscard]] double LargestIn(const glm::dvec2& low_m, const glm::dvec2& high_m) const;
  /// Returns the value that a fraction of the samples does not exceed. @param fraction  in [0, 1].
  [[nodiscard]] double Quantile(double fraction) const;

 private:
  [[nodiscard]] double Sample(std::int32_t x, std::int32_t y) const;

  int side_;
  double per_sample_;  // 1/m
  std::vector<float> values_;
};

}  // namespace alpenglow::renderer
