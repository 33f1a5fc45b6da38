// SPDX-License-Identifier: MIT
// Clouds in a picture, from the maps of clouds/colour.frag.glsl by clouds/near_rays.glsl.
uniform sampler2D cloud_map;
uniform vec2 cloud_map_place;  // from pixels to the map: factor, offset
uniform sampler2D cloud_beam_map;
uniform mat3 cloud_screen_from_direction;  // of the view of the maps

// Returns the light of a pixel behind clouds.
// @param distance_km  of land or planet; kToSpace_km: none.
vec3 BehindClouds(vec3 light, float distance_km) {
  vec2 at = gl_FragCoord.xy * cloud_map_place.x + cloud_map_place.y;
  vec4 clouds = NearRays(cloud_map, cloud_beam_map, at, log2(max(distance_km, 1e-6)));
  return max(clouds.a * light + clouds.rgb, vec3(0.0));
}

// Returns what clouds leave of a disk in a direction, without the light that they scatter.
float BeamBehindClouds(vec3 direction) {
  vec3 at = cloud_screen_from_direction * direction;
  return at.z > 0.0 ? texture(cloud_beam_map, 0.5 + 0.5 * at.xy / at.z).r : 1.0;
}
