// SPDX-License-Identifier: MIT
// Replaces lamps/light.glsl and lamps/picture.glsl in scenes without lamps.
vec4 LampsOnGround(vec3 point_m, vec3 normal, float ray_width_m) { return vec4(0.0); }

vec3 LampAirlightRgb(vec3 direction, float end_m) { return vec3(0.0); }

vec3 LampRgb(vec4 radiance) { return vec3(0.0); }
