// SPDX-License-Identifier: MIT
// Maps a slope to the table of the open sky's irradiance (sky_irradiance_gradient.h): equal steps of the
// components of its unit normal towards the sun, -1 to 1, and upwards, 0 to 1. The sky is symmetric
// about the azimuth of the sun, so these two components are sufficient, and the irradiance is a
// smooth function of them.
SHARED Number UnoccludedSkyColumn(Number n_sunward) {
  return Number(4.0) * (min(max(n_sunward, Number(-1.0)), Number(1.0)) + Number(1.0));
}
SHARED Number UnoccludedSkyRow(Number n_up) {
  return Number(4.0) * min(max(n_up, Number(0.0)), Number(1.0));
}
