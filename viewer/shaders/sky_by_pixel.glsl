// SPDX-License-Identifier: MIT
// The surroundings of a place between mountains, and the light that it receives from them, computed
// per pixel as in the renderer from the tables of ground_block.h.

//// sky_by_pixel.tables.glsl
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

//// sky_by_pixel.irradiance.glsl
// Irradiance of a surface by the sky and by other slopes: OccludedSkyIrradiance::Irradiance and
// TerrainInterreflection::Irradiance of the renderer.

// Returns the integral of sqrt(1 - s^2), with two Gauss nodes.
float DiskAreaBetween(float low, float high) {
  float middle = 0.5 * (low + high), aside = 0.28867513 * (high - low);
  float a = middle - aside, b = middle + aside;
  return 0.5 * (high - low) * (sqrt(max(1.0 - a * a, 0.0)) + sqrt(max(1.0 - b * b, 0.0)));
}

// Accumulated irradiance of a surface.
struct SkySum {
  vec4 sky, slopes;
};

// Adds the contribution of one azimuth.
// @param along  component of the normal along the azimuth.
// @param horizon  sine of the horizon's elevation.
void AddAzimuth(inout SkySum sum, int azimuth, float up, float along, float horizon, float level,
                vec2 slope_place, float slope_weight) {
  float plane = -along * inversesqrt(up * up + 1e-12 + along * along);
  float from = max(horizon, plane);
  float node = AmongNodes((from - SKY_LOWEST) / (1.0 - SKY_LOWEST), SKY_NODES);
  float row = 2.0 * float(azimuth) + 0.5;
  const float rows = 2.0 * float(SKY_AZIMUTHS);
  sum.sky += up * TEXEL_OF_LIGHT(sky_integrals, other_sky_integrals, vec3(node, row / rows, level)) +
             along * TEXEL_OF_LIGHT(sky_integrals, other_sky_integrals,
                                    vec3(node, (row + 1.0) / rows, level));
  float area = DiskAreaBetween(plane, from);
  float ground = max(0.5 * up * (from * from - plane * plane) + along * area, 0.0);
  sum.slopes += ground / (slope_weight + 1e-9) *
                SlopesIn(azimuth, slope_place);
}

// Returns the irradiance by the current sky, per unit solar irradiance.
// @param point  from the eye [m].
vec4 SkyAtPixel(GroundPlace at, vec3 point, vec3 normal) {
  vec4 place = vec4(point, 1.0);
  vec2 horizon_place = vec2(dot(horizon_u, place), dot(horizon_v, place));
  vec2 slope_place = vec2(dot(slope_u, place), dot(slope_v, place));
  vec4 levels = OF_LIGHT(sky_place, other_sky_place);
  float altitude = clamp((at.altitude + levels.x) * levels.y, 0.0, 1.0);
  float nearest_level = floor(altitude * (SKY_LEVELS - 1.0) + 0.5);
  float sun_node = AmongNodes((dot(at.up, sun_for_air.xyz) + levels.z) * levels.w, SKY_SUNS);
  float up = dot(normal, at.up);
  vec2 aside = normal.xy - up * at.up.xy;
  const float sector = 2.0 * 3.14159265359 / float(SKY_AZIMUTHS);
  mat2 turn = mat2(cos(sector), sin(sector), -sin(sector), cos(sector));
  vec2 towards = vec2(1.0, 0.0);
  SkySum sum = SkySum(vec4(0.0), vec4(0.0));
  for (int layer = 0; layer < SKY_AZIMUTHS / 4; ++layer) {
    vec4 sines = SKY_LOWEST + (1.0 - SKY_LOWEST) *
                                  textureLod(horizons_around, vec3(horizon_place, float(layer)), 0.0);
    vec4 weights =
        textureLod(light_of_slopes, vec3(slope_place, float(SKY_AZIMUTHS + layer)), 0.0);
    for (int i = 0; i < 4; ++i) {
      AddAzimuth(sum, 4 * layer + i, up, dot(towards, aside), sines[i], nearest_level, slope_place,
                 weights[i]);
      towards = turn * towards;
    }
  }
  vec4 open = TEXEL_OF_LIGHT(level_irradiance, other_level_irradiance,
                             vec2(sun_node, AmongNodes(altitude, SKY_LEVELS)));
  return sector * OF_LIGHT(sky_moment, other_sky_moment) *
         (open * max(sum.sky, vec4(0.0)) + OF_LIGHT(slope_unit, other_slope_unit) * sum.slopes);
}
