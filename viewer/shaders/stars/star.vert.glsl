// SPDX-License-Identifier: MIT
// The point of 5 x 5 pixels that a star covers, unless land hides its centre: StarPoint of
// star_painter.h.
in vec4 star_corner;
in vec4 star_towards;
in vec4 star_light;
in vec4 star_across;
in vec4 star_up;
in vec4 star_last;
flat out vec3 light;
flat out vec4 across;
flat out vec4 up;
flat out vec4 last;
flat out vec2 corner;

uniform sampler2D surface_map;  // output of land/land.frag.glsl
uniform vec3 viewport;          // width, height, and its margin around the picture [pixels]
uniform bool surface_hides;     // land hides stars by surface_map; else by depth

bool IsHidden() {
  bool planet = SeesPlanet(star_towards.xyz);
  ivec2 middle = clamp(ivec2(star_corner.zw), ivec2(0), textureSize(surface_map, 0) - 1);
  return planet || (surface_hides && texelFetch(surface_map, middle, 0).w > 0.0);
}

void main() {
  vec3 towards = star_towards.xyz;
  light = LinearSrgb(star_light * TransmittanceToSpace(towards) * MediaTransmittance(towards, 1e3));
  across = star_across;
  up = star_up;
  last = star_last;
  corner = star_corner.xy;
  vec2 screen = 2.0 * (corner + 2.5 + viewport.z) / viewport.xy - 1.0;
  gl_Position = IsHidden() ? vec4(2.0, 2.0, 2.0, 1.0) : vec4(screen, -1.0, 1.0);  // depth 0
}
