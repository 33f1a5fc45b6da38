// SPDX-License-Identifier: MIT
// Where a direction lies in the map of diffuse light around the eye, and back. Layer 0: rays above
// the horizon, layer 1: rays to the ground. s: azimuth from the sun, 0 to pi (the other half is its
// mirror image); t: the root of the angle from the horizon, over its range, so that the steep rise
// at the horizon is resolved.
#define HORIZON_ELEVATION eye.y
#define AIR_ELEVATION eye.z

float ElevationRange(float layer) {
  return layer < 0.5 ? AIR_ELEVATION - HORIZON_ELEVATION : HORIZON_ELEVATION + 1.57079632679;
}

vec2 SkyMapUnit(float elevation, float azimuth, float layer) {
  float angle = layer < 0.5 ? elevation - HORIZON_ELEVATION : HORIZON_ELEVATION - elevation;
  return vec2(abs(azimuth) / 3.14159265359, sqrt(clamp(angle / ElevationRange(layer), 0.0, 1.0)));
}

// Elevation and azimuth [rad] of a place in the map.
vec2 SkyMapAngles(vec2 unit, float layer) {
  float angle = unit.y * unit.y * ElevationRange(layer);
  return vec2(layer < 0.5 ? HORIZON_ELEVATION + angle : HORIZON_ELEVATION - angle,
              unit.x * 3.14159265359);
}

// Horizontal unit vector towards the sun's azimuth; north when it stands overhead.
vec2 SunAzimuth() {
  float flat_length = length(sun.xy);
  return flat_length > 1e-6 ? sun.xy / flat_length : vec2(0.0, 1.0);
}
