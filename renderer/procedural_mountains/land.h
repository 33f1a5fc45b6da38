// SPDX-License-Identifier: MIT
// This header provides heights on a square grid in metres, and operations on them that do not
// depend on water.
//
// It also provides the built-in range before erosion: places and rates of uplift, and hardness of
// the rock. Places are kilometres east (x) and north (y) of the centre, within kRangeHalfWidth_km.
// Every seed gives a different range, except for the foreland behind the view, which is always that
// of seed 0.
//
// It also provides a cache between runs for heights that take a second to generate and never
// change. There is one file per name, NAME-FINGERPRINT.f32 (floats in the machine's format), in the
// folder that ALPENGLOW_CACHE names, else in $XDG_CACHE_HOME/alpenglow, else in ~/.cache/alpenglow;
// an empty ALPENGLOW_CACHE disables the cache. The program contains the fingerprint of the wanted
// heights, so that files which are old, damaged or of another origin are never used. Files are
// written atomically, so any number of processes may share the folder. Older files of a name are
// removed, which bounds the folder's size.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace alpenglow::renderer {

/// Heights [m] on a square grid; row 0 is the northernmost. ProceduralMountains places it on the
/// earth, as an ElevationGrid.
struct Land {
  int size = 0;            // samples per side
  double spacing_m = 0.0;  // between samples
  std::vector<float> height_m;

  [[nodiscard]] std::size_t index(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(size) +
           static_cast<std::size_t>(column);
  }
  [[nodiscard]] float at(int row, int column) const { return height_m[index(row, column)]; }

  /// Position east and north of the middle [km].
  struct MapPoint {
    double x_km;
    double y_km;
  };
  [[nodiscard]] MapPoint PlaceOf(int row, int column) const {
    return {1e-3 * spacing_m * (column - 0.5 * (size - 1)),
            1e-3 * spacing_m * (0.5 * (size - 1) - row)};
  }
};

/// Returns the cubic (Catmull and Rom 1974) height between samples; beyond the rim the values of
/// the rim are repeated.
[[nodiscard]] float CubicHeight(const Land& land, double row, double column);

/// Returns the land with twice as many samples per side, each moved by up to half of `roughness_m`,
/// so that new gullies can start. The rim is kept at 0.
[[nodiscard]] Land Refined(const Land& coarse, double roughness_m, std::uint32_t seed);

/// Adds ribs and couloirs (ridged noise) where the land is steep, `height_m` high at slope 1.
[[nodiscard]] Land WithRibs(const Land& land, double height_m, double wavelength_km,
                            std::uint32_t seed);

/// Mixes each sample with the binomial mean of its 3 x 3 neighbourhood by its weight in [0, 1].
[[nodiscard]] Land Softened(const Land& land, const std::vector<float>& weight);

/// Moves every sample sideways by up to a few samples, smoothly, which bends straight rivers.
[[nodiscard]] Land Bent(const Land& land, double samples, double wavelength_km, std::uint32_t seed);

inline constexpr double kRangeSpacing_km = 0.07;
inline constexpr int kRangeSize = 1024;
inline constexpr double kRangeHalfWidth_km = 0.5 * kRangeSpacing_km * (kRangeSize - 1);

/// Position of the view of the range.
inline constexpr double kRangeViewEast_m = 2000.0, kRangeViewNorth_m = 16560.0;

/// Returns the uplift relative to that of a main chain, about 0 to 3: five parallel chains,
/// foothills in the north, one highest summit.
[[nodiscard]] double RelativeUplift(double x_km, double y_km, std::uint32_t seed);

/// Returns the erodibility relative to the mean, about 0.5 to 2.
[[nodiscard]] double RelativeErodibility(double x_km, double y_km, std::uint32_t seed);

/// Returns the tangent of the angle at which the rock slides, 0.35 to 1.3. Rock that rises fast is
/// fresh and stands steeper.
[[nodiscard]] double SteepestSlope(double x_km, double y_km, double relative_uplift,
                                   std::uint32_t seed);

/// Returns the height of the outlets [m]: the foreland, which falls to 0 at the rim.
[[nodiscard]] double BaseHeight(double x_km, double y_km);

/// Returns the weight of alpine terrain at a place: 0 in the foreland and at the rim, 1 among the
/// chains.
[[nodiscard]] double Alpine(double x_km, double y_km, std::uint32_t seed);

/// Returns the weight of the crest on which the view stands: 1 within 0.3 km of the view, 0 from 6
/// km on.
[[nodiscard]] double CrestUnderView(double x_km, double y_km);

/// Returns the FNV-1a hash, 64 bits, of the heights' bytes, little-endian.
[[nodiscard]] std::uint64_t FingerprintOf(const std::vector<float>& height_m);

/// Returns the folder of the cache; nullopt if the cache is disabled, or if no variable names a
/// folder and the user has no home.
[[nodiscard]] std::optional<std::filesystem::path> CacheFolder();

/// Identification of heights in the cache.
struct WantedHeights {
  std::string name;
  std::uint64_t fingerprint;
  std::size_t count;
};

/// Returns the cached heights, or those that `make` generates; these are stored if they match
/// `wanted`. A folder that cannot be read or written costs only time.
[[nodiscard]] std::vector<float> HeightCache(const WantedHeights& wanted,
                                             const std::function<std::vector<float>()>& make);

}  // namespace alpenglow::renderer
