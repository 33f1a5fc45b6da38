// SPDX-License-Identifier: MIT
// Heights on a square grid of metres, and what can be done to them without knowing about water.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace alpenglow::renderer {

/// Heights [m] on a square grid; row 0 is the northernmost.
struct Land {
  int size = 0;            // samples a side
  double spacing_m = 0.0;  // between samples
  std::vector<float> height_m;

  [[nodiscard]] std::size_t index(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(size) +
           static_cast<std::size_t>(column);
  }
  [[nodiscard]] float at(int row, int column) const { return height_m[index(row, column)]; }
  [[nodiscard]] bool IsRim(int row, int column) const {
    return row == 0 || column == 0 || row == size - 1 || column == size - 1;
  }

  /// East and north of the middle [km].
  struct Place {
    double x_km;
    double y_km;
  };
  [[nodiscard]] Place PlaceOf(int row, int column) const {
    return {1e-3 * spacing_m * (column - 0.5 * (size - 1)),
            1e-3 * spacing_m * (0.5 * (size - 1) - row)};
  }
};

/// Cubic (Catmull and Rom 1974) height between samples; beyond the rim the rim is continued.
[[nodiscard]] float CubicHeight(const Land& land, double row, double column);

/// Twice the samples a side, each moved by up to half of `roughness_m`, so that new gullies have
/// somewhere to start. The rim is kept at 0.
[[nodiscard]] Land Refined(const Land& coarse, double roughness_m, std::uint32_t seed);

/// Adds ribs and couloirs (ridged noise) where the land is steep, `height_m` high at slope 1.
[[nodiscard]] Land WithRibs(const Land& land, double height_m, double wavelength_km,
                            std::uint32_t seed);

/// Mixes each sample with the binomial mean of its 3 x 3 neighbourhood by its weight in [0, 1].
[[nodiscard]] Land Softened(const Land& land, const std::vector<float>& weight);

/// Moves every sample sideways by up to a few samples, smoothly: straight rivers bend.
[[nodiscard]] Land Bent(const Land& land, double samples, double wavelength_km, std::uint32_t seed);

}  // namespace alpenglow::renderer
