// SPDX-License-Identifier: MIT
// Light that shadows remove from the ray of a pixel, from the map of shafts/shafts.frag.glsl. Of
// the four nearest rays in the map, those with about the same length are averaged.

uniform sampler2D shaft_map, media_shaft_map;
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

// Returns the light that terrain shadows remove from MediaSunTo.
vec4 MediaTakenByShade(float distance_km, vec4 light) {
  return TakenOf(light, media_shaft_map, distance_km);
}
