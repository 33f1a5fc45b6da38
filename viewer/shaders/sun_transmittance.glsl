// SPDX-License-Identifier: MIT
// What the air leaves of the sun's light at an altitude [km], by closed forms.
vec4 TransmittanceToSun(float altitude_km, float mu_s) {
  return exp(-OpticalDepth(ColumnsToSun(altitude_km, mu_s)));
}
