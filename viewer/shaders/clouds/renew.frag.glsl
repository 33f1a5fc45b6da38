// SPDX-License-Identifier: MIT
// Renews the map of one layer of clouds in a moving picture. One of four texels has a ray of this frame.
// The others have the light that the map of the frame before had in the direction of their clouds, at the
// mean distance that the four nearest rays of this frame give. What was outside that map has the light of
// these rays.
layout(location = 0) out vec4 gathered;
layout(location = 1) out vec4 reach;

uniform sampler2D new_light;                     // rays of this frame, two texels of the map apart
uniform sampler2D earlier_light, earlier_reach;  // of the frame before
uniform ivec2 first_ray;                         // texel of the map with the first ray of this frame
uniform mat3 earlier_screen;  // of the frame before, from directions in the frame of the clouds
uniform vec3 moved;           // by the eye since then, relative to the clouds [m]

// Light of the four rays of this frame around a texel.
struct NewRays {
  vec4 mean, sum;  // weighted by nearness; not weighted
};

// @param from  texels from the first ray.
NewRays NewRaysAt(ivec2 from) {
  ivec2 low = from >> 1, last = textureSize(new_light, 0) - 1;
  vec2 share = 0.5 * vec2(from & 1);
  NewRays rays = NewRays(vec4(0.0), vec4(0.0));
  for (int i = 0; i < 4; ++i) {
    ivec2 side = ivec2(i % 2, i / 2);
    vec2 near = mix(1.0 - share, share, vec2(side));
    vec4 light = texelFetch(new_light, clamp(low + side, ivec2(0), last), 0);
    rays.mean += near.x * near.y * light;
    rays.sum += light;
  }
  return rays;
}

void main() {
  const float kFar_m = 1e6;
  ivec2 texel = ivec2(gl_FragCoord.xy), from = texel - first_ray;
  NewRays rays = NewRaysAt(from);
  CloudMapRay ray = RayOfTexel(texel);
  reach = vec4(log2(ray.length_km));
  float taken = 4.0 - rays.sum.z;
  float distance_m = taken > 1e-3 ? 1e3 * rays.sum.w / taken : kFar_m;
  vec3 towards = vec3(cloud_turn.x * ray.direction.x - cloud_turn.y * ray.direction.y,
                      cloud_turn.y * ray.direction.x + cloud_turn.x * ray.direction.y, ray.direction.z);
  vec3 seen = earlier_screen * (distance_m * towards + moved);
  vec2 screen = seen.xy / max(seen.z, 1e-3);
  vec2 way = (0.5 + 0.5 * screen) * vec2(picture_size) - vec2(PixelOfTexel(texel)) - 0.5;
  vec4 before = NearRays(earlier_light, earlier_reach, vec2(texel) + way / float(cloud_scale), reach.g);
  bool is_new = ((from.x | from.y) & 1) == 0;
  bool was_outside = seen.z <= 0.0 || any(greaterThan(abs(screen), vec2(1.0)));
  gathered = is_new || was_outside ? rays.mean : before;
}
