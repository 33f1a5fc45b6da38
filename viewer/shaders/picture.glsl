// SPDX-License-Identifier: MIT
// The linear picture of land, sky and disks.

//// picture.frag.glsl
// The linear picture [cd/m^2, linear sRGB] lit by the sun or the moon, whichever the block View
// holds as its sun, and the inverse depth of land (gbuffer.inverse_depth.glsl). The passes are separated by
// the depth test against land, because software drivers evaluate both sides of a branch. Defined
// before this text:
//   PASS          LAND_PASS: land and the air in front of it; SKY_PASS: sky and bare planet;
//                 OPEN_SKY_PASS: sky above the planet; DISK_PASS: disks of sun and moon;
//                 NIGHT_PASS: light of the night sky on land, air and sky
//   HAS_SHADE, HAS_LAMPS, HAS_FOG
//   SKY_BY_PIXEL  irradiance by the sky on land is computed here (sky_by_pixel.glsl), not by vertex
in vec2 screen;
out vec4 picture;

uniform sampler2D surface_map;     // output of land.frag.glsl
uniform sampler2D sky_on_surface;  // output of land.frag.glsl for the current light

// Returns the light of the air before a distance, attenuated by fog. `all` is that of the whole
// path without fog.
vec4 AirInFog(vec3 direction, float distance_km, vec4 all) {
#if HAS_FOG
  FogStretches stretches = FogStretchesTo(direction, distance_km);
  vec4 sum = stretches.weight[FOG_STRETCHES - 1] * all;
  vec4 light = vec4(0.0), before = vec4(0.0);
  for (int i = 0; i < FOG_STRETCHES - 1; ++i) {
    AirTo air = AirToPoint(direction, stretches.distance_km[i]);
    before = light;
    light = air.single + air.diffuse;
    sum += stretches.weight[i] * light;
  }
  return sum + FogRest(stretches, all, light, before);
#else
  return all;
#endif
}

// Returns the light from a distance plus that of the air and fog on the path, without terrain
// shadows.
vec4 ThroughFog(vec3 direction, float distance_km, vec4 air, vec4 behind) {
#if HAS_FOG
  FogAlong fog = FogTo(direction, distance_km);
  return AirInFog(direction, distance_km, air) + fog.radiance + fog.transmittance * behind;
#else
  return air + behind;
#endif
}

// Returns the light that shadows remove on the path.
// @param shaded_km  the distance stored in the map of shafts.
// @param single  the light to which the fractions of TakenByShade refer.
vec4 ShadeOnTheWay(vec3 direction, float distance_km, float shaded_km, vec4 single) {
  vec4 taken = vec4(0.0);
#if HAS_SHADE
  taken = TakenByShade(shaded_km, single);
#if HAS_FOG
  taken += FogTakenByShade(shaded_km, FogSunTo(direction, distance_km));
#endif
#endif
  return taken;
}

// Returns the land in a texel of the surface map.
// @param place  its true position, from the eye [m].
SeenGround LandOf(vec4 surface, vec3 place, vec3 direction) {
  return LandSeen(place, UnitFromOctahedral(surface.xy), -direction);
}

// Returns the radiance of ground lit by sun and sky through the fog above it.
// @param sky  irradiance on seen.normal.
vec4 SunlitGround(SeenGround seen, float sun_x, vec4 sky, vec3 to_eye) {
#if HAS_FOG
  float altitude = seen.at.altitude;
  sky = FogSkyLeft(altitude) * sky + FogOnSurface(altitude, dot(seen.normal, seen.at.up));
#endif
  return SentOn(seen, sun_x, sky, to_eye);
}

#if HAS_LAMPS
// Returns the light of lamps that the ground reflects.
// @param place  of the ground, from the eye [m].
vec4 LampsReflected(SeenGround seen, vec3 place, vec3 direction) {
  vec4 irradiance = LampsOnGround(place, seen.normal, RAY_ANGLE * length(place));
  return SentOfIrradiance(seen, irradiance, -direction);
}
#endif

#if PASS == LAND_PASS
// Returns the elevation of the disk above the shadow edge, scaled so that an edge is at least as
// wide as the pixels that it crosses. Across crests, where distances are discontinuous, it is not
// scaled.
float OverSmoothEdge(vec4 surface) {
  float half_step = 0.5 * fwidth(surface.z);
  bool is_crest = fwidth(surface.w) > 0.3 * surface.w;
  return surface.z / (is_crest ? 1.0 : max(half_step * RAY_ANGLE / ground_view.x, 1.0));
}

void main() {
  vec3 direction = ViewDirection(screen);
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 surface = texelFetch(surface_map, pixel, 0);
  float distance_km = 1e-3 * surface.w;
  AirTo air = AirToPoint(direction, distance_km);
  vec3 place = PlaceSeen(direction, surface.w);
  SeenGround seen = LandOf(surface, place, direction);
#if SKY_BY_PIXEL
  vec4 sky = SkyAtPixel(seen.at, place, seen.normal);
#else
  vec4 sky = SkyByShare(seen, texelFetch(sky_on_surface, pixel, 0));
#endif
  float over_edge = ground_view.y > 0.0 ? OverSmoothEdge(surface) : kNoEdge;
  vec4 ground = air.transmittance * SunlitGround(seen, over_edge, sky, -direction);
  vec4 radiance = ThroughFog(direction, distance_km, air.single + air.diffuse, ground) -
                  ShadeOnTheWay(direction, distance_km, distance_km, air.single);
  float along_m = surface.w * dot(direction, view_forward.xyz);
  picture = vec4(LinearSrgb(sun_irradiance * radiance), InverseDepth(along_m));
#if HAS_LAMPS
  vec4 left = air.transmittance * FogTransmittance(direction, distance_km);
  picture.rgb += LampRgb(left * LampsReflected(seen, place, direction)) +
                 LampAirlightRgb(direction, LampRayEnd(direction, surface.w));
#endif
}
#endif

#if PASS == SKY_PASS || PASS == OPEN_SKY_PASS
// True if the sky table holds the planet's ground without changes.
#define PLANET_IS_PLAIN (!HAS_FOG && GROUND_COVER == MOUNTAIN_COVER && !PLANET_IS_WATER)

vec4 PlanetThroughAir(vec3 direction) {
  float distance_km = PlanetDistance(direction);
  AirTo air = AirToPoint(direction, distance_km);
  SeenGround seen = PlanetSeen(PlanetPlace(direction, distance_km), -direction);
  vec4 ground = air.transmittance * SunlitGround(seen, kNoEdge, SkyOnPlanet(seen), -direction);
  return ThroughFog(direction, distance_km, air.single + air.diffuse, ground);
}

#if HAS_LAMPS
vec4 PlanetUnderLamps(vec3 direction) {
  float distance_km = PlanetDistance(direction);
  vec4 left = AirToPoint(direction, distance_km).transmittance *
              FogTransmittance(direction, distance_km);
  vec3 place = PlanetPlace(direction, distance_km);
  return left * LampsReflected(PlanetSeen(place, -direction), place, direction);
}
#endif

#if PASS == OPEN_SKY_PASS
// Returns the direction, raised to the horizon if it is below. This is drawn before land is loaded.
vec3 NotUnderHorizon(vec3 direction) {
  float horizon = HorizonCosine(EYE_ALTITUDE, RADIUS);
  float level = length(direction.xy);
  vec3 raised = vec3(direction.xy * (sqrt(1.0 - horizon * horizon) / max(level, 1e-6)), horizon);
  return direction.z < horizon ? raised : direction;
}
#endif

void main() {
  vec3 direction = ViewDirection(screen);
#if PASS == OPEN_SKY_PASS
  direction = NotUnderHorizon(direction);
  vec4 clear = SkyRadiance(direction);
#else
  bool planet = SeesPlanet(direction);
  vec3 straight = planet ? StraightToPlanet(direction) : direction;
  vec4 clear = SkyRadiance(straight);
#endif
  vec4 radiance = clear;
#if HAS_FOG
  radiance = ThroughFog(direction, kOutOfFog_km, clear, vec4(0.0));
  radiance -= min(ShadeOnTheWay(direction, kOutOfFog_km, 1e9, clear), radiance);
#elif HAS_SHADE
  radiance -= min(TakenByShade(1e9, clear), clear);
#endif
#if PASS == SKY_PASS && !PLANET_IS_PLAIN
  if (planet) radiance = PlanetThroughAir(direction);
#elif PASS == SKY_PASS
  if (planet) {
    vec4 beyond = PlanetBeyondEven(PlanetPlace(direction, PlanetDistance(direction)), -direction);
    radiance = max(radiance + TransmittanceToSpace(straight) * beyond, vec4(0.0));
  }
#endif
  picture = vec4(LinearSrgb(sun_irradiance * radiance), 0.0);
#if HAS_LAMPS
  picture.rgb += LampAirlightRgb(direction, LampRayEnd(direction, 0.0));
#if PASS == SKY_PASS
  if (planet) picture.rgb += LampRgb(PlanetUnderLamps(direction));
#endif
#endif
}
#endif

#if PASS == DISK_PASS
void main() {
  vec3 direction = ViewDirection(screen);
  vec4 disks = RefractedDisks(direction, RAY_ANGLE) * TransmittanceToSpace(direction);
  vec4 radiance = SeesPlanet(direction) ? vec4(0.0) : disks;
#if HAS_FOG
  radiance *= FogTransmittance(direction, 1e3);
#endif
  picture = vec4(LinearSrgb(sun_irradiance * radiance), 0.0);
}
#endif

#if PASS == NIGHT_PASS
uniform sampler2D night_sky;   // NightSkyMap of night_sky_map.h
uniform vec4 night_scattered;  // radiance of an infinite path of air [W m^-2 sr^-1 nm^-1]
uniform vec4 night_level;      // irradiance of level ground [W m^-2 nm^-1]

vec4 NightAbove(vec3 direction) {
  float elevation = AngleOfSine(clamp(direction.z, -1.0, 1.0));
  vec2 place = vec2(0.5 * atan(direction.x, direction.y), elevation) / 3.14159265359;
  return textureLod(night_sky, place + vec2(0.0, 0.5), 0.0);
}

// Returns the light reflected by ground that sees the part of a uniform sky left by its tilt.
vec4 NightReflected(SeenGround seen, vec3 to_eye) {
  vec4 level = 0.5 * (1.0 + dot(seen.normal, seen.at.up)) * night_level;
  return SentOfIrradiance(seen, level, to_eye);
}

void main() {
  vec3 direction = ViewDirection(screen);
  vec4 surface = texelFetch(surface_map, ivec2(gl_FragCoord.xy), 0);
  bool land = surface.w > 0.0;
  bool planet = !land && SeesPlanet(direction);
  float distance_km = land ? 1e-3 * surface.w : planet ? PlanetDistance(direction) : 1e3;
  float clear = FogTransmittance(direction, distance_km);
  vec4 left = TransmittanceToSpace(planet ? StraightToPlanet(direction) : direction) * clear;
  vec4 behind;
  if (land) {
    left = AirToPoint(direction, distance_km).transmittance * clear;
    behind = NightReflected(LandOf(surface, PlaceSeen(direction, surface.w), direction), -direction);
  } else if (planet) {
    behind = NightReflected(PlanetSeen(PlanetPlace(direction, distance_km), -direction), -direction);
  } else {
    behind = NightAbove(direction);
  }
  picture = vec4(LinearSrgb((1.0 - left) * night_scattered + left * behind), 0.0);
}
#endif
