// SPDX-License-Identifier: MIT
// The air: its block, its tables for the eye, and the sunlight that reaches a place in it.

//// air.block.glsl
// Optical properties of the medium: AirBlock of pass_setup.h. Vectors of four hold one value
// per band. Lengths are in kilometres.
layout(std140) uniform Air {
  vec4 rayleigh_scattering;  // per km at altitude 0
  vec4 mie_scattering;
  vec4 mie_extinction;
  vec4 ozone_absorption;  // per km at the peak of the layer
  vec4 ground_albedo;
  vec4 red_from_bands;  // rows of the matrix to linear sRGB [cd m^-2 per W m^-2 sr^-1 nm^-1]
  vec4 green_from_bands;
  vec4 blue_from_bands;
  vec4 shell;        // radius of the planet, top of the air, scale heights of molecules and aerosol
  vec4 ozone_layer;  // bottom, peak, top; fourth: 1 for the smooth shape, 0 for the tent
  vec4 deficit;      // deficit of molecules near the ground: fraction, scale height
  vec4 wavelengths;  // [um]
};

#define RADIUS shell.x
#define TOP shell.y
#define RAYLEIGH_HEIGHT shell.z
#define MIE_HEIGHT shell.w

float OzoneColumnUp(float h, float mu) {
  if (ozone_layer.w > 0.5) return SmoothOzoneColumnUp(h, mu, ozone_layer.z, RADIUS);
  return TentColumnUp(h, mu, ozone_layer.x, ozone_layer.y, ozone_layer.z, RADIUS);
}

// Returns the columns of molecules, aerosol and ozone [km] from altitude h along mu >= 0 to space.
vec3 ColumnsUp(float h, float mu) {
  float molecules = (1.0 + deficit.x) * ExponentialColumnUp(h, mu, RAYLEIGH_HEIGHT, TOP, RADIUS);
  if (deficit.x > 0.0) molecules -= DeficitColumnUp(h, mu, deficit.x, deficit.y, RADIUS);
  return vec3(molecules, ExponentialColumnUp(h, mu, MIE_HEIGHT, TOP, RADIUS), OzoneColumnUp(h, mu));
}

// Returns the columns from the lowest point of the line to space. Below the ground they are not
// used and only have to be finite.
vec3 ColumnsFromPerigee(float h, float mu) {
  return ColumnsUp(max(PerigeeAltitude(h, mu, RADIUS), -1.0), 0.0);
}

// Returns the columns towards a sun that the ground does not hide.
vec3 ColumnsToSun(float h, float mu_s) {
  vec3 up = ColumnsUp(h, abs(mu_s));
  if (mu_s >= 0.0) return up;
  return max(2.0 * ColumnsFromPerigee(h, mu_s) - up, vec3(0.0));
}

vec4 OpticalDepth(vec3 columns) {
  return rayleigh_scattering * columns.x + mie_extinction * columns.y +
         ozone_absorption * columns.z;
}

vec3 LinearSrgb(vec4 radiance) {
  return vec3(dot(red_from_bands, radiance), dot(green_from_bands, radiance),
              dot(blue_from_bands, radiance));
}

//// air.tables.glsl
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
uniform sampler2D air_to_sun;  // row 0: straight rays; row 1: refracted beam for ground and fog

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

//// air.sun_light.glsl
// Sun and moon as disks: the part of the sun above the horizon, and the radiance of both (sun.h,
// moon.h).

uniform vec4 moon;      // unit vector to the apparent moon, in the eye's frame; angular radius
uniform vec4 moon_colour;      // spectral reflectance relative to 550 nm
uniform float moon_earthshine;  // radiance per irradiance, uniform over the disk
uniform vec4 moon_lit;  // unit vector from the moon to the sun; radiance per irradiance, 0: no moon

// Returns the angle of a sine in [-1, 1]. The asin() and acos() of some drivers are accurate only
// to 1e-4, a fiftieth of the disk.
float AngleOfSine(float sine) { return atan(sine, sqrt(max((1.0 - sine) * (1.0 + sine), 0.0))); }

// Returns the fraction of the disk above the horizon, and the zenith cosine of the visible part's
// centre.
vec2 DiskOverHorizon(float mu_s, float horizon_mu, float radius) {
  float elevation = AngleOfSine(clamp(mu_s, -1.0, 1.0));
  float x = (elevation - AngleOfSine(clamp(horizon_mu, -1.0, 1.0))) / radius;
  if (x >= 1.0) return vec2(1.0, mu_s);
  if (x <= -1.0) return vec2(0.0, mu_s);
  float chord = sqrt((1.0 - x) * (1.0 + x));
  float area = atan(chord, -x) + x * chord;
  // The centre of the last sliver must lie within it, in spite of rounding of the area.
  float rise = clamp(2.0 / 3.0 * chord * chord * chord / max(area, 1e-10), max(-x, 0.0), 1.0);
  return vec2(area / 3.14159265359, sin(elevation + rise * radius));
}

// Returns the fraction of a pixel that the moon's disk covers.
float CoveredByMoon(vec3 direction, float width) {
  vec3 beside = direction - moon.xyz;
  float rho = length(beside - dot(beside, moon.xyz) * moon.xyz) / max(sin(moon.w), 1e-6);
  return dot(direction, moon.xyz) <= 0.0 ? 0.0 : clamp((1.0 - rho) * moon.w / width + 0.5, 0.0, 1.0);
}

// Returns the radiance of the sun's disk outside the air, per unit of its irradiance [1/sr], times
// the fraction of a pixel that the disk covers; one value per band.
vec4 SunDiskRadiance(vec3 direction, float width) {
  float radius = sun.w;
  float rho = 2.0 * asin(min(0.5 * length(direction - sun.xyz), 1.0)) / radius;
  float covered = clamp((1.0 - rho) * radius / width + 0.5, 0.0, 1.0);
  if (covered <= 0.0) return vec4(0.0);
  float half_sine = sin(0.5 * radius);
  vec4 darkening =
      vec4(SunLimbDarkeningAt(rho, wavelengths.x), SunLimbDarkeningAt(rho, wavelengths.y),
           SunLimbDarkeningAt(rho, wavelengths.z), SunLimbDarkeningAt(rho, wavelengths.w));
  return covered / (4.0 * 3.14159265359 * half_sine * half_sine) * darkening;
}

// Returns the radiance of the moon's disk outside the air, per unit of solar irradiance [1/sr],
// times the fraction of a pixel that the disk covers; one value per band.
vec4 MoonRadiance(vec3 direction, float width) {
  vec3 beside = direction - moon.xyz;
  vec3 at = (beside - dot(beside, moon.xyz) * moon.xyz) / max(sin(moon.w), 1e-6);
  float rho = length(at);
  float covered = CoveredByMoon(direction, width);
  if (covered <= 0.0) return vec4(0.0);
  // A pixel whose centre is beyond the limb has the radiance of the limb.
  const float kLimb = 0.999;
  at *= min(kLimb / max(rho, 1e-6), 1.0);
  float mu_seen = sqrt(1.0 - dot(at, at));
  float mu_lit = dot(at - mu_seen * moon.xyz, moon_lit.xyz);
  return covered * (moon_lit.w * LommelSeeliger(mu_lit, mu_seen) + moon_earthshine) * moon_colour;
}
