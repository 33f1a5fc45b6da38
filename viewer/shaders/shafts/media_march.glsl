// SPDX-License-Identifier: MIT
// Sunlight in media that terrain shadows remove from a ray, by marching through a SunShadowMap as
// MarchedShade (shafts/march.glsl) does for air. For flat ground the steps' shares of the ray's
// light increase linearly, because a low sun shines on the top of a layer, where rays enter.
// MediaSunTo gives the light of each step.

// Light in layers varies within a valley, light in air over kilometres.
const int kMediaSteps = 4;

vec4 MarchedMediaShade(vec3 direction, float distance_km) {
  ShadeRay ray = ShadeRayOf(direction);
  vec2 stretch = ShadeStretch(ray, 1e3 * distance_km);
  int steps = stretch.x < stretch.y ? kMediaSteps * shade_pieces : 0;
  float from = MediaSunLeft(MediaDepthTo(direction, 1e-3 * stretch.x));
  float to = MediaSunLeft(MediaDepthTo(direction, 1e-3 * stretch.y));
  float whole = MediaDepthTo(direction, distance_km);
  vec4 shaded = vec4(0.0);
  vec4 light = MediaSunTo(direction, 1e-3 * stretch.x);
  vec2 over = OverShade(ray, stretch.x);
  for (int step = 1; step <= steps; ++step) {
    float even = float(step) / float(steps);
    float left = mix(from, to, even * even);
    float end_km = step < steps
                       ? MediaDistanceOf(direction, MediaSunDepth(left), whole, distance_km)
                       : 1e-3 * stretch.y;
    end_km = clamp(end_km, 1e-3 * stretch.x, 1e-3 * stretch.y);
    vec2 next = OverShade(ray, 1e3 * end_km);
    vec4 farther = MediaSunTo(direction, end_km);
    shaded += MeanDarkness(over, next) * (farther - light);
    over = next;
    light = farther;
  }
  return shaded;
}
