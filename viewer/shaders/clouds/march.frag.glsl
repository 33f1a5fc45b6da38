// SPDX-License-Identifier: MIT
// One layer of clouds along the rays of every cloud_scale-th pixel in both directions.
in vec2 screen;
out vec4 gathered;

uniform sampler2D surface_map;  // distance [m] in the fourth component, 0: no terrain
uniform ivec2 picture_size;
uniform int cloud_scale;

void main() {
  ivec2 pixel = min(ivec2(gl_FragCoord.xy) * cloud_scale + cloud_scale / 2, picture_size - 1);
  vec3 direction = ViewDirection((2.0 * vec2(pixel) + 1.0) / vec2(picture_size) - 1.0);
  float distance_m = texelFetch(surface_map, pixel, 0).w;
  float length_km = distance_m > 0.0        ? 1e-3 * distance_m
                    : SeesPlanet(direction) ? PlanetDistance(direction)
                                            : 1e3;
  gathered = GatheredAlong(direction, length_km);
}
