// SPDX-License-Identifier: MIT
// Gathers the light of one layer of clouds along the rays of a map.
out vec4 gathered;

void main() {
  CloudMapRay ray = RayOfCloudMap();
  gathered = GatheredAlong(ray.direction, ray.length_km);
}
