// SPDX-License-Identifier: MIT
// Four fractions and a distance in one texel of four floats: the last four bits of each float, 2e-6
// of its value, hold a quarter of the logarithm of the distance in 65536 steps of 0.03 %.

const float kNearest_log2_km = -10.0, kFarthest_log2_km = 14.0;

uint DistanceCode(float distance_km) {
  float span = kFarthest_log2_km - kNearest_log2_km;
  float share = (log2(max(distance_km, 1e-6)) - kNearest_log2_km) / span;
  return uint(clamp(share, 0.0, 1.0) * 65535.0 + 0.5);
}

// Fractions are at least 1e-20, since the bits of a float near 0 would be lost.
vec4 ShaftTexel(vec4 share, float distance_km) {
  uvec4 code = (uvec4(DistanceCode(distance_km)) >> uvec4(0u, 4u, 8u, 12u)) & 15u;
  return uintBitsToFloat((floatBitsToUint(max(share, vec4(1e-20))) & ~15u) | code);
}

// Returns the binary logarithm of the distance [km].
float ShaftDistance(vec4 texel) {
  uvec4 part = (floatBitsToUint(texel) & 15u) << uvec4(0u, 4u, 8u, 12u);
  float share = float(part.x | part.y | part.z | part.w) / 65535.0;
  return mix(kNearest_log2_km, kFarthest_log2_km, share);
}
