// SPDX-License-Identifier: MIT
// Refracted disks of sun and moon near the horizon, with dispersion and extinction per band:
// RefractedDisk of refracted_disk.h. The block View must hold the true sun, and `moon`
// (air/sun_light.glsl) the true moon.
#define DISK_NODES 13

// Nodes by elevation, first of the sun, then of the moon; one component per band.
uniform vec4 disk_lift[2 * DISK_NODES];   // apparent minus true elevation [rad]
uniform vec4 disk_depth[2 * DISK_NODES];  // optical depth minus that of a straight ray
uniform vec4 disk_nodes;  // of sun and moon: elevation of the first node [rad], nodes per radian
uniform vec2 disk_shares;  // factors of the light of sun and moon; 0: the disk is not drawn

struct DiskAir {
  vec4 lift, depth;
};

// Returns the refraction and extinction at an elevation.
// @param of  0: the sun; 1: the moon.
DiskAir DiskAirAt(int of, float elevation) {
  vec2 nodes = of == 0 ? disk_nodes.xy : disk_nodes.zw;
  float at = clamp((elevation - nodes.x) * nodes.y, 0.0, float(DISK_NODES - 1));
  int below = min(int(at), DISK_NODES - 2);
  int node = of * DISK_NODES + below;
  float share = at - float(below);
  return DiskAir(mix(disk_lift[node], disk_lift[node + 1], share),
                 mix(disk_depth[node], disk_depth[node + 1], share));
}

// Returns the radiance of both disks per unit of the sun's irradiance [1/sr]: for each band,
// SunDiskRadiance and MoonRadiance in the true direction.
// @param width  angle between rays in this direction [rad].
vec4 RefractedDisks(vec3 direction, float width) {
  float level = length(direction.xy);
  float elevation = AngleOfSine(clamp(direction.z, -1.0, 1.0));
  DiskAir of_sun = DiskAirAt(0, elevation), of_moon = DiskAirAt(1, elevation);
  vec4 disks;
  for (int band = 0; band < 4; ++band) {
    vec3 to_sun = TurnedUp(direction, level, -of_sun.lift[band]);
    vec3 to_moon = TurnedUp(direction, level, -of_moon.lift[band]);
    float beside_moon = 1.0 - CoveredByMoon(to_moon, width);
    float by_sun = exp(-of_sun.depth[band]) * SunDiskRadiance(to_sun, width)[band];
    float by_moon = exp(-of_moon.depth[band]) * MoonRadiance(to_moon, width)[band];
    disks[band] = disk_shares.x * beside_moon * by_sun + disk_shares.y * by_moon;
  }
  return disks;
}
