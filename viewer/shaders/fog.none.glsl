// SPDX-License-Identifier: MIT
// Replaces fog.light.glsl in scenes without fog.
#define FOG_STRETCHES 1

const float kOutOfFog_km = 1e3;

struct FogAlong {
  vec4 transmittance;
  vec4 radiance;
};

FogAlong FogTo(vec3 direction, float distance_km) { return FogAlong(vec4(1.0), vec4(0.0)); }

vec4 FogSunTo(vec3 direction, float distance_km) { return vec4(0.0); }

float FogTransmittance(vec3 direction, float distance_km) { return 1.0; }

struct FogStretches {
  vec4 distance_km;
  vec4 weight;
};

FogStretches FogStretchesTo(vec3 direction, float distance_km) {
  return FogStretches(vec4(distance_km), vec4(1.0, 0.0, 0.0, 0.0));
}

float FogSunLeft(float h, float mu_s) { return 1.0; }

float FogSkyLeft(float h) { return 1.0; }

vec4 FogOnSurface(float h, float cos_up) { return vec4(0.0); }
