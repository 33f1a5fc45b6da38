// SPDX-License-Identifier: MIT
// Provides the air for the flight model and for reports of the weather: the U.S. Standard Atmosphere
// 1976 (NOAA-S/T 76-1562), layers of constant lapse rate up to 84.852 km of geopotential height:
//
//   T = T_b + L_b (H - H_b)
//   p = p_b (T_b / T)^(g0 M / (R* L_b)),   or p_b exp(-g0 M (H - H_b) / (R* T_b)) where L_b is 0
//   H = r0 h / (r0 + h),                   r0 = 6356.766 km
//
// Heights above the ellipsoid are used as heights above the sea, which is within 110 m of it.
#pragma once

namespace alpenglow::atmosphere {

struct StandardAir {
  double density_kg_per_m3;
  double sound_m_per_s;  // speed of sound
  double temperature_k, pressure_pa;
};

/// Gas constant of dry air with the values of the standard, 8314.32 / 28.9644.
inline constexpr double kGasOfAir_J_per_kg_K = 8314.32 / 28.9644;
inline constexpr double kStandardPressure_pa = 101325.0;  // at the sea

/// Returns the air at a height. The relative error against the published table is below 1e-4 from
/// 0 to 80 km. Below the sea the lowest layer is continued; above 86 km the density continues to
/// decrease with the last scale height.
[[nodiscard]] StandardAir StandardAirAt(double height_m);

}  // namespace alpenglow::atmosphere
