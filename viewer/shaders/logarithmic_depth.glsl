// SPDX-License-Identifier: MIT
// For cards whose depth cannot run from 1 to 0: one minus the logarithm of the distance, which
// resolves a part in a million from 0.1 m to 1e9 m.
void WriteDepth(float distance_m) {
  gl_FragDepth = clamp(1.0 - log2(max(distance_m, 0.1) / 0.1) / log2(1e10), 0.0, 1.0);
}

// Nearness (nearness.glsl) at a depth; `slant` is distance over distance along the view.
float NearnessOfDepth(float depth, float slant) {
  float distance_m = 0.1 * exp2((1.0 - depth) * log2(1e10));
  return depth > 0.0 ? Nearness(distance_m / slant) : 0.0;
}
