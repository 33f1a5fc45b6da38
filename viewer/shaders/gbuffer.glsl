// SPDX-License-Identifier: MIT
// Encoding of the values of a GBuffer.

//// gbuffer.octahedral.glsl
// Unit vectors as two numbers in [-1, 1]: the sphere is projected onto an octahedron whose lower
// half is unfolded.
//
// Meyer et al. (2010), On floating-point normal vectors, Computer Graphics Forum 29 (4). The
// formulas follow Cigolle et al. (2014), Journal of Computer Graphics Techniques 3 (2).
vec2 OctahedralSides(vec2 v) { return vec2(v.x >= 0.0 ? 1.0 : -1.0, v.y >= 0.0 ? 1.0 : -1.0); }

// Encodes a vector of any length except 0.
vec2 OctahedralFromVector(vec3 v) {
  vec2 p = v.xy / (abs(v.x) + abs(v.y) + abs(v.z));
  return v.z >= 0.0 ? p : (1.0 - abs(p.yx)) * OctahedralSides(p);
}

vec3 UnitFromOctahedral(vec2 p) {
  vec3 v = vec3(p, 1.0 - abs(p.x) - abs(p.y));
  if (v.z < 0.0) v.xy = (1.0 - abs(v.yx)) * OctahedralSides(v.xy);
  return normalize(v);
}

//// gbuffer.inverse_depth.glsl
// Inverse depth of land, stored in the fourth component of a picture. On a plane it is linear over
// the picture, and half floats hold it from a metre to a thousand kilometres. 0: no land.
float InverseDepth(float along_view_m) { return 100.0 / along_view_m; }

//// gbuffer.reversed_depth.glsl
// Depth is interpolated by the GPU: nearest / distance along the view axis, which floats resolve to
// a part in ten million at any distance.
void WriteDepth(float distance_m) {}

// Returns the inverse depth (gbuffer.inverse_depth.glsl) for a depth value. `slant` is the distance divided
// by the distance along the view axis.
float InverseDepthOf(float depth, float slant) { return InverseDepth(0.1) * depth; }

//// gbuffer.logarithmic_depth.glsl
// Depth for GPUs that cannot reverse its range: one minus the logarithm of the distance, which
// resolves a millionth of the distance from 0.1 m to 1e9 m.
void WriteDepth(float distance_m) {
  gl_FragDepth = clamp(1.0 - log2(max(distance_m, 0.1) / 0.1) / log2(1e10), 0.0, 1.0);
}

// Returns the inverse depth (gbuffer.inverse_depth.glsl) for a depth value. `slant` is the distance divided
// by the distance along the view axis.
float InverseDepthOf(float depth, float slant) {
  float distance_m = 0.1 * exp2((1.0 - depth) * log2(1e10));
  return depth > 0.0 ? InverseDepth(distance_m / slant) : 0.0;
}
