// SPDX-License-Identifier: MIT
// Replaces media/layer.glsl in scenes without a layer.
#define MEDIA_STRETCHES 1

const float kOutOfMedia_km = 1e3;

struct MediaAlong {
  vec4 transmittance;
  vec4 radiance;
};

MediaAlong MediaTo(vec3 direction, float distance_km) { return MediaAlong(vec4(1.0), vec4(0.0)); }

vec4 MediaSunTo(vec3 direction, float distance_km) { return vec4(0.0); }

float MediaTransmittance(vec3 direction, float distance_km) { return 1.0; }

struct MediaStretches {
  vec4 distance_km;
  vec4 weight;
};

MediaStretches MediaStretchesTo(vec3 direction, float distance_km) {
  return MediaStretches(vec4(distance_km), vec4(1.0, 0.0, 0.0, 0.0));
}

float SunLeftByMedia(float h, float mu_s) { return 1.0; }

float SkyLeftByMedia(float h) { return 1.0; }

vec4 MediaOnSurface(float h, float cos_up) { return vec4(0.0); }
