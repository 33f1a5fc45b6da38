// SPDX-License-Identifier: MIT
// The linear picture [cd/m^2, linear sRGB] lit by the lights of the sky, and the inverse depth of
// land (gbuffer/inverse_depth.glsl). The passes are separated by the depth test against land,
// because software drivers evaluate both sides of a branch. Defined before this text:
//   PASS          LAND_PASS: land and the air in front of it; SKY_PASS: sky and bare planet;
//                 OPEN_SKY_PASS: sky above the planet; DISK_PASS: disks of sun and moon
//   TWO_LIGHTS    defined if there is a second light, which casts no shadows (frame_sky.h)
//   OTHER_HAS_SET  defined if that light has set (view/lights.glsl)
//   HAS_NIGHT     light of the night sky on land, air and sky
//   HAS_SHADE, HAS_LAMPS, HAS_MEDIA, HAS_CLOUDS
//   SKY_BY_PIXEL  irradiance by the sky on land is computed here (sky_by_pixel/irradiance.glsl),
//                 not by vertex
in vec2 screen;
out vec4 picture;

uniform sampler2D surface_map;     // output of land/land.frag.glsl
uniform sampler2D sky_on_surface;  // output of land/land.frag.glsl for the first light
#ifdef TWO_LIGHTS
uniform sampler2D other_sky_on_surface;
#endif

// Returns whether the current light casts shadows.
bool CastsShadows() { return OF_LIGHT(true, false); }

// Returns the light of the air before a distance, attenuated by media. `all` is that of the whole
// path without media.
vec4 AirInMedia(vec3 direction, float distance_km, vec4 all) {
#if HAS_MEDIA
  MediaStretches stretches = MediaStretchesTo(direction, distance_km);
  vec4 sum = stretches.weight[MEDIA_STRETCHES - 1] * all;
  vec4 light = vec4(0.0), before = vec4(0.0);
  for (int i = 0; i < MEDIA_STRETCHES - 1; ++i) {
    AirTo air = AirToPoint(direction, stretches.distance_km[i]);
    before = light;
    light = air.single + air.diffuse;
    sum += stretches.weight[i] * light;
  }
  return sum + MediaRest(stretches, all, light, before);
#else
  return all;
#endif
}

// Returns the light from a distance plus that of the air and media on the path, without terrain
// shadows.
vec4 ThroughMedia(vec3 direction, float distance_km, vec4 air, vec4 behind) {
#if HAS_MEDIA
  MediaAlong media = MediaTo(direction, distance_km);
  return AirInMedia(direction, distance_km, air) + media.radiance + media.transmittance * behind;
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
  if (!CastsShadows()) return taken;
  taken = TakenByShade(shaded_km, single);
#if HAS_MEDIA
  taken += MediaTakenByShade(shaded_km, MediaSunTo(direction, distance_km));
#endif
#endif
  return taken;
}

// Returns the land in a texel of the surface map.
// @param place  its true position, from the eye [m].
SeenGround LandOf(vec4 surface, vec3 place, vec3 direction) {
  return LandSeen(place, UnitFromOctahedral(surface.xy), -direction);
}

// Returns the radiance of ground lit by sun and sky through the media above it.
// @param sky  irradiance on seen.normal.
vec4 SunlitGround(SeenGround seen, float sun_x, vec4 sky, vec3 to_eye) {
#if HAS_MEDIA
  float altitude = seen.at.altitude;
  sky = SkyLeftByMedia(altitude) * sky + MediaOnSurface(altitude, dot(seen.normal, seen.at.up));
#endif
#if HAS_CLOUDS
  sky = SkyUnderClouds(sky, seen.at.altitude, dot(seen.normal, seen.at.up));
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

#if HAS_NIGHT
// Returns the radiance of the night sky that the air on a path scatters, and what is behind it.
// @param left  transmittance of the path.
vec4 NightThrough(vec4 left, vec4 behind) { return (1.0 - left) * night_scattered + left * behind; }

// Returns the light reflected by ground that sees the part of a uniform sky left by its tilt.
vec4 NightReflected(SeenGround seen, vec3 to_eye) {
  vec4 level = 0.5 * (1.0 + dot(seen.normal, seen.at.up)) * night_level;
  return SentOfIrradiance(seen, level, to_eye);
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

// Land in a pixel, with all that does not depend on a light.
struct LandPixel {
  vec3 direction, place;
  vec4 surface;
  float over_edge;  // of the first light
  SeenGround seen;
};

// Returns the radiance of land and air lit by the current light.
vec4 LandInLight(LandPixel land) {
  float distance_km = 1e-3 * land.surface.w;
  AirTo air = AirToPoint(land.direction, distance_km);
#if SKY_BY_PIXEL
  vec4 sky = SkyAtPixel(land.seen.at, land.place, land.seen.normal);
#else
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 sky = SkyByShare(land.seen, OF_LIGHT(texelFetch(sky_on_surface, pixel, 0),
                                            texelFetch(other_sky_on_surface, pixel, 0)));
#endif
  float over_edge = CastsShadows() ? land.over_edge : kNoEdge;
  vec4 ground = air.transmittance * SunlitGround(land.seen, over_edge, sky, -land.direction);
  vec4 radiance = ThroughMedia(land.direction, distance_km, air.single + air.diffuse, ground) -
                  ShadeOnTheWay(land.direction, distance_km, distance_km, air.single);
  return sun_irradiance * radiance;
}

void main() {
  vec3 direction = ViewDirection(screen);
  vec4 surface = texelFetch(surface_map, ivec2(gl_FragCoord.xy), 0);
  vec3 place = PlaceSeen(direction, surface.w);
  float over_edge = ground_view.y > 0.0 ? OverSmoothEdge(surface) : kNoEdge;
  LandPixel land =
      LandPixel(direction, place, surface, over_edge, LandOf(surface, place, direction));
  vec4 bands = LandInLight(land);
#ifdef TWO_LIGHTS
  of_other = true;
  bands += LandInLight(land);
#endif
#if HAS_NIGHT || HAS_LAMPS
  float distance_km = 1e-3 * surface.w;
  vec4 left =
      TransmittanceTo(direction, distance_km) * MediaTransmittance(direction, distance_km);
#endif
#if HAS_NIGHT
  bands += NightThrough(left, NightReflected(land.seen, -direction));
#endif
  float along_m = surface.w * dot(direction, view_forward.xyz);
  picture = vec4(LinearSrgb(bands), InverseDepth(along_m));
#if HAS_LAMPS
  picture.rgb += LampRgb(left * LampsReflected(land.seen, place, direction)) +
                 LampAirlightRgb(direction, LampRayEnd(direction, surface.w));
#endif
#if HAS_CLOUDS
  picture.rgb = BehindClouds(picture.rgb, 1e-3 * surface.w);
#endif
}
#endif

#if PASS == SKY_PASS || PASS == OPEN_SKY_PASS
#if HAS_NIGHT
uniform sampler2D night_sky;  // NightSkyMap of night_sky_map.h

vec4 NightAbove(vec3 direction) {
  float elevation = AngleOfSine(clamp(direction.z, -1.0, 1.0));
  vec2 place = vec2(0.5 * atan(direction.x, direction.y), elevation) / 3.14159265359;
  return textureLod(night_sky, place + vec2(0.0, 0.5), 0.0);
}

#endif

// Returns the radiance of the whole path minus the light that shadows remove. The sky table holds
// the path in the direction `straight`.
vec4 SkyInLight(vec3 direction, vec3 straight) {
  vec4 clear = SkyRadiance(straight);
  vec4 radiance = ThroughMedia(direction, kOutOfMedia_km, clear, vec4(0.0));
  return radiance - min(ShadeOnTheWay(direction, kOutOfMedia_km, 1e9, clear), radiance);
}

#if PASS == SKY_PASS
// True if the sky table holds the planet's ground without changes.
#define PLANET_IS_PLAIN (!HAS_MEDIA && !HAS_CLOUDS && GROUND_COVER == MOUNTAIN_COVER && !PLANET_IS_WATER)

// A direction in which the bare planet may be seen, with all that does not depend on a light.
struct PlanetPixel {
  bool is_seen;
  vec3 direction, straight, place;
  float distance_km;
  SeenGround seen;
};

PlanetPixel PlanetIn(vec3 direction) {
  bool is_seen = SeesPlanet(direction);
  vec3 straight = is_seen ? StraightToPlanet(direction) : direction;
  float distance_km = PlanetDistance(direction);
  vec3 place = PlanetPlace(direction, distance_km);
  return PlanetPixel(is_seen, direction, straight, place, distance_km,
                     PlanetSeen(place, -direction));
}

// Returns the radiance of planet or sky lit by the current light.
vec4 PlanetInLight(PlanetPixel planet) {
  vec4 radiance = SkyInLight(planet.direction, planet.straight);
  if (planet.is_seen) {
#if PLANET_IS_PLAIN
    vec4 beyond = PlanetBeyondEven(planet.seen, -planet.direction);
    radiance = max(radiance + TransmittanceToSpace(planet.straight) * beyond, vec4(0.0));
#else
    AirTo air = AirToPoint(planet.direction, planet.distance_km);
    vec4 ground = air.transmittance * SunlitGround(planet.seen, kNoEdge, SkyOnPlanet(planet.seen),
                                                   -planet.direction);
    radiance = ThroughMedia(planet.direction, planet.distance_km, air.single + air.diffuse, ground);
#endif
  }
  return sun_irradiance * radiance;
}

#if HAS_NIGHT
vec4 NightOf(PlanetPixel planet) {
  float distance_km = planet.is_seen ? planet.distance_km : kOutOfMedia_km;
  vec4 left =
      TransmittanceToSpace(planet.straight) * MediaTransmittance(planet.direction, distance_km);
  vec4 behind = planet.is_seen ? NightReflected(planet.seen, -planet.direction)
                               : NightAbove(planet.direction);
  return NightThrough(left, behind);
}
#endif

#if HAS_LAMPS
vec4 PlanetUnderLamps(PlanetPixel planet) {
  vec4 left = TransmittanceTo(planet.direction, planet.distance_km) *
              MediaTransmittance(planet.direction, planet.distance_km);
  return left * LampsReflected(planet.seen, planet.place, planet.direction);
}
#endif

void main() {
  vec3 direction = ViewDirection(screen);
  PlanetPixel planet = PlanetIn(direction);
  vec4 bands = PlanetInLight(planet);
#ifdef TWO_LIGHTS
  of_other = true;
  bands += PlanetInLight(planet);
#endif
#if HAS_NIGHT
  bands += NightOf(planet);
#endif
  picture = vec4(LinearSrgb(bands), 0.0);
#if HAS_LAMPS
  picture.rgb += LampAirlightRgb(direction, LampRayEnd(direction, 0.0));
  if (planet.is_seen) picture.rgb += LampRgb(PlanetUnderLamps(planet));
#endif
#if HAS_CLOUDS
  picture.rgb = BehindClouds(picture.rgb, planet.is_seen ? planet.distance_km : kToSpace_km);
#endif
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

void main() {
  vec3 direction = NotUnderHorizon(ViewDirection(screen));
  vec4 bands = sun_irradiance * SkyInLight(direction, direction);
#ifdef TWO_LIGHTS
  of_other = true;
  bands += sun_irradiance * SkyInLight(direction, direction);
#endif
#if HAS_NIGHT
  vec4 left = TransmittanceToSpace(direction) * MediaTransmittance(direction, kOutOfMedia_km);
  bands += NightThrough(left, NightAbove(direction));
#endif
  picture = vec4(LinearSrgb(bands), 0.0);
#if HAS_LAMPS
  picture.rgb += LampAirlightRgb(direction, LampRayEnd(direction, 0.0));
#endif
#if HAS_CLOUDS
  picture.rgb = BehindClouds(picture.rgb, kToSpace_km);
#endif
}
#endif
#endif

#if PASS == DISK_PASS
void main() {
  vec3 direction = ViewDirection(screen);
  // Off the middle of a view its rays are closer together.
  float width = RAY_ANGLE * dot(direction, view_forward.xyz);
  vec4 disks = RefractedDisks(direction, width) * TransmittanceToSpace(direction);
  vec4 radiance = SeesPlanet(direction) ? vec4(0.0) : disks;
#if HAS_MEDIA
  radiance *= MediaTransmittance(direction, 1e3);
#endif
#if HAS_CLOUDS
  radiance *= BeamBehindClouds(direction);
#endif
  picture = vec4(LinearSrgb(sun_irradiance * radiance), 0.0);
}
#endif
