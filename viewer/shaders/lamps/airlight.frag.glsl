// SPDX-License-Identifier: MIT
// Scattered light of lamps at every LampStep()-th pixel, without the cores, and the inverse of the
// distance at which the ray ends [1/m].
out vec4 lattice;

uniform sampler2D surface_map;
uniform vec2 picture_size;  // [pixels]

void main() {
  vec2 at = floor(gl_FragCoord.xy) * float(LampStep());
  vec2 screen = (2.0 * at + 1.0) / picture_size - 1.0;
  vec3 direction = ViewDirection(screen);
  ivec2 texel = min(ivec2(at), textureSize(surface_map, 0) - 1);
  float end_m = LampRayEnd(direction, texelFetch(surface_map, texel, 0).w);
  lattice = vec4(LampRgb(LampAirlightIn(direction, end_m, 0.0)), 1.0 / end_m);
}
