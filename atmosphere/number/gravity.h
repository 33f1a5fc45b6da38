// SPDX-License-Identifier: MIT
// Acceleration of free fall, as standards have it.
#pragma once

namespace alpenglow::atmosphere {

inline constexpr double kStandardGravity_m_per_s2 = 9.80665;  // CGPM 1901

}  // namespace alpenglow::atmosphere
