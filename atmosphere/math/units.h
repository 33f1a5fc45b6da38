// SPDX-License-Identifier: MIT
// Units of aviation.
#pragma once

namespace alpenglow::atmosphere {

inline constexpr double kMetresPerFoot = 0.3048;  // exact (international yard and pound, 1959)
inline constexpr double kMetresPerStatuteMile = 5280.0 * kMetresPerFoot;
inline constexpr double kMetresPerNauticalMile = 1852.0;  // exact (Monaco, 1929)

}  // namespace alpenglow::atmosphere
