// SPDX-License-Identifier: MIT
// The sun as a disk: what stands of it over the horizon, and how bright it is (sun_disk.h).

// The angle of a sine in [-1, 1]: asin() and acos() of
// some drivers are good to 1e-4, a fiftieth of the disk.
float AngleOfSine(float sine) { return atan(sine, sqrt(max((1.0 - sine) * (1.0 + sine), 0.0))); }

// Fraction of the disk over the horizon, and zenith cosine of the visible part's centre.
vec2 DiskOverHorizon(float mu_s, float horizon_mu, float radius) {
  float elevation = AngleOfSine(clamp(mu_s, -1.0, 1.0));
  float x = (elevation - AngleOfSine(clamp(horizon_mu, -1.0, 1.0))) / radius;
  if (x >= 1.0) return vec2(1.0, mu_s);
  if (x <= -1.0) return vec2(0.0, mu_s);
  float chord = sqrt((1.0 - x) * (1.0 + x));
  float area = atan(chord, -x) + x * chord;
  // The centre of the last sliver lies within it, whatever rounding leaves of the area.
  float rise = clamp(2.0 / 3.0 * chord * chord * chord / max(area, 1e-10), max(-x, 0.0), 1.0);
  return vec2(area / 3.14159265359, sin(elevation + rise * radius));
}

// Radiance of the sun's disk outside the air, per unit of its irradiance [1/sr], times the share of
// a pixel that the disk covers.
float SunDiskRadiance(vec3 direction, float width) {
  float radius = sun.w;
  float rho = 2.0 * asin(min(0.5 * length(direction - sun.xyz), 1.0)) / radius;
  float covered = clamp((1.0 - rho) * radius / width + 0.5, 0.0, 1.0);
  if (covered <= 0.0) return 0.0;
  float mu = sqrt(max(1.0 - rho * rho, 0.0));
  float darkening = (1.0 - 0.6 * (1.0 - mu)) / 0.8;
  float half_sine = sin(0.5 * radius);
  return covered * darkening / (4.0 * 3.14159265359 * half_sine * half_sine);
}
