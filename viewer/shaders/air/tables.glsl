// SPDX-License-Identifier: MIT
// Radiance and transmittance of the air for one eye and one sun, from the tables of air_tables.h.
// Radiance is per unit solar irradiance [1/sr], one band per component. Directions are unit vectors
// in the eye's frame (east, north, up); distances are in kilometres from the eye.

// AirTablesBlock of air_follower.h.
struct AirTablesOf {
  vec4 towards;   // unit vector to the sun that lights the air
  vec4 sun_seen;  // unit vector to the apparent sun, the centre of aureoles
  vec4 frame;     // horizontal unit vector to its azimuth; sine and cosine of the dip
  vec4 shell;     // altitude of the tables, ceiling of land, top of the air, radius [km]
  vec4 ranges;    // tangents of half the ranges of rows: sky, aerial perspective above the
                  // horizon, below it; fourth: 1 if the eye is above the air
  vec4 crowding;  // of distances, above and below the horizon; twilight fall and reference
  vec4 columns;   // first texel and number of columns: sky; aerial perspective
  vec4 sky_rows;  // first texel and number of rows: above the horizon; below it
  vec4 through_rows;
  vec4 way_rows;
  vec4 extinction_rows;
  vec4 distances;    // nodes of distance: scattering; extinction
  vec4 phase_nodes;  // nodes of the aerosol's phase function
  vec4 sky_of_molecules;  // factors of PhaseRayleigh, of the aerosol's phase and of 1
  vec4 sky_of_aerosol;
  vec4 sky_of_all;
  vec4 single_of_molecules;
  vec4 single_of_aerosol;
  vec4 extinction_below;  // per km at altitude 0 and below
};
layout(std140) uniform AirTables { AirTablesOf air_tables; };

uniform sampler2D air_sky;
uniform sampler1D air_through;
uniform sampler2D air_extinction;
uniform sampler3D air_single;
uniform sampler3D air_diffuse;
uniform sampler2D air_phase;  // phase function of the aerosol with its light of all orders
uniform sampler2D air_to_sun;  // row 0: straight rays; row 1: refracted beam for ground and media

// The tables of the second light. Transmittance is taken from those of the first, and so is the
// geometry of rays (AirStretch): both tables are of one eye, and the places for which they were made
// are so close that the error of the tables is small (AirFollower).
#ifdef TWO_LIGHTS
layout(std140) uniform OtherAirTables { AirTablesOf other_air_tables; };
uniform sampler2D other_air_sky;
uniform sampler3D other_air_single;
uniform sampler3D other_air_diffuse;
uniform sampler2D other_air_phase;
#endif
#define AIR OF_LIGHT(air_tables, other_air_tables)

struct AirTo {
  vec4 single;   // sunlight scattered once or, by aerosol, forward, without terrain shadows
  vec4 diffuse;  // other multiple scattering
  vec4 transmittance;
};

// Returns sin^2 of half the angle to the apparent sun.
float HalfSineSquared(vec3 direction) {
  vec3 between = direction - AIR.sun_seen.xyz;
  return min(0.25 * dot(between, between), 1.0);
}

// Returns the phase function of the aerosol including the light that aerosol scatters more than
// once around the sun.
vec4 AerosolPhase(float half_sine_squared) {
  float node = AIR.phase_nodes.x + AIR.phase_nodes.y * PhaseNode(half_sine_squared);
  return TEXEL_OF_LIGHT(air_phase, other_air_phase, vec2(node, 0.5));
}

// Returns the tangent of half the elevation above the horizon.
float HalfTangent(vec3 direction) {
  float flat_length = length(direction.xy);
  float up = direction.z * air_tables.frame.w + flat_length * air_tables.frame.z;
  return up / (1.0 + flat_length * air_tables.frame.w - direction.z * air_tables.frame.z);
}

float ColumnOf(vec3 direction) {
  float along = dot(direction.xy, AIR.frame.xy);
  return AirColumn(0.5 - 0.5 * along / max(length(direction.xy), 1e-12));
}

// Returns the texture coordinate of a row.
// @param sky_range, ground_range  ranges of the table above and below the horizon.
// @param rows  first texel and number of rows above and below the horizon, as in the block.
float RowOf(float half_tangent, float sky_range, float ground_range, vec4 rows) {
  bool ground = half_tangent < 0.0;
  float v = AirRow(abs(half_tangent), ground ? ground_range : sky_range);
  return ground ? rows.z + rows.w * v : rows.x + rows.y * v;
}

// Returns the factor by which texels were divided, at distance d along a ray.
float TwilightAt(vec3 direction, float d) {
  return AirTwilight(air_tables.shell.x, AIR.towards.z, dot(direction, AIR.towards.xyz), d,
                     AIR.crowding.z, AIR.crowding.w, air_tables.shell.w);
}

// Returns whether a direction passes above all air.
bool AboveAir(float half_tangent) {
  return air_tables.ranges.w > 0.5 && half_tangent > air_tables.ranges.x;
}

// Returns the radiance of the whole ray: to space, or to the bare planet with its lit ground.
vec4 SkyRadiance(vec3 direction) {
  float rise = HalfTangent(direction);
  vec2 at = vec2(AIR.columns.x + AIR.columns.y * ColumnOf(direction),
                 RowOf(rise, air_tables.ranges.x, air_tables.ranges.z, AIR.sky_rows));
  float h2 = HalfSineSquared(direction);
  vec4 phases = PhaseRayleigh(1.0 - 2.0 * h2) * AIR.sky_of_molecules +
                AerosolPhase(h2) * AIR.sky_of_aerosol + AIR.sky_of_all;
  float foot =
      AirFoot(air_tables.shell.x, direction.z, rise < 0.0 ? 1.0 : 0.0, air_tables.shell.w);
  phases *= TwilightAt(direction, foot);
  return AboveAir(rise) ? vec4(0.0) : phases * TEXEL_OF_LIGHT(air_sky, other_air_sky, at);
}

// Returns the transmittance of the whole view ray, to space or to the bare ground.
vec4 TransmittanceToSpace(vec3 direction) {
  float rise = HalfTangent(direction);
  float at = RowOf(rise, air_tables.ranges.x, air_tables.ranges.z, air_tables.through_rows);
  return AboveAir(rise) ? vec4(1.0) : textureLod(air_through, at, 0.0);
}

// Returns the transmittance to the sun.
// @param beam  0: straight rays; 1: refracted beam.
vec4 ToSun(float altitude_km, float mu_s, float beam) {
  float h = clamp(altitude_km, 0.0, air_tables.shell.z);
  float x =
      UnitFromSkyCosine(h, max(mu_s, HorizonCosine(h, air_tables.shell.w)), air_tables.shell.z, air_tables.shell.w);
  float y = UnitFromAltitude(h, air_tables.shell.z, air_tables.shell.w);
  vec2 size = vec2(textureSize(air_to_sun, 0)) * vec2(1.0, 0.5);
  vec2 at = vec2(TexelFromUnit(x, size.x), 0.5 * (TexelFromUnit(y, size.y) + beam));
  return textureLod(air_to_sun, at, 0.0);
}

// Returns the transmittance of straight rays from a point at or above the ground [km] to a sun that
// the planet does not hide. It is used to light the air and the bare ground of the sky table.
vec4 TransmittanceToSun(float altitude_km, float mu_s) { return ToSun(altitude_km, mu_s, 0.0); }

// Returns the transmittance there for the refracted beam of the visible disk: RefractedBeam of
// atmosphere/refraction/refracted_view.h.
vec4 BeamOfSun(float altitude_km, float mu_s) { return ToSun(altitude_km, mu_s, 1.0); }

// Distances along a ray in tables of aerial perspective, and a point on it.
struct AirStretch {
  float entry, near, reach;  // of the air, of the first node, and from it to the last [km]
  float beyond;              // of the point, from the first node [km]
  float below;               // of the point, from the last [km], in air below altitude 0
  float rise;                // HalfTangent of the ray that the tables have
  float node;                // of the point's distance among the nodes, in [0, 1]
};

// Below altitude 0 air has the density of altitude 0. A ray that goes on below it is lit as at its
// crossing; one from an eye at or below altitude 0 as the horizontal ray, which the tables have.
AirStretch StretchTo(vec3 direction, float distance_km) {
  float h = air_tables.shell.x, radius = air_tables.shell.w;
  float mu = h > 0.0 ? direction.z : max(direction.z, 0.0);
  AirStretch stretch;
  stretch.rise = h > 0.0 ? HalfTangent(direction) : max(HalfTangent(direction), 0.0);
  bool ground = stretch.rise < 0.0;
  stretch.entry = AirEntry(h, mu, air_tables.shell.z, radius);
  stretch.near = AirEntry(h, mu, air_tables.shell.y, radius);
  float end = ground ? AirEndDown(h, mu, radius) : AirEndUp(h, mu, air_tables.shell.y, radius);
  stretch.reach = max(end - stretch.near, 1e-3);
  stretch.beyond = clamp(distance_km - stretch.near, 0.0, stretch.reach);
  stretch.below = ground ? max(distance_km - stretch.near - stretch.reach, 0.0) : 0.0;
  stretch.node = AirNodeFromShare(stretch.beyond / stretch.reach,
                                  ground ? air_tables.crowding.y : air_tables.crowding.x);
  return stretch;
}

// Returns the transmittance of the air from the eye to a point.
vec4 TransmittanceTo(vec3 direction, float distance_km) {
  AirStretch stretch = StretchTo(direction, distance_km);
  vec2 at = vec2(
      air_tables.distances.z + air_tables.distances.w * stretch.node,
      RowOf(stretch.rise, air_tables.ranges.y, air_tables.ranges.z, air_tables.extinction_rows));
  float length_km =
      clamp(distance_km, stretch.entry, stretch.near + stretch.reach) - stretch.entry;
  return exp(-length_km * textureLod(air_extinction, at, 0.0) -
             stretch.below * air_tables.extinction_below);
}

// Position of a point in the aerial-perspective tables, and factors of the table values.
struct AirWay {
  vec3 at;  // in the 3D tables
  vec4 transmittance;
  vec4 scattered;           // factor of the texels
  float half_sine_squared;  // of the angle to the apparent sun
};

AirWay WayTo(vec3 direction, float distance_km) {
  AirStretch stretch = StretchTo(direction, distance_km);
  AirWay way;
  way.at = vec3(AIR.columns.z + AIR.columns.w * ColumnOf(direction),
                RowOf(stretch.rise, air_tables.ranges.y, air_tables.ranges.z, AIR.way_rows),
                AIR.distances.x + AIR.distances.y * stretch.node);
  way.half_sine_squared = HalfSineSquared(direction);
  way.transmittance = TransmittanceTo(direction, distance_km);
  way.scattered = (1.0 - way.transmittance) *
                  TwilightAt(direction, stretch.near + 0.5 * stretch.beyond);
  return way;
}

vec4 SingleOf(AirWay way) {
  if (HasSet()) return vec4(0.0);
  float h2 = way.half_sine_squared;
  vec4 phases = PhaseRayleigh(1.0 - 2.0 * h2) * AIR.single_of_molecules +
                AerosolPhase(h2) * AIR.single_of_aerosol;
  return phases * way.scattered * TEXEL_OF_LIGHT(air_single, other_air_single, way.at);
}

// Returns the light and transmittance of the air from the eye to a point.
AirTo AirToPoint(vec3 direction, float distance_km) {
  AirWay way = WayTo(direction, distance_km);
  return AirTo(SingleOf(way),
               way.scattered * TEXEL_OF_LIGHT(air_diffuse, other_air_diffuse, way.at),
               way.transmittance);
}

// Returns AirToPoint(direction, distance_km).single.
vec4 SingleTo(vec3 direction, float distance_km) { return SingleOf(WayTo(direction, distance_km)); }
