// SPDX-License-Identifier: MIT
// The view: its block, its rays, disks seen in it, and the vertices of a pass over the whole picture.

//// view.block.glsl
// Position and view of the eye, and the lights of the sky: ViewBlock of pass_setup.h. Frame:
// east, north, up at the eye.
layout(std140) uniform View {
  vec4 view_right;      // times the tangent of half the horizontal field of view
  vec4 view_up;         // times the tangent of half the vertical field of view
  vec4 view_forward;    // unit vector; angle between rays, counting all of a pixel [rad]
  vec4 sun;             // unit vector to the apparent sun; angular radius [rad]
  vec4 sun_for_air;     // unit vector to the sun whose straight rays light the air (SunForAir)
  vec4 sun_irradiance;  // above the air, one value per band [W m^-2 nm^-1]
  vec4 bend;         // refraction (view.refracted_rays.glsl): apparent radius of the planet; altitude
                     // above which rays are straight [km]; usual curvature [1/km], 0: none
  vec4 bend_slopes;  // curvature of level rays at altitude 0, by layer [1/km]
  vec4 bend_falls;   // decrease of the curvature with altitude [1/km]
  vec4 eye;  // altitude of the eye [km]; offset of the ray from the pixel, in half widths
             // and heights of the picture; radius of the planet [km], 0: not in sight
  vec4 other_sun;             // the second light of the sky, in programs with TWO_LIGHTS
  vec4 other_sun_for_air;
  vec4 other_sun_irradiance;
  vec4 night_scattered;  // the night sky: radiance of an infinite path of air [W m^-2 sr^-1 nm^-1],
  vec4 night_level;      // and irradiance of level ground [W m^-2 nm^-1]; in programs with HAS_NIGHT
};

#ifdef TWO_LIGHTS
#define sun (of_other ? other_sun : sun)
#define sun_for_air (of_other ? other_sun_for_air : sun_for_air)
#define sun_irradiance (of_other ? other_sun_irradiance : sun_irradiance)
#endif

#define EYE_ALTITUDE eye.x
#define PICTURE_SHIFT eye.yz
#define PLANET_RADIUS eye.w
#define LOOK_RADIUS bend.x
#define BEND_TOP bend.y
#define BEND_USUAL bend.z
#define RAY_ANGLE view_forward.w

// Returns the direction of a point in the picture, from (-1, -1) to (1, 1).
vec3 ViewDirection(vec2 screen) {
  vec2 at = screen + PICTURE_SHIFT;
  return normalize(view_forward.xyz + at.x * view_right.xyz + at.y * view_up.xyz);
}

//// view.lights.glsl
// "The sun" of all texts is a light of the sky, sun or moon. Programs with TWO_LIGHTS evaluate
// their functions for the first light, and then for the second one, with of_other set. It is set
// to constants only, so that compilers remove the branches. Every text that uses these macros is
// preceded by this one, which may therefore come several times.
#ifndef OF_LIGHT
#ifdef TWO_LIGHTS
bool of_other = false;
#define OF_LIGHT(first, second) (of_other ? second : first)
#define TEXEL_OF_LIGHT(first, second, at) (of_other ? textureLod(second, at, 0.0) : textureLod(first, at, 0.0))
#else
#define OF_LIGHT(first, second) first
#define TEXEL_OF_LIGHT(first, second, at) textureLod(first, at, 0.0)
#endif
#endif

//// view.refracted_rays.glsl
// Apparent positions of land and of the bare planet under refraction
// (atmosphere/refraction/refracted_view.h), with the parameters of the block View. Without
// refraction, apparent and true positions are equal.
//
// Pixels, the air in front of them, fog and shafts use apparent directions and true distances, as
// in the renderer. Ground is lit and coloured at its true position.

float LiftAt(float altitude_km, float distance_km) {
  return LandLift(EYE_ALTITUDE, altitude_km, distance_km, PLANET_RADIUS, BEND_TOP, BEND_USUAL,
                  bend_slopes.x, bend_slopes.y, bend_slopes.z, bend_falls.x, bend_falls.y,
                  bend_falls.z);
}

float RoughLiftAt(float altitude_km, float distance_km) {
  return RoughLandLift(EYE_ALTITUDE, altitude_km, distance_km, PLANET_RADIUS, BEND_TOP, BEND_USUAL,
                       bend_slopes.x, bend_slopes.y, bend_slopes.z, bend_falls.x, bend_falls.y,
                       bend_falls.z);
}

// Returns v rotated upwards by a small angle [rad] in its vertical plane; `level` is length(v.xy).
vec3 TurnedUp(vec3 v, float level, float angle) {
  float shrink = 0.5 * angle * angle;
  float nearer = level > 0.0 ? 1.0 - shrink - angle * v.z / level : 1.0;
  return vec3(nearer * v.xy, (1.0 - shrink) * v.z + angle * level);
}

// Returns the apparent position of land, at the same distance. Metres from the eye.
vec3 SeenAt(vec3 place) {
  if (BEND_USUAL == 0.0) return place;
  float distance_km = 1e-3 * length(place);
  float altitude =
      AltitudeAlongRay(EYE_ALTITUDE, 1e-3 * place.z / max(distance_km, 1e-6), distance_km, PLANET_RADIUS);
  return TurnedUp(place, length(place.xy), LiftAt(altitude, distance_km));
}

// Returns the true position of land that appears in a direction at a distance. Metres from the eye.
vec3 PlaceSeen(vec3 direction, float distance_m) {
  vec3 seen = distance_m * direction;
  if (BEND_USUAL == 0.0) return seen;
  float distance_km = 1e-3 * distance_m, level = length(direction.xy);
  float altitude = AltitudeAlongRay(EYE_ALTITUDE, direction.z, distance_km, PLANET_RADIUS);
  float rise = level * level * distance_km;
  // The true altitude is lower than the apparent one, which changes the lift slightly.
  float lower = altitude - rise * RoughLiftAt(altitude, distance_km);
  return TurnedUp(seen, distance_m * level, -LiftAt(lower, distance_km));
}

// Returns whether the bare planet is seen in a direction.
bool SeesPlanet(vec3 direction) {
  return GroundClearance(EYE_ALTITUDE, direction.z, LOOK_RADIUS) > 0.0;
}

// Returns the distance at which it is seen.
float PlanetDistance(vec3 direction) {
  return DistanceDownTo(EYE_ALTITUDE, min(direction.z, -1e-9), 0.0, LOOK_RADIUS);
}

// Returns the direction of the straight line to the planet's ground at a distance, in the vertical
// plane of `direction`. For ground behind the horizon it is the direction of the horizon.
vec3 DirectionToGround(vec3 direction, float distance_km) {
  if (LOOK_RADIUS == PLANET_RADIUS) return direction;
  float h = EYE_ALTITUDE, d = max(distance_km, 1e-6);
  float mu = -(h * (2.0 * PLANET_RADIUS + h) + d * d) / (2.0 * d * (PLANET_RADIUS + h));
  float level = sqrt(max((1.0 - mu) * (1.0 + mu), 0.0));
  return vec3(level / max(length(direction.xy), 1e-9) * direction.xy, mu);
}

// Returns the position of the planet's ground that is seen in a direction. Metres from the eye.
vec3 PlanetPlace(vec3 direction, float distance_km) {
  return 1e3 * distance_km * DirectionToGround(direction, distance_km);
}

// Returns the straight line under which the sky table holds the visible ground and the air before
// it.
vec3 StraightToPlanet(vec3 direction) {
  // Stay slightly in front of the horizon, so that rounding never yields a ray of the sky.
  float reach = 0.99 * HorizonDistance(EYE_ALTITUDE, PLANET_RADIUS);
  return DirectionToGround(direction, min(PlanetDistance(direction), reach));
}

//// view.refracted_disks.glsl
// Refracted disks of sun and moon near the horizon, with dispersion and extinction per band:
// RefractedDisk of painted_view.h. The block View must hold the true sun, and `moon`
// (air.sun_light.glsl) the true moon.
#define DISK_NODES 13

// Nodes by elevation, first of the sun, then of the moon; one component per band.
uniform vec4 disk_lift[2 * DISK_NODES];   // apparent minus true elevation [rad]
uniform vec4 disk_depth[2 * DISK_NODES];  // optical depth minus that of a straight ray
uniform vec4 disk_nodes;  // of sun and moon: elevation of the first node [rad], nodes per radian
uniform vec2 disk_shares;  // factors of the light of sun and moon; 0: the disk is not drawn

struct DiskAir {
  vec4 lift, depth;
};

// Returns the refraction and extinction at an elevation.
// @param of  0: the sun; 1: the moon.
DiskAir DiskAirAt(int of, float elevation) {
  vec2 nodes = of == 0 ? disk_nodes.xy : disk_nodes.zw;
  float at = clamp((elevation - nodes.x) * nodes.y, 0.0, float(DISK_NODES - 1));
  int below = min(int(at), DISK_NODES - 2);
  int node = of * DISK_NODES + below;
  float share = at - float(below);
  return DiskAir(mix(disk_lift[node], disk_lift[node + 1], share),
                 mix(disk_depth[node], disk_depth[node + 1], share));
}

// Returns the radiance of both disks per unit of the sun's irradiance [1/sr]: for each band,
// SunDiskRadiance and MoonRadiance in the true direction.
// @param width  angle between rays in this direction [rad].
vec4 RefractedDisks(vec3 direction, float width) {
  float level = length(direction.xy);
  float elevation = AngleOfSine(clamp(direction.z, -1.0, 1.0));
  DiskAir of_sun = DiskAirAt(0, elevation), of_moon = DiskAirAt(1, elevation);
  vec4 disks;
  for (int band = 0; band < 4; ++band) {
    vec3 to_sun = TurnedUp(direction, level, -of_sun.lift[band]);
    vec3 to_moon = TurnedUp(direction, level, -of_moon.lift[band]);
    float beside_moon = 1.0 - CoveredByMoon(to_moon, width);
    float by_sun = exp(-of_sun.depth[band]) * SunDiskRadiance(to_sun, width)[band];
    float by_moon = exp(-of_moon.depth[band]) * MoonRadiance(to_moon, width)[band];
    disks[band] = disk_shares.x * beside_moon * by_sun + disk_shares.y * by_moon;
  }
  return disks;
}

//// view.full_screen.vert.glsl
// One triangle over the whole picture, or squares in it. `screen` runs from (-1, -1) to (1, 1) over
// the picture.
in vec4 square;  // lower left and upper right corner; all 0: the triangle
out vec2 screen;

void main() {
  vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  bool right = gl_VertexID % 2 == 1, above = gl_VertexID / 2 == 1;
  vec2 of_square = vec2(right ? square.z : square.x, above ? square.w : square.y);
  screen = square.xy == square.zw ? corner : of_square;
  gl_Position = vec4(screen, -1.0, 1.0);  // depth 0
}
