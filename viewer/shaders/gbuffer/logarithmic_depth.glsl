// SPDX-License-Identifier: MIT
// Depth for GPUs that cannot reverse its range: one minus the logarithm of the distance, which
// resolves a millionth of the distance from 0.1 m to 1e9 m.
void WriteDepth(float distance_m) {
  gl_FragDepth = clamp(1.0 - log2(max(distance_m, 0.1) / 0.1) / log2(1e10), 0.0, 1.0);
}

// Returns the inverse depth (gbuffer/inverse_depth.glsl) for a depth value. `slant` is the distance
// divided by the distance along the view axis.
float InverseDepthOf(float depth, float slant) {
  float distance_m = 0.1 * exp2((1.0 - depth) * log2(1e10));
  return depth > 0.0 ? InverseDepth(distance_m / slant) : 0.0;
}
