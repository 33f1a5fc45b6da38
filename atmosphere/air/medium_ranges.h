// SPDX-License-Identifier: MIT
// What the numbers of a medium may be: one place for the check of a medium and of its file.
#pragma once

#include <cstddef>

namespace alpenglow::ranges {

struct Range {
  double low, high;
};

inline constexpr Range kWavelength_nm{200.0, 4000.0};
inline constexpr Range kSolarIrradiance{0.0, 1e6};
inline constexpr Range kAlbedo{0.0, 1.0};
/// Up to an optical depth of 1e5 in a layer of 1 m.
inline constexpr Range kCoefficient_per_m{0.0, 1e5};
inline constexpr Range kPlanetRadius_m{1e3, 1e9};
inline constexpr Range kAtmosphereTop_m{1.0, 1e7};
inline constexpr Range kScaleHeight_m{1.0, 2e5};
inline constexpr Range kDeficit{0.0, 1.0};
inline constexpr Range kOzoneAltitude_m{0.0, 1e7};

/// Most bands of a medium: one each nanometre from 360 to 830 nm, and some.
inline constexpr std::size_t kMostWavelengths = 512;

}  // namespace alpenglow::ranges
