// SPDX-License-Identifier: MIT
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
