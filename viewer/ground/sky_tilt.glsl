// SPDX-License-Identifier: MIT
// Where a slope lies in the table of the open sky's irradiance (sky_on_ground.h): even steps of its unit
// normal's components towards the sun, -1 to 1, and upwards, 0 to 1. Both halves of the sky beside the sun
// are alike, so that these two say all, and the irradiance is smooth in them.
SHARED Number OpenSkyColumn(Number n_sunward) {
  return Number(4.0) * (min(max(n_sunward, Number(-1.0)), Number(1.0)) + Number(1.0));
}
SHARED Number OpenSkyRow(Number n_up) {
  return Number(4.0) * min(max(n_up, Number(0.0)), Number(1.0));
}
