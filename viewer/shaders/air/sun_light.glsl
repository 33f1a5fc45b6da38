// SPDX-License-Identifier: MIT
// Sun and moon as disks: the part of the sun above the horizon, and the radiance of both (sun.h,
// moon.h).

uniform vec4 moon;      // unit vector to the apparent moon, in the eye's frame; angular radius
uniform vec4 moon_colour;      // spectral reflectance relative to 550 nm
uniform float moon_earthshine;  // radiance per irradiance, uniform over the disk
uniform vec4 moon_lit;  // unit vector from the moon to the sun; radiance per irradiance, 0: no moon

// Returns the angle of a sine in [-1, 1]. The asin() and acos() of some drivers are accurate only
// to 1e-4, a fiftieth of the disk.
float AngleOfSine(float sine) { return atan(sine, sqrt(max((1.0 - sine) * (1.0 + sine), 0.0))); }

// Returns the fraction of the disk above the horizon, and the zenith cosine of the visible part's
// centre.
vec2 DiskOverHorizon(float mu_s, float horizon_mu, float radius) {
  float elevation = AngleOfSine(clamp(mu_s, -1.0, 1.0));
  float x = (elevation - AngleOfSine(clamp(horizon_mu, -1.0, 1.0))) / radius;
  if (x >= 1.0) return vec2(1.0, mu_s);
  if (x <= -1.0) return vec2(0.0, mu_s);
  float chord = sqrt((1.0 - x) * (1.0 + x));
  float area = atan(chord, -x) + x * chord;
  // The centre of the last sliver must lie within it, in spite of rounding of the area.
  float rise = clamp(2.0 / 3.0 * chord * chord * chord / max(area, 1e-10), max(-x, 0.0), 1.0);
  return vec2(area / 3.14159265359, sin(elevation + rise * radius));
}

// Returns the fraction of a pixel that the moon's disk covers.
float CoveredByMoon(vec3 direction, float width) {
  vec3 beside = direction - moon.xyz;
  float rho = length(beside - dot(beside, moon.xyz) * moon.xyz) / max(sin(moon.w), 1e-6);
  return dot(direction, moon.xyz) <= 0.0 ? 0.0 : clamp((1.0 - rho) * moon.w / width + 0.5, 0.0, 1.0);
}

// Returns the radiance of the sun's disk outside the air, per unit of its irradiance [1/sr], times
// the fraction of a pixel that the disk covers; one value per band.
vec4 SunDiskRadiance(vec3 direction, float width) {
  float radius = sun.w;
  float rho = 2.0 * asin(min(0.5 * length(direction - sun.xyz), 1.0)) / radius;
  float covered = clamp((1.0 - rho) * radius / width + 0.5, 0.0, 1.0);
  if (covered <= 0.0) return vec4(0.0);
  float half_sine = sin(0.5 * radius);
  vec4 darkening =
      vec4(SunLimbDarkeningAt(rho, wavelengths.x), SunLimbDarkeningAt(rho, wavelengths.y),
           SunLimbDarkeningAt(rho, wavelengths.z), SunLimbDarkeningAt(rho, wavelengths.w));
  return covered / (4.0 * 3.14159265359 * half_sine * half_sine) * darkening;
}

// Returns the radiance of the moon's disk outside the air, per unit of solar irradiance [1/sr],
// times the fraction of a pixel that the disk covers; one value per band.
vec4 MoonRadiance(vec3 direction, float width) {
  vec3 beside = direction - moon.xyz;
  vec3 at = (beside - dot(beside, moon.xyz) * moon.xyz) / max(sin(moon.w), 1e-6);
  float rho = length(at);
  float covered = CoveredByMoon(direction, width);
  if (covered <= 0.0) return vec4(0.0);
  // A pixel whose centre is beyond the limb has the radiance of the limb.
  const float kLimb = 0.999;
  at *= min(kLimb / max(rho, 1e-6), 1.0);
  float mu_seen = sqrt(1.0 - dot(at, at));
  float mu_lit = dot(at - mu_seen * moon.xyz, moon_lit.xyz);
  return covered * (moon_lit.w * LommelSeeliger(mu_lit, mu_seen) + moon_earthshine) * moon_colour;
}
