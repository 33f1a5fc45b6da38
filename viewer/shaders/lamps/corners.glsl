// SPDX-License-Identifier: MIT
// Squares around directions in the picture, for the parts of lamps that are drawn over it.

// Returns a corner (gl_VertexID 0 to 3 of a strip) of the square that holds all directions within
// an angle [rad] of `towards`, or a point outside the picture if that direction is behind the eye.
vec4 LampCorner(vec3 towards, float angle) {
  vec2 size = vec2(length(view_right.xyz), length(view_up.xyz));
  float ahead = dot(towards, view_forward.xyz);
  vec2 place = vec2(dot(towards, view_right.xyz), dot(towards, view_up.xyz)) / (size * size);
  vec2 corner = vec2(gl_VertexID % 2, gl_VertexID / 2) * 2.0 - 1.0;
  if (ahead < 2.0 * angle + 0.02) return vec4(2.0, 2.0, 2.0, 1.0);
  float edge = ahead - angle;
  return vec4(place / ahead - PICTURE_SHIFT + corner * 1.1 * angle / (size * edge * edge), 0.0, 1.0);
}
