// SPDX-License-Identifier: MIT
// What share of their single scattering shade takes from the rays of every shaft_scale-th pixel in
// both directions; of rays that meet no terrain what share of all their light. Shares change less
// from ray to ray than light does, and in full shade not at all.

uniform sampler2D surface_map;  // distance [m] in the fourth component, 0 where no terrain is seen
uniform ivec2 picture_size;
uniform int shaft_scale;

out vec4 shaft;

void main() {
  ivec2 pixel = min(ivec2(gl_FragCoord.xy) * shaft_scale + shaft_scale / 2, picture_size - 1);
  vec2 at = (2.0 * vec2(pixel) + 1.0) / vec2(picture_size) - 1.0;
  vec3 direction = ViewDirection(at);
  float distance_m = texelFetch(surface_map, pixel, 0).w;
  float distance_km = distance_m > 0.0 ? 1e-3 * distance_m : 1e9;
  vec4 light = distance_m > 0.0 ? SingleTo(direction, distance_km) : SkyRadiance(direction);
  shaft = ShaftTexel(MarchedShade(direction, distance_km) / max(light, vec4(1e-20)), distance_km);
}
