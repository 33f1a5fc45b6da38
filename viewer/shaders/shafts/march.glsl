// SPDX-License-Identifier: MIT
// Single scattering that terrain shadows remove from a ray, by marching through a SunShadowMap
// (renderer/visibility/sun_shadow_map.h).
//
// Requires vec4 SingleTo(vec3 direction, float distance_km): single scattering of sunlight up to a
// distance in unshadowed air. Defined before this text: LEFT_BY_MEDIA(direction, distance_km), the
// transmittance of media up to a distance.

uniform sampler2D shade_map;  // shadow height of the disk's middle, half height of its penumbra [m]
// These rows map metres around the eye (east, north, up, 1) to the map's coordinates and height.
uniform vec4 shade_u, shade_v, shade_z;
uniform vec2 shade_first;  // first u coordinate of the map, and descent of the shadow before it
uniform vec3 shade_low, shade_high;  // box that holds all shadows, in these coordinates
uniform int shade_pieces;            // pieces of the shadowed stretch: one SingleTo each
uniform int shade_steps;             // steps of a piece: one fetch of the map each

// Returns the part of a stretch where a + t b >= 0.
vec2 KeptWhere(vec2 stretch, float a, float b) {
  if (b == 0.0) return a < 0.0 ? vec2(1.0, 0.0) : stretch;
  float t = -a / b;
  return b > 0.0 ? vec2(max(stretch.x, t), stretch.y) : vec2(stretch.x, min(stretch.y, t));
}

// A ray in the map's coordinates: position of the eye, and change per metre.
struct ShadeRay {
  vec3 eye, slope;
};

ShadeRay ShadeRayOf(vec3 direction) {
  return ShadeRay(
      vec3(shade_u.w, shade_v.w, shade_z.w),
      vec3(dot(shade_u.xyz, direction), dot(shade_v.xyz, direction), dot(shade_z.xyz, direction)));
}

// Returns the stretch [m] of a ray that may be shadowed. It is empty if its end is before its
// start.
vec2 ShadeStretch(ShadeRay ray, float length_m) {
  vec2 stretch = vec2(0.0, length_m);
  stretch = KeptWhere(stretch, shade_high.z - ray.eye.z, -ray.slope.z);
  stretch = KeptWhere(stretch, ray.eye.z - shade_low.z, ray.slope.z);
  stretch = KeptWhere(stretch, ray.eye.x - shade_low.x, ray.slope.x);
  stretch = KeptWhere(stretch, shade_high.x - ray.eye.x, -ray.slope.x);
  stretch = KeptWhere(stretch, ray.eye.y - shade_low.y, ray.slope.y);
  return KeptWhere(stretch, shade_high.y - ray.eye.y, -ray.slope.y);
}

// Returns the height above the shadow for the disk's middle, and half the height of the penumbra
// [m].
vec2 OverShade(ShadeRay ray, float t) {
  vec3 at = ray.eye + t * ray.slope;
  vec2 shade = textureLod(shade_map, at.xy, 0.0).xy;
  float fallen = max(shade_first.x - at.x, 0.0) * shade_first.y;
  return vec2(at.z - shade.x + fallen, shade.y);
}

// Integral of the sunlight over an edge, from a fully hidden disk to a disk at height x above it in
// radii, with the integrand 0.5 + 0.7 x - 0.2 x^3, which is SunlightOverEdge (sunlit_path.h) within
// 0.01.
float SunlightUpTo(float x) {
  float s = clamp(x, -1.0, 1.0);
  return ((-0.05 * s * s + 0.35) * s + 0.5) * s + 0.2 + max(x - 1.0, 0.0);
}

// Returns the mean fraction of sunlight that is missing between two points of a ray, with linear
// heights.
float MeanDarkness(vec2 from, vec2 to) {
  float radius = max(0.5 * (from.y + to.y), 0.01);
  float x = from.x / radius, y = to.x / radius;
  float middle = 0.5 * (x + y);
  // For a smaller difference the integrals would cancel.
  float least = 0.01 * max(1.0, abs(middle));
  float apart = abs(y - x) < least ? least : y - x;
  return 1.0 - (SunlightUpTo(middle + 0.5 * apart) - SunlightUpTo(middle - 0.5 * apart)) / apart;
}

// Returns the distance at which a fraction of a stretch's light has accumulated. The second half of
// the stretch contributes `left` times as much as the first half, with exponential decrease.
float ShadeDistance(vec2 stretch, float share, float left) {
  float thinning = 1.0 - left * left;
  return mix(stretch.x, stretch.y, log(1.0 - share * thinning) / log(1.0 - thinning));
}

// Returns the light [1/sr per unit irradiance] that shadows remove from the ray up to a distance,
// attenuated by media. Steps contribute about equal light; SingleTo gives the light of a piece of
// them.
vec4 MarchedShade(vec3 direction, float distance_km) {
  ShadeRay ray = ShadeRayOf(direction);
  vec2 stretch = ShadeStretch(ray, 1e3 * distance_km);
  int pieces = stretch.x < stretch.y ? shade_pieces : 0;
  float share_of_step = 1.0 / float(shade_pieces * shade_steps);
  vec4 single = SingleTo(direction, 1e-3 * stretch.x);
  vec4 middle = SingleTo(direction, 5e-4 * (stretch.x + stretch.y));
  vec4 whole = SingleTo(direction, 1e-3 * stretch.y);
  float left = dot(whole - middle, vec4(1.0)) / max(dot(middle - single, vec4(1.0)), 1e-20);
  left = clamp(left, 0.1, 0.99);
  vec4 shaded = vec4(0.0);
  float clear = LEFT_BY_MEDIA(direction, 1e-3 * stretch.x);
  vec2 over = OverShade(ray, stretch.x);
  for (int piece = 1; piece <= pieces; ++piece) {
    float dark = 0.0;
    for (int step = shade_steps - 1; step >= 0; --step) {
      float share = float(piece * shade_steps - step) * share_of_step;
      vec2 next = OverShade(ray, ShadeDistance(stretch, share, left));
      dark += MeanDarkness(over, next);
      over = next;
    }
    float end = ShadeDistance(stretch, float(piece) / float(shade_pieces), left);
    vec4 farther = piece < shade_pieces ? SingleTo(direction, 1e-3 * end) : whole;
    float clear_there = LEFT_BY_MEDIA(direction, 1e-3 * end);
    shaded += 0.5 * (clear + clear_there) * dark / float(shade_steps) * (farther - single);
    single = farther;
    clear = clear_there;
  }
  return shaded;
}
