// SPDX-License-Identifier: MIT
// Irradiance of the open sky on a surface, fitted for surfaces up to 50 degrees steep:
//
//   E(n) = level + up n.up + sunward n.s,     s the horizontal direction towards the sun
//
// Steeper surfaces that face away from the sun get at least a tenth of `level`.
SHARED Number OpenSkyOn(Number level, Number up, Number sunward, Number n_up, Number n_sunward) {
  return max(level + up * n_up + sunward * n_sunward, Number(0.1) * level);
}
