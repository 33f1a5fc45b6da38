// SPDX-License-Identifier: MIT
// Gathers the light of one layer of clouds along rays of a map.
layout(location = 0) out vec4 gathered;
layout(location = 1) out vec4 reach;  // binary logarithm of the length of the ray [km]

uniform ivec3 map_rays;  // texel of the map with the first ray; texels from each ray to the next

void main() {
  CloudMapRay ray = RayOfTexel(ivec2(gl_FragCoord.xy) * map_rays.z + map_rays.xy);
  gathered = GatheredAlong(ray.direction, ray.length_km);
  reach = vec4(log2(ray.length_km));
}
