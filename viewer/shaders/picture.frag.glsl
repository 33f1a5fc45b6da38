// SPDX-License-Identifier: MIT
// The linear picture [cd/m^2, linear sRGB]: sky, land, the planet beyond it, and the air before
// them, less what shade takes.
in vec2 screen;
out vec4 picture;

uniform sampler2D surface_map;     // of land.frag.glsl
uniform sampler2D sky_on_surface;  // of the same
uniform float pixel_angle;         // between rays [rad]
uniform bool has_shade;

// Whether the planet stands before a piece of land: the ray dips deeper than land ever lies below
// the sphere, half a kilometre, before it gets there.
bool BehindPlanet(vec3 direction, float d) {
  const float deepest = -0.5;
  if (direction.z >= 0.0 || PerigeeAltitude(EYE_ALTITUDE, direction.z, RADIUS) > deepest)
    return false;
  return d > DistanceDownTo(EYE_ALTITUDE, direction.z, deepest, RADIUS);
}

vec4 LandThroughAir(vec3 direction, vec4 surface, ivec2 pixel) {
  float distance_km = 1e-3 * surface.w;
  AirTo air = AirToPoint(direction, distance_km);
  vec4 ground = GroundRadiance(surface.w * direction, UnitFromOctahedral(surface.xy), surface.z,
                               texelFetch(sky_on_surface, pixel, 0), -direction);
  vec4 light = air.single;
  if (has_shade) light = max(light - ShadedSingle(distance_km), vec4(0.0));
  return light + air.diffuse + air.transmittance * ground;
}

// Whether the table of the sky has the ground that the planet is made of.
#define PLANET_IS_PLAIN (GROUND_COVER == MOUNTAIN_COVER && !PLANET_IS_WATER)

vec4 WholeRay(vec3 direction, bool planet) {
#if !PLANET_IS_PLAIN
  if (planet) {
    float distance_km = DistanceDownTo(EYE_ALTITUDE, direction.z, 0.0, RADIUS);
    AirTo air = AirToPoint(direction, distance_km);
    return air.single + air.diffuse +
           air.transmittance * PlanetRadiance(1e3 * distance_km * direction, -direction);
  }
#endif
  return SkyRadiance(direction);
}

vec4 SkyOrPlanet(vec3 direction) {
  bool planet = GroundClearance(EYE_ALTITUDE, direction.z, RADIUS) > 0.0;
  vec4 light = WholeRay(direction, planet);
  if (has_shade) light = max(light - ShadedSingle(1e9), vec4(0.0));
  if (planet) return light;
  vec4 disks = vec4(SunDiskRadiance(direction, pixel_angle)) + MoonRadiance(direction, pixel_angle);
  if (disks.x > 0.0) light += disks * TransmittanceToSpace(direction);
  return light;
}

void main() {
  vec2 at = screen + PICTURE_SHIFT;
  vec3 direction = normalize(view_forward.xyz + at.x * view_right.xyz + at.y * view_up.xyz);
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 surface = texelFetch(surface_map, pixel, 0);
  bool land = surface.w > 0.0 && !BehindPlanet(direction, 1e-3 * surface.w);
  vec4 radiance =
      land ? LandThroughAir(direction, surface, pixel) : SkyOrPlanet(direction);
  picture = vec4(LinearSrgb(sun_irradiance * radiance), 1.0);
}
