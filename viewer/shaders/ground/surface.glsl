// SPDX-License-Identifier: MIT
// Reflection by surfaces of the ground: reflectance.glsl with the parameters of one scene,
// GroundSurface of ground_block.h. GROUND_COVER is a GroundCover::Kind; HAS_SEA, HAS_DRAPE,
// HAS_LAND_COVER (of the drape), HAS_WATER and HAS_GLOSS (water or a coat) are 1 or 0, because
// software drivers evaluate both sides of every branch.
#define MOUNTAIN_COVER 0
#define LAMBERT_COVER 1
#define OREN_NAYAR_COVER 2
#define BLINN_PHONG_COVER 3
#define WATER_COVER 4
#define SNOW_COVER 5
#define WATER_INDEX 1.34

layout(std140) uniform GroundSurface {
  vec4 cover_albedo;  // of a cover with one colour
  vec4 rough;         // RoughDiffuse: roughness, scale, mean albedo
  vec4 coat;          // Glossy: exponent, reflectance at normal incidence, normalisation
  vec4 water;         // variance of slopes; highest ground that is sea [m]; wetness of land
  vec4 under_water;   // by band
  vec4 snow_y;        // by band
  vec4 drape_red;     // albedo of the primary colours by band
  vec4 drape_green;
  vec4 drape_blue;
  vec4 drape_place;  // of the picture in the mesh's frame: west, south [m]; 1 / size [1/m]
  vec4 drape_eye;    // position of the eye in that frame [m]
  vec4 drape_east;   // axes of that frame in the frame of the pattern
  vec4 drape_north;
  // Values at even steps of the square root of a cosine: for snow the factor of a direction, for a
  // coat the fraction of a uniform sky that it reflects.
  vec4 by_root_mu[17];
  // GlossMirror: altitude of its first sky [km], 1 / distance of its second sky above it [1/km].
  vec4 mirror_place;
};

uniform sampler2DArray gloss_mirror;  // GlossMirror of gloss_mirror.h: waves, then land
#ifdef TWO_LIGHTS
uniform sampler2DArray other_gloss_mirror;  // of the second light
#endif
uniform sampler2D level_sky;          // LevelSky of gloss_mirror.h
#if HAS_DRAPE
uniform sampler2D drape;  // linear sRGB, or fractions of land cover; fourth: 1 inside the picture
#endif

// A place on the ground, with the quantities that its lighting and material need.
struct GroundPlace {
  vec3 up;
  float altitude;   // km
  float footprint;  // across the ray [m]
  vec3 offset;      // from the eye, east, north and upwards in the frame of the pattern [m]
  vec3 point;       // from the eye, east, north and upwards there [m]
};

// Returns the cosines between normal and light, normal and eye, light and eye: AnglesBetween of
// reflectance.h.
vec3 ReflectionAngles(vec3 normal, vec3 to_light, vec3 to_eye) {
  return vec3(clamp(dot(normal, to_light), 1e-4, 1.0), clamp(dot(normal, to_eye), 1e-4, 1.0),
              clamp(dot(to_light, to_eye), -1.0, 1.0));
}

// Returns the irradiance of the sky on a level surface at altitude 0, per unit solar irradiance.
// @param mu_s  of sun_for_air.
vec4 LevelSky(float mu_s) {
  float x = (AngleOfSine(clamp(mu_s, -1.0, 1.0)) - LEVEL_SKY_LOWEST) / LEVEL_SKY_RANGE;
  return texture(level_sky, vec2(TexelFromUnit(clamp(x, 0.0, 1.0), LEVEL_SKY_NODES), 0.5));
}

// @param variance  of the slopes that the normal does not include.
vec4 WaterBrdf(vec3 angles, float variance) {
  float glitter = WaveGlitter(angles.x, angles.y, angles.z, variance, WATER_INDEX);
  float through = WaterTransmitted(angles.x, WATER_INDEX) * WaterTransmitted(angles.y, WATER_INDEX);
  return vec4(glitter) + through / 3.14159265359 * under_water;
}

#if HAS_GLOSS
// A mirrored direction, and what its place sees there.
struct Mirror {
  GroundPlace at;
  float sine;  // of the elevation of the direction
  vec3 direction;
  Surroundings around;
  float first_layer;  // of GlossMirror
};

// @param among_land  false: ground beyond the terrain, which sees none.
Mirror MirrorOf(GroundPlace at, vec3 direction, bool among_land, float first_layer) {
  Surroundings around = SurroundingsTowards(at.point, direction);
  if (!among_land || OF_LIGHT(slope_unit, other_slope_unit).x <= 0.0) around = kNoSurroundings;
  return Mirror(at, dot(direction, at.up), direction, around, first_layer);
}

// Returns a texel of GlossMirror.
// @param sine  of the elevation of a mirrored direction.
vec4 MirrorTexel(Mirror mirror, float sine, float column, float layer) {
  vec2 unit = vec2(column, sqrt(clamp(sine, 0.0, 1.0)));
  vec2 texel =
      vec2(TexelFromUnit(unit.x, GLOSS_MIRROR_SIDE), TexelFromUnit(unit.y, GLOSS_MIRROR_SIDE));
  return TEXEL_OF_LIGHT(gloss_mirror, other_gloss_mirror,
                        vec3(texel, mirror.first_layer + layer));
}

// Returns the part of the mirrored weights that a horizon hides, from its place among the layers.
float HiddenWeight(Mirror mirror, float sine, float place) {
  return MirrorTexel(mirror, sine, place, GLOSS_MIRROR_LAYERS - 1.0).x;
}

// Returns the light of the sky above the horizon of a layer.
vec4 SkyAbove(Mirror mirror, float column, float layer) {
  float altitude = (mirror.at.altitude - mirror_place.x) * mirror_place.y;
  return mix(MirrorTexel(mirror, mirror.sine, column, layer),
             MirrorTexel(mirror, mirror.sine, column, layer + GLOSS_MIRROR_HORIZONS),
             clamp(altitude, 0.0, 1.0));
}

// Returns the column of GlossMirror for the azimuth of a mirrored direction from that of the sun.
float MirrorColumn(Mirror mirror) {
  vec3 up = mirror.at.up;
  vec3 flat_ray = mirror.direction - mirror.sine * up;
  vec3 flat_sun = sun_for_air.xyz - dot(up, sun_for_air.xyz) * up;
  float lengths = max(length(flat_ray) * length(flat_sun), 1e-9);
  return sqrt(0.5 * (1.0 - clamp(dot(flat_ray, flat_sun) / lengths, -1.0, 1.0)));
}

// Returns the place of the horizon among the layers, in [0, 1]. A direction below the horizontal
// sees as much more of the ground.
float HorizonPlace(Mirror mirror) {
  float over_lowest = mirror.around.horizon - min(mirror.sine, 0.0) - SKY_LOWEST;
  bool is_open = mirror.around.horizon <= SKY_LOWEST;
  return is_open ? 0.0 : sqrt(clamp(over_lowest / (1.0 - SKY_LOWEST), 0.0, 1.0));
}

// Returns the radiance of sky and slopes in a mirror [1/sr].
vec4 SeenInMirror(Mirror mirror) {
  const float steps = GLOSS_MIRROR_HORIZONS - 1.0;
  float column = MirrorColumn(mirror), at = HorizonPlace(mirror) * steps;
  float layer = min(floor(at), steps - 1.0), share = at - layer;
  vec4 below = SkyAbove(mirror, column, layer), above = SkyAbove(mirror, column, layer + 1.0);
  vec2 hides = vec2(HiddenWeight(mirror, mirror.sine, layer / steps),
                    HiddenWeight(mirror, mirror.sine, (layer + 1.0) / steps));
  vec4 sky = mix(below, above, share);
  float hidden = mix(hides.x, hides.y, share);
  // The sky between the two horizons stands for the sky over the horizon; where nothing is mirrored
  // from there, the sky that is hidden does.
  const float little = 0.01;
  vec4 all = SkyAbove(mirror, column, 0.0);
  vec4 over_horizon = max(below - above + little * (all - sky), vec4(0.0)) /
                      max(hides.y - hides.x + little * hidden, 1e-9);
  vec4 level = LevelSky(dot(mirror.at.up, sun_for_air.xyz));
  float weight = mirror.around.weight, missing = mirror.around.missing_weight;
  vec4 slopes = (mirror.around.slopes + missing * over_horizon * level) /
                max(weight + missing, 1e-9);
  return sky * level + hidden * slopes;
}
#endif

#if HAS_WATER
// Returns the radiance of sky and slopes reflected by waves [1/sr].
// @param normal  of the waves that are resolved. The reflectance is theirs.
vec4 MirroredByWaves(GroundPlace at, vec3 normal, vec3 to_eye, bool among_land) {
  float mu_eye = clamp(dot(normal, to_eye), 0.0, 1.0);
  Mirror mirror = MirrorOf(at, 2.0 * mu_eye * normal - to_eye, among_land, 0.0);
  float reflected = HiddenWeight(mirror, mu_eye, 1.0);
  return reflected / max(HiddenWeight(mirror, mirror.sine, 1.0), 1e-9) * SeenInMirror(mirror);
}

// Returns the radiance of water. `across` is the sun's irradiance perpendicular to its beams.
// @param cosine  between the eye and the normal of the mesh.
vec4 WaterRadiance(GroundPlace at, float cosine, vec4 across, vec4 sky_irradiance, vec3 to_eye,
                   bool among_land) {
  vec3 waves = WavesAt(at.offset, SeenFootprint(at.footprint, cosine), water.x, cosine);
  vec3 tilt = waves.x * pattern_east.xyz + waves.y * pattern_north.xyz;
  vec3 normal = normalize(at.up - tilt + dot(tilt, at.up) * at.up);
  vec3 angles = ReflectionAngles(normal, sun.xyz, to_eye);
  vec4 body = WaterLetsIn(WATER_INDEX, angles.y) * under_water;
  return max(dot(normal, sun.xyz), 0.0) * across * WaterBrdf(angles, waves.z) +
         body / 3.14159265359 * sky_irradiance + MirroredByWaves(at, normal, to_eye, among_land);
}
#endif

float ByRootOf(float mu) {
  float at = 64.0 * sqrt(mu);
  int node = min(int(at), 63);
  int next = node + 1;
  return mix(by_root_mu[node / 4][node % 4], by_root_mu[next / 4][next % 4], at - float(node));
}

vec4 SnowBrdf(vec3 angles) {
  float r0 =
      SnowWithoutAbsorption(angles.x, angles.y, angles.z) * ByRootOf(angles.x) * ByRootOf(angles.y);
  return r0 / 3.14159265359 * exp(-snow_y * (SnowEscape(angles.x) * SnowEscape(angles.y) / r0));
}

vec4 RoughBrdf(vec4 albedo, vec3 angles) {
  float once = RoughOnce(angles.x, angles.y, angles.z, rough.x, rough.y);
  float again = RoughTwice(angles.x, angles.y, rough.x, rough.y);
  vec4 sent;
  for (int band = 0; band < 4; ++band)
    sent[band] = albedo[band] * once + again * RoughAgain(albedo[band], rough.z);
  return sent;
}

vec4 RoughAlbedo(vec4 albedo, float mu) {
  float once = RoughSingle(mu, rough.x, rough.y);
  vec4 sent;
  for (int band = 0; band < 4; ++band)
    sent[band] = albedo[band] * once + (1.0 - once) * RoughAgain(albedo[band], rough.z);
  return sent;
}

vec4 GlossyBrdf(vec4 albedo, vec3 angles) {
  float cos_light = HalfCosLight(angles.z);
  float lobe = CoatLobe(HalfMu(angles.x, angles.y, cos_light), cos_light, coat.y, coat.x, coat.z);
  return vec4(lobe) + BodyUnderCoat(angles.x, angles.y, coat.y) * albedo;
}

// Returns the BRDF of the land's cover, without water.
vec4 CoverBrdf(vec4 albedo, vec3 angles) {
#if GROUND_COVER == OREN_NAYAR_COVER
  return RoughBrdf(albedo, angles);
#elif GROUND_COVER == BLINN_PHONG_COVER
  return GlossyBrdf(albedo, angles);
#elif GROUND_COVER == SNOW_COVER
  return SnowBrdf(angles);
#else
  return albedo / 3.14159265359;
#endif
}

// Returns the fraction of a uniform sky that is reflected diffusely to the eye, without mirror
// reflection.
vec4 CoverBodyAlbedo(vec4 albedo, float mu_eye) {
#if GROUND_COVER == OREN_NAYAR_COVER
  return RoughAlbedo(albedo, mu_eye);
#elif GROUND_COVER == BLINN_PHONG_COVER
  return (1.0 - coat.y) * CoatPassed(mu_eye) * albedo;
#elif GROUND_COVER == SNOW_COVER
  return exp(-snow_y * SnowEscape(mu_eye));
#else
  return albedo;
#endif
}

// Returns the radiance of sky and slopes reflected by a glossy coat.
vec4 MirroredByCoat(GroundPlace at, vec3 normal, float mu_eye, vec3 to_eye, bool among_land) {
#if GROUND_COVER == BLINN_PHONG_COVER
  return ByRootOf(mu_eye) *
         SeenInMirror(MirrorOf(at, reflect(-to_eye, normal), among_land, GLOSS_MIRROR_OF_LAND));
#else
  return vec4(0.0);
#endif
}

// Radiance of land.
vec4 CoverRadiance(GroundPlace at, vec4 albedo, vec3 normal, vec4 across, vec4 sky_irradiance,
                   vec3 to_eye, bool among_land) {
  vec3 angles = ReflectionAngles(normal, sun.xyz, to_eye);
  return max(dot(normal, sun.xyz), 0.0) * across * CoverBrdf(albedo, angles) +
         CoverBodyAlbedo(albedo, angles.y) / 3.14159265359 * sky_irradiance +
         MirroredByCoat(at, normal, angles.y, to_eye, among_land);
}

#if HAS_DRAPE
// Returns the drape's value and 1, or 0 in the fourth component outside the drape.
// @param offset  from the eye in the plane of the pattern [m].
// @param altitude  [m].
vec4 DrapeAt(vec3 offset, float altitude, float footprint) {
  vec2 from_eye = vec2(dot(offset, drape_east.xyz), dot(offset, drape_north.xyz));
  vec2 foot = (from_eye + drape_eye.xy) * (1e3 * RADIUS / (1e3 * RADIUS + altitude));
  vec2 at = (foot - drape_place.xy) * drape_place.zw;
  float level = log2(max(footprint * drape_place.z * float(textureSize(drape, 0).x), 1.0));
  vec4 shown = textureLod(drape, clamp(at, 0.0, 1.0), level);
  shown.xyz /= max(shown.w, 1e-3);  // undo averaging across the picture's rim
  bool within = all(greaterThanEqual(at, vec2(0.0))) && all(lessThanEqual(at, vec2(1.0)));
  shown.w = within && shown.w > 0.5 ? 1.0 : 0.0;
#if HAS_LAND_COVER
  shown.w *= IsMapped(shown.y, shown.z);
#endif
  return shown;
}
#else
vec4 DrapeAt(vec3 offset, float altitude, float footprint) { return vec4(0.0); }
#endif

// Returns whether the place is water.
bool IsWater(float altitude, vec4 drape_shown) {
#if HAS_LAND_COVER
  if (drape_shown.w * IsMappedWater(drape_shown.x, drape_shown.y) > 0.5) return true;
#endif
  return altitude <= water.y;
}

// Returns the diffuse albedo of the land.
// @param tilt  see GroundAlbedo.
// @param drape_shown  value of DrapeAt.
vec4 LandAlbedo(vec3 offset, float altitude, vec2 tilt, float footprint, vec4 drape_shown) {
#if GROUND_COVER == MOUNTAIN_COVER
  vec4 mapped = HAS_LAND_COVER == 1 ? drape_shown : vec4(0.0);
  vec4 albedo = GroundAlbedo(offset, altitude, tilt, footprint, mapped);
#else
  vec4 albedo = cover_albedo;
#endif
#if HAS_DRAPE && !HAS_LAND_COVER
  vec4 draped =
      clamp(drape_shown.x * drape_red + drape_shown.y * drape_green + drape_shown.z * drape_blue,
            0.0, 1.0);
  for (int band = 0; band < 4; ++band) draped[band] = WetAlbedo(draped[band], water.z);
  albedo = drape_shown.w > 0.5 ? draped : albedo;
#endif
  return albedo;
}
