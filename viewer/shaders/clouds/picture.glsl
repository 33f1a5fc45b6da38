// SPDX-License-Identifier: MIT
// Clouds in a picture, from the maps of clouds/colour.frag.glsl. Of the four nearest rays in the maps,
// those with land at about the same distance, or likewise without land, are averaged.
uniform sampler2D cloud_map;
uniform sampler2D cloud_surface_map;  // output of land/land.frag.glsl
uniform vec2 cloud_map_place;         // from pixels to the map: factor, offset
uniform int cloud_map_scale;
uniform sampler2D cloud_beam_map;
uniform mat3 cloud_screen_from_direction;  // of the view of the maps

// Returns the light of a pixel behind clouds.
// @param distance_m  of land; 0: none.
vec3 BehindClouds(vec3 light, float distance_m) {
  const float kTolerance = 0.1;  // of distances, as binary logarithms
  const float kNoLand_m = 1e7;
  vec2 at = gl_FragCoord.xy * cloud_map_place.x + cloud_map_place.y;
  ivec2 size = textureSize(cloud_map, 0);
  ivec2 low = ivec2(floor(at));
  vec2 share = at - vec2(low);
  ivec2 last = textureSize(cloud_surface_map, 0) - 1;
  float here = log2(distance_m > 0.0 ? distance_m : kNoLand_m);
  vec4 sum = vec4(0.0);
  float weights = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 side = ivec2(i % 2, i / 2);
    ivec2 texel = clamp(low + side, ivec2(0), size - 1);
    ivec2 pixel = min(texel * cloud_map_scale + cloud_map_scale / 2, last);
    float land_m = texelFetch(cloud_surface_map, pixel, 0).w;
    float away = log2(land_m > 0.0 ? land_m : kNoLand_m) - here;
    vec2 near = mix(1.0 - share, share, vec2(side));
    float weight = (near.x * near.y + 1e-4) / (away * away + kTolerance * kTolerance);
    sum += weight * texelFetch(cloud_map, texel, 0);
    weights += weight;
  }
  sum /= weights;
  return max(sum.a * light + sum.rgb, vec3(0.0));
}

// Returns what clouds leave of a disk in a direction, without the light that they scatter.
float BeamBehindClouds(vec3 direction) {
  vec3 at = cloud_screen_from_direction * direction;
  return at.z > 0.0 ? texture(cloud_beam_map, 0.5 + 0.5 * at.xy / at.z).r : 1.0;
}
