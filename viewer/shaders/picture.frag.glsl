// SPDX-License-Identifier: MIT
// The linear picture [cd/m^2, linear sRGB]: sky, land, the planet beyond it, and the air before
// them, less what shade takes.
in vec2 screen;
out vec4 picture;

uniform sampler2D surface_map;     // of land.frag.glsl
uniform sampler2D sky_on_surface;  // of the same
uniform float pixel_angle;         // between rays [rad]
uniform bool has_shade;
uniform bool has_lamps;

// Whether the planet stands before a piece of land: the ray dips deeper than land ever lies below
// the sphere, half a kilometre, before it gets there.
bool BehindPlanet(vec3 direction, float d) {
  const float deepest = -0.5;
  if (direction.z >= 0.0 || PerigeeAltitude(EYE_ALTITUDE, direction.z, RADIUS) > deepest)
    return false;
  return d > DistanceDownTo(EYE_ALTITUDE, direction.z, deepest, RADIUS);
}

#ifdef HAS_FOG
// Light of the air before a distance, with fog among it; `all` without fog, of the whole way.
vec4 AirInFog(vec3 direction, float distance_km, vec4 all) {
  FogStretches stretches = FogStretchesTo(direction, distance_km);
  vec4 light = stretches.weight.w * all;
  for (int i = 0; i < 3; ++i) {
    AirTo air = AirToPoint(direction, stretches.distance_km[i]);
    light += stretches.weight[i] * (air.single + air.diffuse);
  }
  return light;
}
#endif

vec4 GroundSeen(vec3 direction, vec4 surface, ivec2 pixel) {
  vec3 point = surface.w * direction;
  vec3 normal = UnitFromOctahedral(surface.xy);
  vec4 sky = texelFetch(sky_on_surface, pixel, 0);
#ifdef HAS_FOG
  GroundPlace at = GroundPlaceAt(point);
  sky = FogSkyLeft(at.altitude) * sky + FogOnSurface(at.altitude, dot(normal, at.up));
#endif
  return GroundRadiance(point, normal, surface.z, sky, -direction);
}

vec4 LandThroughAir(vec3 direction, vec4 surface, ivec2 pixel) {
  float distance_km = 1e-3 * surface.w;
  AirTo air = AirToPoint(direction, distance_km);
  vec4 single = air.single;
  if (has_shade) single -= ShadedSingle(distance_km, single);
  vec4 light = single + air.diffuse;
  vec4 ground = air.transmittance * GroundSeen(direction, surface, pixel);
#ifdef HAS_FOG
  FogAlong fog = FogTo(direction, distance_km);
  return AirInFog(direction, distance_km, light) + fog.radiance + fog.transmittance * ground;
#else
  return light + ground;
#endif
}

// Whether the table of the sky has the ground that the planet is made of, as bright.
#ifdef HAS_FOG
#define PLANET_IS_PLAIN 0
#else
#define PLANET_IS_PLAIN (GROUND_COVER == MOUNTAIN_COVER && !PLANET_IS_WATER)
#endif

vec4 PlanetThroughAir(vec3 direction) {
#if PLANET_IS_PLAIN
  return SkyRadiance(direction);
#else
  float distance_km = DistanceDownTo(EYE_ALTITUDE, direction.z, 0.0, RADIUS);
  AirTo air = AirToPoint(direction, distance_km);
  vec4 light = air.single + air.diffuse;
  vec4 ground = air.transmittance * PlanetRadiance(1e3 * distance_km * direction, -direction);
#ifdef HAS_FOG
  FogAlong fog = FogTo(direction, distance_km);
  return AirInFog(direction, distance_km, light) + fog.radiance + fog.transmittance * ground;
#else
  return light + ground;
#endif
#endif
}

vec4 SkyAndDisks(vec3 direction) {
  vec4 light = SkyRadiance(direction);
  if (has_shade) light = max(light - ShadedSingle(1e9, SingleTo(direction, 1e9)), vec4(0.0));
  vec4 disks = vec4(SunDiskRadiance(direction, pixel_angle)) + MoonRadiance(direction, pixel_angle);
  vec4 from_space = vec4(0.0);
  if (disks.x > 0.0) from_space = disks * TransmittanceToSpace(direction);
#ifdef HAS_FOG
  const float kOutOfFog_km = 1e3;
  FogAlong fog = FogTo(direction, kOutOfFog_km);
  return AirInFog(direction, kOutOfFog_km, light) + fog.radiance + fog.transmittance * from_space;
#else
  return light + from_space;
#endif
}

vec3 LampsSeen(vec3 direction, vec4 surface, bool land) {
  vec3 glow = LampGlowRgb(direction, LampRayEnd(direction, land ? surface.w : 0.0));
  if (!land) return glow;
  vec3 point = surface.w * direction;
  vec3 normal = UnitFromOctahedral(surface.xy);
  GroundPlace at = GroundPlaceAt(point);
  vec3 tilted = DetailedNormal(at.offset, normal, at.footprint);
  vec4 albedo = LandAlbedo(at.offset, 1e3 * at.altitude, dot(normal, at.up), at.footprint);
  vec4 left = AirToPoint(direction, 1e-3 * surface.w).transmittance;
#ifdef HAS_FOG
  left *= FogTransmittance(direction, 1e-3 * surface.w);
#endif
  return glow + LampRgb(left * albedo / 3.14159265359 * LampsOnGround(point, tilted));
}

void main() {
  vec2 at = screen + PICTURE_SHIFT;
  vec3 direction = normalize(view_forward.xyz + at.x * view_right.xyz + at.y * view_up.xyz);
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 surface = texelFetch(surface_map, pixel, 0);
  bool land = surface.w > 0.0 && !BehindPlanet(direction, 1e-3 * surface.w);
  vec4 radiance;
  if (land) {
    radiance = LandThroughAir(direction, surface, pixel);
  } else if (GroundClearance(EYE_ALTITUDE, direction.z, RADIUS) > 0.0) {
    radiance = PlanetThroughAir(direction);
  } else {
    radiance = SkyAndDisks(direction);
  }
  vec3 rgb = LinearSrgb(sun_irradiance * radiance);
  if (has_lamps) rgb += LampsSeen(direction, surface, land);
  picture = vec4(rgb, 1.0);
}
