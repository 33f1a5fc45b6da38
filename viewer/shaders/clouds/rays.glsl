// SPDX-License-Identifier: MIT
// The maps of clouds have the rays of every cloud_scale-th pixel in both directions.
uniform sampler2D surface_map;  // distance [m] in the fourth component, 0: no terrain
uniform ivec2 picture_size;
uniform int cloud_scale;

struct CloudMapRay {
  vec3 direction;
  float length_km;  // to the ground, or kToSpace_km
};

// Returns the pixel whose ray a texel of a map has. The last ones may lie at the border of the picture.
ivec2 PixelOfTexel(ivec2 texel) {
  return min(texel * cloud_scale + cloud_scale / 2, picture_size - 1);
}

// Returns the ray of a texel of a map.
CloudMapRay RayOfTexel(ivec2 texel) {
  ivec2 pixel = PixelOfTexel(texel);
  vec3 direction = ViewDirection((2.0 * vec2(pixel) + 1.0) / vec2(picture_size) - 1.0);
  float distance_m = texelFetch(surface_map, pixel, 0).w;
  float length_km = distance_m > 0.0        ? 1e-3 * distance_m
                    : SeesPlanet(direction) ? PlanetDistance(direction)
                                            : kToSpace_km;
  return CloudMapRay(direction, length_km);
}
