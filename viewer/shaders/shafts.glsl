// SPDX-License-Identifier: MIT
// What shade takes from the ray of a pixel, from the map that shafts.frag.glsl paints: between the
// four nearest of its rays those count that have come about as far.

uniform sampler2D shaft_map, fog_shaft_map;
uniform vec2 shaft_place;  // of a pixel on it: times x, plus y

// What a map says that shade takes of light on the ray of this pixel up to a distance.
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
  // A millionth each: one of them counts where all that lie nearer have come too far or not enough.
  weight = (weight + 1e-6) / (away * away + kTolerance * kTolerance);
  vec4 sum = weight.x * texel[0] + weight.y * texel[1] + weight.z * texel[2] + weight.w * texel[3];
  return sum / (weight.x + weight.y + weight.z + weight.w) * light;
}

// Light that terrain's shade takes from what AirToPoint says of single scattering up to a distance; where
// the ray meets no terrain, from SkyRadiance.
vec4 TakenByShade(float distance_km, vec4 light) { return TakenOf(light, shaft_map, distance_km); }

// What it takes from FogSunTo.
vec4 FogTakenByShade(float distance_km, vec4 light) {
  return TakenOf(light, fog_shaft_map, distance_km);
}
