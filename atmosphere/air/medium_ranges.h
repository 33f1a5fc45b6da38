// SPDX-License-Identifier: MIT
// What the numbers of a medium may be: one place for the check of a medium and of its file.
#pragma once

#include <cstddef>

#include "atmosphere/air/scattering_matrix.h"

namespace alpenglow::atmosphere::ranges {

struct Range {
  double low, high;
};

inline constexpr Range kWavelength_nm{200.0, 4000.0};
inline constexpr Range kSolarIrradiance{0.0, 1e6};
inline constexpr Range kAlbedo{0.0, 1.0};
/// Up to an optical depth of 1e5 in a layer of 1 m.
inline constexpr Range kCoefficient_per_m{0.0, 1e5};
/// Beyond 1e8 m (40 % more than Jupiter) light along grazing rays is wrong by 0.1 % in double and 1
/// % in float; below, what is allowed depends on the air (kLeastRadiusInScaleHeights and below).
inline constexpr Range kPlanetRadius_m{1e3, 1e8};
inline constexpr Range kAtmosphereTop_m{1.0, 1e7};
/// In a layer of 100 m sixteen nodes along a ray leave 0.2 % (rms) to 1 % of what is scattered
/// once, and more in thinner ones. Fog is a medium of its own in pictures.
inline constexpr Range kScaleHeight_m{100.0, 2e5};
inline constexpr Range kDeficit{0.0, 1.0};
inline constexpr Range kDepolarisation{0.0, kLargestDepolarisation};
inline constexpr Range kOzoneAltitude_m{0.0, 1e7};

/// Radius over scale height. Columns are two terms of a series in its
/// inverse (optical_depth.glsl) that leave 0.19 of its square: 3e-4
/// of an optical depth here, at most 1e-3 of light scattered once.
inline constexpr double kLeastRadiusInScaleHeights = 25.0;
/// The least distance from the peak of ozone to either end of its layer: single precision tells them
/// apart, and the density between them has a slope.
inline constexpr double kLeastOzoneSide_m = 1.0;
/// Radius over the top of a smooth layer of ozone, whose rule of nodes goes wrong by 5e-4 of its
/// column here, by 1e-2 at half of it and by any amount beyond.
inline constexpr double kLeastRadiusInSmoothOzone = 3.0;

/// Top over the molecules' scale height. Nodes of diffuse light stand at equal steps of the root of
/// the altitude: beyond this the lowest layer of air slips between them (2 % at 300, 10 % at 1200).
inline constexpr double kHighestTopInScaleHeights = 300.0;
/// The top may cut off this much of a smooth layer of ozone (5e-7 of its column).
inline constexpr double kEndOfSmoothOzone = 0.9;
/// Scale heights of the deficit of molecules after which nothing is left of it (3e-4).
inline constexpr double kEndOfDeficit = 8.0;

/// Most bands of a medium: one each nanometre from 360 to 830 nm, and some.
inline constexpr std::size_t kMostWavelengths = 512;

}  // namespace alpenglow::atmosphere::ranges
