// SPDX-License-Identifier: MIT
// The tables, and what of the surroundings lies in one direction.
#define SKY_AZIMUTHS 16

layout(std140) uniform SkyByPixel {
  vec4 horizon_u;   // from (x, y, z, 1) in the eye's frame [m] to coordinates of horizons_around
  vec4 horizon_v;
  vec4 slope_u;     // likewise for light_of_slopes
  vec4 slope_v;
  vec4 sky_moment;  // current irradiance of the unoccluded sky relative to the tables, by band
  vec4 sky_place;   // altitude [km] to the tables' levels, zenith cosine of the sun to their suns:
                    // offset and factor of the altitude, offset and factor of the cosine
  vec4 slope_unit;  // unit of the stored light of slopes; 0: there are no tables
  // The last three of the second light.
  vec4 other_sky_moment;
  vec4 other_sky_place;
  vec4 other_slope_unit;
};

uniform sampler2DArray horizons_around;  // four azimuths per layer; SKY_LOWEST .. 1 stored as 0 .. 1
uniform sampler2DArray sky_integrals;    // node; A and B of an azimuth; level
uniform sampler2D level_irradiance;      // sun; level
uniform sampler2DArray light_of_slopes;  // one azimuth per layer; then their weights, four per layer
#ifdef TWO_LIGHTS
uniform sampler2DArray other_sky_integrals;
uniform sampler2D other_level_irradiance;
uniform sampler2DArray other_light_of_slopes;
#endif

// Returns the texture coordinate among n nodes: 0 is the centre of the first texel, 1 of the last.
float AmongNodes(float share, float n) {
  return (0.5 + clamp(share, 0.0, 1.0) * (n - 1.0)) / n;
}

// Land around a place in one direction.
struct Surroundings {
  float horizon;        // sine of the elevation of the horizon; SKY_LOWEST: there is none
  vec4 slopes;          // radiance of the slopes below it, times `weight`
  float weight;         // TerrainInterreflection::Radiance explains the weights
  float missing_weight; // of radiance that replaces slopes which the tables do not resolve
};

const Surroundings kNoSurroundings = Surroundings(SKY_LOWEST, vec4(0.0), 0.0, 1.0);

// Returns the sine of the horizon in one of the azimuths, as it is stored.
float HorizonIn(int azimuth, vec2 place) {
  return textureLod(horizons_around, vec3(place, float(azimuth / 4)), 0.0)[azimuth % 4];
}

float SlopeWeightIn(int azimuth, vec2 place) {
  return TEXEL_OF_LIGHT(light_of_slopes, other_light_of_slopes,
                        vec3(place, float(SKY_AZIMUTHS + azimuth / 4)))[azimuth % 4];
}

vec4 SlopesIn(int azimuth, vec2 place) {
  return TEXEL_OF_LIGHT(light_of_slopes, other_light_of_slopes, vec3(place, float(azimuth)));
}

// Returns what a place sees of land: BetweenAzimuths and TerrainInterreflection::Radiance.
// @param point  from the eye [m]; direction: not vertical.
Surroundings SurroundingsTowards(vec3 point, vec3 direction) {
  vec4 place = vec4(point, 1.0);
  vec2 on_horizons = vec2(dot(horizon_u, place), dot(horizon_v, place));
  vec2 on_slopes = vec2(dot(slope_u, place), dot(slope_v, place));
  float turn = fract(atan(direction.y, direction.x) / 6.28318530718) * float(SKY_AZIMUTHS);
  int before = min(int(turn), SKY_AZIMUTHS - 1), after = (before + 1) % SKY_AZIMUTHS;
  float along = turn - float(before);
  float horizon = mix(HorizonIn(before, on_horizons), HorizonIn(after, on_horizons), along);
  float weight = mix(SlopeWeightIn(before, on_slopes), SlopeWeightIn(after, on_slopes), along);
  vec4 slopes = OF_LIGHT(sky_moment, other_sky_moment) * OF_LIGHT(slope_unit, other_slope_unit) *
                mix(SlopesIn(before, on_slopes), SlopesIn(after, on_slopes), along);
  float sine = SKY_LOWEST + (1.0 - SKY_LOWEST) * horizon;
  float known = max(sine, 0.0) + 0.005;
  return Surroundings(sine, slopes, weight, max(0.05 * known * known - weight, 0.0));
}
