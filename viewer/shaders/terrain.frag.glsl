// SPDX-License-Identifier: MIT
// What the eye sees of the terrain: normal and distance. Depth is the logarithm of the distance,
// which resolves a part in a million from 0.1 m to 1e9 m.
in vec3 from_eye;
in vec3 facing;
out vec4 surface;  // unit normal, on the side that is seen; distance [m]

void main() {
  float d = length(from_eye);
  vec3 n = normalize(facing);
  surface = vec4(gl_FrontFacing ? n : -n, d);
  gl_FragDepth = clamp(log2(max(d, 0.1) / 0.1) / log2(1e10), 0.0, 1.0);
}
