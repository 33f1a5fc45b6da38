// SPDX-License-Identifier: MIT
// The light that the sky and other slopes send to a surface between mountains, worked out for every pixel
// as the renderer does it: OpenSky::Irradiance and SlopeLight::Irradiance, from the tables of sky_by_pixel.h.
#define SKY_AZIMUTHS 16

layout(std140) uniform SkyByPixel {
  vec4 horizon_u;   // from (x, y, z, 1) in the eye's frame [m] to a place of horizons_around
  vec4 horizon_v;
  vec4 slope_u;     // the same for light_of_slopes
  vec4 slope_v;
  vec4 sky_moment;  // the open sky's light of this moment over that of the tables, by band
  vec4 sky_place;   // altitude [km] to the tables' levels and zenith cosine of the sun to their suns: what is
                    // added before the one and the other are multiplied, in turn
  vec4 slope_unit;  // what the light of slopes is stored in
};

uniform sampler2DArray horizons_around;  // four azimuths a layer: SKY_LOWEST, 0, to 1, 1
uniform sampler2DArray sky_integrals;    // node; A and B of an azimuth; level
uniform sampler2D level_irradiance;      // sun; level
uniform sampler2DArray light_of_slopes;  // an azimuth each; then what it is weighed with, four a layer

// Integral of sqrt(1 - s^2) by two Gauss nodes.
float DiskAreaBetween(float low, float high) {
  float middle = 0.5 * (low + high), aside = 0.28867513 * (high - low);
  float a = middle - aside, b = middle + aside;
  return 0.5 * (high - low) * (sqrt(max(1.0 - a * a, 0.0)) + sqrt(max(1.0 - b * b, 0.0)));
}

// The texture coordinate of a place among n nodes: 0 is the middle of the first texel, 1 of the last.
float AmongNodes(float share, float n) {
  return (0.5 + clamp(share, 0.0, 1.0) * (n - 1.0)) / n;
}

// The light that has been summed up for a surface.
struct SkySum {
  vec4 sky, slopes;
};

// Adds what one azimuth brings. @param along  component of the normal along it; horizon: sine of the elevation.
void AddAzimuth(inout SkySum sum, int azimuth, float up, float along, float horizon, float level,
                vec2 slope_place, float slope_weight) {
  float plane = -along * inversesqrt(up * up + 1e-12 + along * along);
  float from = max(horizon, plane);
  float node = AmongNodes((from - SKY_LOWEST) / (1.0 - SKY_LOWEST), SKY_NODES);
  float row = 2.0 * float(azimuth) + 0.5;
  const float rows = 2.0 * float(SKY_AZIMUTHS);
  sum.sky += up * textureLod(sky_integrals, vec3(node, row / rows, level), 0.0) +
             along * textureLod(sky_integrals, vec3(node, (row + 1.0) / rows, level), 0.0);
  float area = DiskAreaBetween(plane, from);
  float ground = max(0.5 * up * (from * from - plane * plane) + along * area, 0.0);
  sum.slopes += ground / (slope_weight + 1e-9) *
                textureLod(light_of_slopes, vec3(slope_place, float(azimuth)), 0.0);
}

// Irradiance per unit solar irradiance, of this moment's sky.
// @param point  from the eye [m].
vec4 SkyAtPixel(GroundPlace at, vec3 point, vec3 normal) {
  vec4 place = vec4(point, 1.0);
  vec2 horizon_place = vec2(dot(horizon_u, place), dot(horizon_v, place));
  vec2 slope_place = vec2(dot(slope_u, place), dot(slope_v, place));
  float altitude = clamp((at.altitude + sky_place.x) * sky_place.y, 0.0, 1.0);
  float nearest_level = floor(altitude * (SKY_LEVELS - 1.0) + 0.5);
  float sun_node = AmongNodes((dot(at.up, sun_for_air.xyz) + sky_place.z) * sky_place.w, SKY_SUNS);
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
  vec4 open = textureLod(level_irradiance, vec2(sun_node, AmongNodes(altitude, SKY_LEVELS)), 0.0);
  return sector * sky_moment * (open * max(sum.sky, vec4(0.0)) + slope_unit * sum.slopes);
}
