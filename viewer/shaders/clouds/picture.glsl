// SPDX-License-Identifier: MIT
// Clouds in a picture, from the maps of clouds/colour.frag.glsl. Of the four nearest rays in the maps,
// those that meet land or the planet at about the same distance, or likewise nothing, are averaged.
uniform sampler2D cloud_map;
uniform vec2 cloud_map_place;  // from pixels to the map: factor, offset
uniform sampler2D cloud_beam_map;
uniform mat3 cloud_screen_from_direction;  // of the view of the maps

// Returns the light of a pixel behind clouds.
// @param distance_km  of land or planet; kToSpace_km: none.
vec3 BehindClouds(vec3 light, float distance_km) {
  vec2 at = gl_FragCoord.xy * cloud_map_place.x + cloud_map_place.y;
  ivec2 low = ivec2(floor(at)), last = textureSize(cloud_map, 0) - 1;
  vec2 share = at - vec2(low);
  float here = log2(max(distance_km, 1e-6));
  vec4 sum = vec4(0.0);
  float weights = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 side = ivec2(i % 2, i / 2);
    ivec2 texel = clamp(low + side, ivec2(0), last);
    float away = texelFetch(cloud_beam_map, texel, 0).g - here;
    float weight = WeightOfCloudRay(share, side, away);
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
