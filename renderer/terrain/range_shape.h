// SPDX-License-Identifier: MIT
// The built-in range before rivers: where the land rises, how fast, and how hard it is.
//
// Places are kilometres east (x) and north (y) of the centre, within kHalfWidth_km. Every seed is
// another range, but for the foreland behind the view, which is that of seed 0.
#pragma once

#include <cstdint>

namespace alpenglow::renderer {

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

}  // namespace alpenglow::renderer
