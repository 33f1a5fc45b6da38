// SPDX-License-Identifier: MIT
// The fraction of single scattering that shadows remove, for the rays of every shaft_scale-th pixel
// in both directions. For rays that hit no terrain it is the fraction of all their light. Fractions
// vary less from ray to ray than light does, and in full shadow not at all. Defined before this
// text: HAS_MEDIA, 1 for a second output, the fraction of the sunlight in media.

uniform sampler2D surface_map;  // distance [m] in the fourth component, 0: no terrain
uniform ivec2 picture_size;
uniform int shaft_scale;

layout(location = 0) out vec4 shaft;
#if HAS_MEDIA
layout(location = 1) out vec4 media_shaft;
#endif

void main() {
  ivec2 pixel = min(ivec2(gl_FragCoord.xy) * shaft_scale + shaft_scale / 2, picture_size - 1);
  vec2 at = (2.0 * vec2(pixel) + 1.0) / vec2(picture_size) - 1.0;
  vec3 direction = ViewDirection(at);
  float distance_m = texelFetch(surface_map, pixel, 0).w;
  float distance_km = distance_m > 0.0 ? 1e-3 * distance_m : 1e9;
  vec4 light = distance_m > 0.0 ? SingleTo(direction, distance_km) : SkyRadiance(direction);
  shaft = ShaftTexel(MarchedShade(direction, distance_km) / max(light, vec4(1e-20)), distance_km);
#if HAS_MEDIA
  float in_media_km = min(distance_km, kOutOfMedia_km);
  vec4 unshaded = max(MediaSunTo(direction, in_media_km), vec4(1e-20));
  media_shaft = ShaftTexel(MarchedMediaShade(direction, in_media_km) / unshaded, distance_km);
#endif
}
