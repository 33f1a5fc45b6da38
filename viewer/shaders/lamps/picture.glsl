// SPDX-License-Identifier: MIT
// Light of lamps scattered by the air in a picture [cd/m^2, linear sRGB], from the lattice of
// lamps/airlight.frag.glsl and the cores of lamps/core.frag.glsl, or summed here.

// Returns the distance at which the ray of a pixel ends [m]: at terrain (surface_m, 0: none), at
// the bare planet, or nowhere.
float LampRayEnd(vec3 direction, float surface_m) {
  float h = lamp_planet.y;
  bool planet = GroundClearance(h, direction.z, lamp_planet.x) > 0.0;
  float to_planet = 1e3 * DistanceDownTo(h, min(direction.z, -1e-9), 0.0, lamp_planet.x);
  return surface_m > 0.0 ? surface_m : planet ? to_planet : 1e12;
}

int LampStep() { return int(lamp_planet.z); }

#if LAMP_LATTICE
uniform sampler2D lamp_lattice;  // light; inverse of the distance at which the ray ends [1/m]

// Rays that end on one plane, or in the sky, have inverse distances that are linear over the
// picture. If that of the pixel does not fit, the neighbours whose rays end nearest to it are used.
vec3 LampAirlightRgb(vec3 direction, float end_m) {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  ivec2 corner = pixel / LampStep();
  vec2 share = vec2(pixel - corner * LampStep()) / float(LampStep());
  vec4 a = texelFetch(lamp_lattice, corner, 0);
  vec4 b = texelFetch(lamp_lattice, corner + ivec2(1, 0), 0);
  vec4 c = texelFetch(lamp_lattice, corner + ivec2(0, 1), 0);
  vec4 d = texelFetch(lamp_lattice, corner + ivec2(1, 1), 0);
  vec4 weight = vec4((1.0 - share.x) * (1.0 - share.y), share.x * (1.0 - share.y),
                     (1.0 - share.x) * share.y, share.x * share.y);
  vec4 ends = vec4(a.w, b.w, c.w, d.w);
  float here = 1.0 / end_m;
  bool plane = abs(dot(weight, ends) - here) <= 0.03 * here + 1e-9;
  vec4 alike = 1.0 / (0.01 + abs(ends - here) / (ends + here + 1e-9));
  vec4 chosen = weight * alike * alike;
  weight = plane ? weight : chosen / dot(chosen, vec4(1.0));
  return weight.x * a.rgb + weight.y * b.rgb + weight.z * c.rgb + weight.w * d.rgb;
}
#else
vec3 LampAirlightRgb(vec3 direction, float end_m) { return LampRgb(LampAirlightIn(direction, end_m, 1.0)); }
#endif
