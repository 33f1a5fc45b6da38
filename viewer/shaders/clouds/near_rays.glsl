// SPDX-License-Identifier: MIT
// Interpolates a map of rays through clouds. Rays that meet land or the planet at about the same distance
// as the ray at the place, or likewise nothing, have nearly all of the weight.

// @param lengths  binary logarithms of the lengths of the rays [km] in the second component.
// @param at  place in the map [texels]. @param own_length  that of the ray there.
vec4 NearRays(sampler2D map, sampler2D lengths, vec2 at, float own_length) {
  const float kTolerance = 0.1;
  ivec2 low = ivec2(floor(at)), last = textureSize(map, 0) - 1;
  vec2 share = at - vec2(low);
  vec4 sum = vec4(0.0);
  float weights = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 side = ivec2(i % 2, i / 2);
    ivec2 texel = clamp(low + side, ivec2(0), last);
    float away = texelFetch(lengths, texel, 0).g - own_length;
    vec2 near = mix(1.0 - share, share, vec2(side));
    float weight = (near.x * near.y + 1e-4) / (away * away + kTolerance * kTolerance);
    sum += weight * texelFetch(map, texel, 0);
    weights += weight;
  }
  return sum / weights;
}
