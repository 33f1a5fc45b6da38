// SPDX-License-Identifier: MIT
// Rays of the eye through the shell, the planet's shadow on them, and points along them.

// A ray of the eye, from where it enters the air; distances [km] count from there.
struct AirRay {
  float h, mu, mu_s;   // at the entry
  float nu;            // cosine between the ray and the sun
  float sine_squared;  // of that angle, without cancelling
  float begin;         // of the entry, from the eye
  float reach;         // 0: the ray meets no air
  bool ground;         // ends at the ground
};

// `limit` [km] from the eye: the ray ends there, or at the ground or the top if nearer.
AirRay RayOf(vec3 direction, float limit) {
  AirRay ray;
  ray.nu = clamp(dot(direction, sun.xyz), -1.0, 1.0);
  vec3 across = cross(direction, sun.xyz);
  ray.sine_squared = dot(across, across);
  ray.h = EYE_ALTITUDE;
  ray.mu = clamp(direction.z, -1.0, 1.0);
  ray.mu_s = clamp(sun.z, -1.0, 1.0);
  ray.begin = 0.0;
  ray.reach = 0.0;
  ray.ground = GroundClearance(ray.h, ray.mu, RADIUS) > 0.0;
  float end = ray.ground ? DistanceDownTo(ray.h, ray.mu, 0.0, RADIUS) : 0.0;
  if (ray.h > TOP) {
    if (ray.mu >= 0.0 || PerigeeAltitude(ray.h, ray.mu, RADIUS) >= TOP) return ray;
    ray.begin = DistanceDownTo(ray.h, ray.mu, TOP, RADIUS);
    float mu = ZenithCosineAlongRay(ray.h, ray.mu, ray.begin, TOP, RADIUS);
    ray.mu_s = SunCosineAlongRay(ray.h, ray.mu_s, ray.nu, ray.begin, TOP, RADIUS);
    ray.h = TOP;
    ray.mu = mu;
    end = ray.ground ? end : ray.begin - 2.0 * (RADIUS + TOP) * mu;
  } else if (!ray.ground) {
    end = DistanceUpTo(ray.h, ray.mu, TOP, RADIUS);
  }
  if (limit < end) {
    end = limit;
    ray.ground = false;
  }
  ray.reach = max(end - ray.begin, 0.0);
  return ray;
}

// The piece of a ray in the shadow of the planet, within [0, length]; empty when x >= y.
vec2 ShadowOf(AirRay ray) {
  float a = ray.sine_squared;
  if (MeetsShadow(ray.h, ray.mu, ray.mu_s, ray.nu, a, RADIUS) == 0.0) return vec2(0.0);
  float begin = max(0.0, ShadowBegin(ray.h, ray.mu, ray.mu_s, ray.nu, a, RADIUS));
  float end = min(ray.reach, ShadowEnd(ray.h, ray.mu, ray.mu_s, ray.nu, a, RADIUS));
  return begin < end ? vec2(begin, end) : vec2(0.0);
}

// A point along a ray.
struct AirPoint {
  float d, weight;  // distance and weight of the rule [km]
  float h, mu, mu_s;
  float rayleigh, mie;  // densities relative to altitude 0
};

AirPoint PointAt(AirRay ray, float d, float weight) {
  AirPoint point;
  point.d = d;
  point.weight = weight;
  point.h = max(AltitudeAlongRay(ray.h, ray.mu, d, RADIUS), 0.0);
  point.mu = ZenithCosineAlongRay(ray.h, ray.mu, d, point.h, RADIUS);
  point.mu_s = SunCosineAlongRay(ray.h, ray.mu_s, ray.nu, d, point.h, RADIUS);
  point.rayleigh = MoleculeDensity(point.h, RAYLEIGH_HEIGHT, deficit.x, deficit.y);
  point.mie = exp(-point.h / MIE_HEIGHT);
  return point;
}
