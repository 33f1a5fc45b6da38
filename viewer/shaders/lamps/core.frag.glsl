// SPDX-License-Identifier: MIT
// Scattered light close to a lamp, which the lattice does not resolve, added to the picture.
in vec2 screen;
flat in int number;
out vec4 picture;

uniform sampler2D surface_map;

void main() {
  vec3 direction = ViewDirection(screen);
  float part = LampCore(lamps[number], direction);
  if (part <= 0.0) discard;
  float end_m = LampRayEnd(direction, texelFetch(surface_map, ivec2(gl_FragCoord.xy), 0).w);
  picture = vec4(part * LampRgb(GlowOfLamp(lamps[number], direction, end_m, true)), 0.0);
}
