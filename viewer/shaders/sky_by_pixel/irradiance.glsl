// SPDX-License-Identifier: MIT
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
