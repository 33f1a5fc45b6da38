// SPDX-License-Identifier: MIT
// Heights on a square grid of metres, and what can be done to them without knowing about water.
//
// The built-in range before rivers: where the land rises, how fast, and how hard it is.
//
// Places are kilometres east (x) and north (y) of the centre, within kHalfWidth_km. Every seed is
// another range, but for the foreland behind the view, which is that of seed 0.
//
// Heights that take a second to make and are always the same, kept between runs.
//
// One file a name, NAME-FINGERPRINT.f32 (floats as the machine has them), in the folder that
// ALPENGLOW_CACHE names, else in $XDG_CACHE_HOME/alpenglow, else in ~/.cache/alpenglow; an empty
// ALPENGLOW_CACHE keeps nothing. The fingerprint of what is wanted is known to the program, so that
// nothing old, foreign or damaged is ever taken for it. Files are written whole or not at all, so
// any number of processes may share the folder; older ones of the same name are removed, which
// bounds its size.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
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

inline constexpr double kRangeSpacing_km = 0.07;
inline constexpr int kRangeSize = 1024;
inline constexpr double kRangeHalfWidth_km = 0.5 * kRangeSpacing_km * (kRangeSize - 1);

/// Where the view of the range stands.
inline constexpr double kRangeViewEast_m = 2000.0, kRangeViewNorth_m = 16560.0;

/// Uplift relative to that of a main chain, about 0 to 3: five parallel chains, foothills in the
/// north, one summit above all.
[[nodiscard]] double RelativeUplift(double x_km, double y_km, std::uint32_t seed);

/// Erodibility relative to the mean, about 0.5 to 2.
[[nodiscard]] double RelativeErodibility(double x_km, double y_km, std::uint32_t seed);

/// Tangent of the angle at which the rock slides, 0.35 to
/// 1.3: rock that rises fast is fresh and stands steeper.
[[nodiscard]] double SteepestSlope(double x_km, double y_km, double relative_uplift,
                                   std::uint32_t seed);

/// Height of the outlets [m]: the foreland, which falls to 0 at the rim.
[[nodiscard]] double BaseHeight(double x_km, double y_km);

/// How alpine a place is: 0 in the foreland and at the rim, 1 among the chains.
[[nodiscard]] double Alpine(double x_km, double y_km, std::uint32_t seed);

/// How much a place belongs to the crest that the view stands on: 1 within 0.3 km, 0 from 6 km on.
[[nodiscard]] double CrestUnderView(double x_km, double y_km);

/// FNV-1a, 64 bits, of the heights' bytes, little-endian.
[[nodiscard]] std::uint64_t FingerprintOf(const std::vector<float>& height_m);

/// Where heights are kept; nothing where they are not.
[[nodiscard]] std::optional<std::filesystem::path> CacheFolder();

/// What heights are wanted.
struct WantedHeights {
  std::string name;
  std::uint64_t fingerprint;
  std::size_t count;
};

/// The kept heights, or those that `make` makes; these are kept if they are what is wanted. A
/// folder that cannot be read or written costs time, nothing else.
[[nodiscard]] std::vector<float> KeptHeights(const WantedHeights& wanted,
                                             const std::function<std::vector<float>()>& make);

}  // namespace alpenglow::renderer
