// SPDX-License-Identifier: MIT
// Light that the shadows of terrain remove from rays in air and fog.

//// shafts.march.glsl
// Single scattering that terrain shadows remove from a ray, by marching through a SunShadowMap
// (renderer/visibility/shade_map.h).
//
// Requires vec4 SingleTo(vec3 direction, float distance_km): single scattering of sunlight up to a
// distance in unshadowed air. Defined before this text: LEFT_BY_FOG(direction, distance_km), the
// transmittance of fog up to a distance.

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
// attenuated by fog. Steps contribute about equal light; SingleTo gives the light of a piece of
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
  float clear = LEFT_BY_FOG(direction, 1e-3 * stretch.x);
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
    float clear_there = LEFT_BY_FOG(direction, 1e-3 * end);
    shaded += 0.5 * (clear + clear_there) * dark / float(shade_steps) * (farther - single);
    single = farther;
    clear = clear_there;
  }
  return shaded;
}

//// shafts.fog_march.glsl
// Sunlight in fog that terrain shadows remove from a ray, by marching through a SunShadowMap as
// MarchedShade (shafts.march.glsl) does for air. For flat ground the steps' shares of the ray's
// light increase linearly, because a low sun shines on the top of the fog, where rays enter.
// FogSunTo (fog.light.glsl) gives the light of each step.

// Light in fog varies within a valley, light in air over kilometres.
const int kFogSteps = 4;

vec4 MarchedFogShade(vec3 direction, float distance_km) {
  ShadeRay ray = ShadeRayOf(direction);
  vec2 stretch = ShadeStretch(ray, 1e3 * distance_km);
  int steps = stretch.x < stretch.y ? kFogSteps * shade_pieces : 0;
  float from = FogTransmittance(direction, 1e-3 * stretch.x);
  float to = FogTransmittance(direction, 1e-3 * stretch.y);
  float whole = FogDepthTo(direction, distance_km);
  vec4 shaded = vec4(0.0);
  vec4 light = FogSunTo(direction, 1e-3 * stretch.x);
  vec2 over = OverShade(ray, stretch.x);
  for (int step = 1; step <= steps; ++step) {
    float even = float(step) / float(steps);
    float left = mix(from, to, even * even);
    float depth = -log(max(left, 1e-30));
    float end_km = step < steps ? FogDistanceOf(direction, depth, whole, distance_km)
                                : 1e-3 * stretch.y;
    end_km = clamp(end_km, 1e-3 * stretch.x, 1e-3 * stretch.y);
    vec2 next = OverShade(ray, 1e3 * end_km);
    vec4 farther = FogSunTo(direction, end_km);
    shaded += MeanDarkness(over, next) * (farther - light);
    over = next;
    light = farther;
  }
  return shaded;
}

//// shafts.texel.glsl
// Four fractions and a distance in one texel of four floats: the last four bits of each float, 2e-6
// of its value, hold a quarter of the logarithm of the distance in 65536 steps of 0.03 %.

const float kNearest_log2_km = -10.0, kFarthest_log2_km = 14.0;

uint DistanceCode(float distance_km) {
  float span = kFarthest_log2_km - kNearest_log2_km;
  float share = (log2(max(distance_km, 1e-6)) - kNearest_log2_km) / span;
  return uint(clamp(share, 0.0, 1.0) * 65535.0 + 0.5);
}

// Fractions are at least 1e-20, since the bits of a float near 0 would be lost.
vec4 ShaftTexel(vec4 share, float distance_km) {
  uvec4 code = (uvec4(DistanceCode(distance_km)) >> uvec4(0u, 4u, 8u, 12u)) & 15u;
  return uintBitsToFloat((floatBitsToUint(max(share, vec4(1e-20))) & ~15u) | code);
}

// Returns the binary logarithm of the distance [km].
float ShaftDistance(vec4 texel) {
  uvec4 part = (floatBitsToUint(texel) & 15u) << uvec4(0u, 4u, 8u, 12u);
  float share = float(part.x | part.y | part.z | part.w) / 65535.0;
  return mix(kNearest_log2_km, kFarthest_log2_km, share);
}

//// shafts.frag.glsl
// The fraction of single scattering that shadows remove, for the rays of every shaft_scale-th pixel
// in both directions. For rays that hit no terrain it is the fraction of all their light. Fractions
// vary less from ray to ray than light does, and in full shadow not at all. Defined before this
// text: HAS_FOG, 1 for a second output, the fraction of the sunlight in fog.

uniform sampler2D surface_map;  // distance [m] in the fourth component, 0: no terrain
uniform ivec2 picture_size;
uniform int shaft_scale;

layout(location = 0) out vec4 shaft;
#if HAS_FOG
layout(location = 1) out vec4 fog_shaft;
#endif

void main() {
  ivec2 pixel = min(ivec2(gl_FragCoord.xy) * shaft_scale + shaft_scale / 2, picture_size - 1);
  vec2 at = (2.0 * vec2(pixel) + 1.0) / vec2(picture_size) - 1.0;
  vec3 direction = ViewDirection(at);
  float distance_m = texelFetch(surface_map, pixel, 0).w;
  float distance_km = distance_m > 0.0 ? 1e-3 * distance_m : 1e9;
  vec4 light = distance_m > 0.0 ? SingleTo(direction, distance_km) : SkyRadiance(direction);
  shaft = ShaftTexel(MarchedShade(direction, distance_km) / max(light, vec4(1e-20)), distance_km);
#if HAS_FOG
  float in_fog_km = min(distance_km, kOutOfFog_km);
  vec4 unshaded = max(FogSunTo(direction, in_fog_km), vec4(1e-20));
  fog_shaft = ShaftTexel(MarchedFogShade(direction, in_fog_km) / unshaded, distance_km);
#endif
}

//// shafts.picture.glsl
// Light that shadows remove from the ray of a pixel, from the map of shafts.frag.glsl. Of the four
// nearest rays in the map, those with about the same length are averaged.

uniform sampler2D shaft_map, fog_shaft_map;
uniform vec2 shaft_place;  // from pixels to the map: factor, offset

// Returns the light that shadows remove up to a distance on this pixel's ray, from one of the maps.
vec4 TakenOf(vec4 light, sampler2D map, float distance_km) {
  const float kTolerance = 0.05;  // of distances, as binary logarithms
  vec2 at = gl_FragCoord.xy * shaft_place.x + shaft_place.y;
  ivec2 last = textureSize(map, 0) - 1;
  ivec2 low = clamp(ivec2(floor(at)), ivec2(0), last);
  ivec2 high = min(low + 1, last);
  vec2 share = clamp(at - vec2(low), 0.0, 1.0);
  vec4 texel[4] =
      vec4[4](texelFetch(map, low, 0), texelFetch(map, ivec2(high.x, low.y), 0),
              texelFetch(map, ivec2(low.x, high.y), 0), texelFetch(map, high, 0));
  vec4 away = vec4(ShaftDistance(texel[0]), ShaftDistance(texel[1]), ShaftDistance(texel[2]),
                   ShaftDistance(texel[3])) -
              clamp(log2(max(distance_km, 1e-6)), kNearest_log2_km, kFarthest_log2_km);
  vec4 weight = vec4((1.0 - share.x) * (1.0 - share.y), share.x * (1.0 - share.y),
                     (1.0 - share.x) * share.y, share.x * share.y);
  // A minimum weight of a millionth lets a ray count if all nearer ones are too long or too short.
  weight = (weight + 1e-6) / (away * away + kTolerance * kTolerance);
  vec4 sum = weight.x * texel[0] + weight.y * texel[1] + weight.z * texel[2] + weight.w * texel[3];
  return sum / (weight.x + weight.y + weight.z + weight.w) * light;
}

// Returns the light that terrain shadows remove from the single scattering of AirToPoint up to a
// distance, or from SkyRadiance if the ray hits no terrain.
vec4 TakenByShade(float distance_km, vec4 light) { return TakenOf(light, shaft_map, distance_km); }

// Returns the light that terrain shadows remove from FogSunTo.
vec4 FogTakenByShade(float distance_km, vec4 light) {
  return TakenOf(light, fog_shaft_map, distance_km);
}
