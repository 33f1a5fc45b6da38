// SPDX-License-Identifier: MIT
// Radiance of the ground towards the eye, per unit solar irradiance [1/sr], without lamps:
// ground_light.h of the renderer, with the irradiance of sky and slopes and the shadow edges that
// LitGround interpolates.

// Irradiance of the unoccluded sky on surfaces of any tilt: GroundLightBlock of ground_block.h.
layout(std140) uniform GroundLight {
  vec4 sky_towards;  // horizontal direction towards the sun
  vec4 ground_view;  // angle of a pixel [rad]; second: 1 if the shadow edges belong to this sun
  vec4 open_sky[OPEN_SKY_COLUMNS * OPEN_SKY_ROWS];  // nodes of SkyIrradianceGradient, by band
};

// GroundLight of the second light.
#ifdef TWO_LIGHTS
layout(std140) uniform OtherGroundLight {
  vec4 other_sky_towards;
  vec4 other_ground_view;
  vec4 other_open_sky[OPEN_SKY_COLUMNS * OPEN_SKY_ROWS];
};
#endif

vec4 OpenSky(int node) { return OF_LIGHT(open_sky[node], other_open_sky[node]); }

// Returns the components of a normal upwards and to the north.
vec2 TiltOf(vec3 normal, vec3 up) {
  vec3 north = pole.xyz - dot(pole.xyz, up) * up;
  return vec2(dot(normal, up), dot(normal, north) * inversesqrt(max(dot(north, north), 1e-12)));
}

// @param point  from the eye [m].
GroundPlace GroundPlaceAt(vec3 point) {
  vec3 at = 1e-3 * point;
  float d = length(at);
  float h = AltitudeAlongRay(EYE_ALTITUDE, at.z / max(d, 1e-9), d, RADIUS);
  return GroundPlace(normalize(vec3(at.xy, RADIUS + EYE_ALTITUDE + at.z)), max(h, 0.0),
                     1e3 * d * ground_view.x,
                     vec3(dot(point, pattern_east.xyz), dot(point, pattern_north.xyz),
                          dot(point, pattern_up.xyz)),
                     point);
}

vec2 DiskOver(GroundPlace at, vec3 to_sun) {
  return DiskOverHorizon(clamp(dot(at.up, to_sun), -1.0, 1.0), HorizonCosine(at.altitude, RADIUS),
                         sun.w);
}

// Returns the sun's irradiance on a plane perpendicular to its beams, attenuated by the air, for
// the part of the disk above the planet's horizon, above terrain and above the local plane of the
// mesh.
vec4 SunAcross(GroundPlace at, vec3 mesh_normal, float sun_x) {
  if (HasSet()) return vec4(0.0);
  vec2 disk = DiskOver(at, sun.xyz);
  float over_plane = dot(mesh_normal, sun.xyz) / sun.w;
  vec4 beam = disk.x * SunlightOverEdge(min(sun_x, over_plane)) * BeamOfSun(at.altitude, disk.y);
#ifdef CLOUD_LAYERS
  beam *= BeamLeftByClouds(InCloudFrame(at.point, at.altitude));
#endif
  return beam;
}

// Returns the normal for lighting, which includes relief finer than the mesh if there is any.
vec3 NormalInLight(vec3 offset, vec3 mesh_normal, float footprint) {
#if HAS_FINE_RELIEF
  return DetailedNormal(offset, mesh_normal, footprint);
#else
  return mesh_normal;
#endif
}

// Returns the irradiance of the unoccluded sky on a surface, at half the height of the land.
vec4 UnoccludedSkyOnSlope(vec3 normal, vec3 up) {
  float u = UnoccludedSkyColumn(dot(normal, OF_LIGHT(sky_towards, other_sky_towards).xyz));
  float v = UnoccludedSkyRow(dot(normal, up));
  int column = min(int(u), OPEN_SKY_COLUMNS - 2), row = min(int(v), OPEN_SKY_ROWS - 2);
  int low = row * OPEN_SKY_COLUMNS + column, high = low + OPEN_SKY_COLUMNS;
  float right = u - float(column);
  return mix(mix(OpenSky(low), OpenSky(low + 1), right), mix(OpenSky(high), OpenSky(high + 1), right),
             v - float(row));
}

// Ground at the end of a ray, on land or on the planet beyond it, with the quantities for all
// lights.
struct SeenGround {
  GroundPlace at;
  vec3 mesh_normal;  // unit, without the finer relief
  vec3 normal;       // with the finer relief
  vec4 albedo;       // diffuse albedo of land
  bool is_water;
  bool among_land;  // false: beyond the terrain, which it does not see
};

SeenGround WaterSeen(GroundPlace at, vec3 mesh_normal, bool among_land) {
  return SeenGround(at, mesh_normal, at.up, vec4(0.0), true, among_land);
}

// Returns the ground of the terrain.
// @param point_m  from the eye.
// @param mesh_normal, to_eye  unit.
SeenGround LandSeen(vec3 point_m, vec3 mesh_normal, vec3 to_eye) {
  GroundPlace at = GroundPlaceAt(point_m);
#if GROUND_COVER == WATER_COVER
  return WaterSeen(at, mesh_normal, true);
#else
  float altitude = 1e3 * at.altitude;
  float footprint = LandFootprint(at.footprint, dot(mesh_normal, to_eye));
  vec4 draped = DrapeAt(at.offset, altitude, at.footprint);
#if HAS_SEA || HAS_LAND_COVER
  if (IsWater(altitude, draped)) return WaterSeen(at, mesh_normal, true);
#endif
  return SeenGround(at, mesh_normal, NormalInLight(at.offset, mesh_normal, footprint),
                    LandAlbedo(at.offset, altitude, TiltOf(mesh_normal, at.up), footprint, draped),
                    false, true);
#endif
}

// Returns the ground of the planet without terrain: seasonal low land beyond terrain, else a
// constant albedo.
SeenGround PlanetSeen(vec3 point_m, vec3 to_eye) {
  GroundPlace at = GroundPlaceAt(point_m);
#if PLANET_IS_WATER
  return WaterSeen(at, at.up, false);
#elif GROUND_COVER == MOUNTAIN_COVER && PLANET_IS_LAND
  vec4 albedo = GroundAlbedo(at.offset, 0.0, TiltOf(at.up, at.up),
                             LandFootprint(at.footprint, dot(at.up, to_eye)), vec4(0.0));
  return SeenGround(at, at.up, at.up, albedo, false, false);
#elif GROUND_COVER == MOUNTAIN_COVER
  return SeenGround(at, at.up, at.up, ground_albedo, false, false);
#else
  return SeenGround(at, at.up, at.up, cover_albedo, false, false);
#endif
}

// Returns the irradiance of the sky if terrain leaves the fraction `share` of the unoccluded sky:
// VertexLight (land_chunk.h).
vec4 SkyByShare(SeenGround seen, vec4 share) {
  return share * UnoccludedSkyOnSlope(seen.normal, seen.at.up);
}

// Returns the radiance of ground lit by sun and sky.
// @param sun_x  see LitVertex (lit_ground.h).
// @param sky_irradiance  on seen.normal.
vec4 SentOn(SeenGround seen, float sun_x, vec4 sky_irradiance, vec3 to_eye) {
  GroundPlace at = seen.at;
#if HAS_WATER
  if (seen.is_water)
    return WaterRadiance(at, dot(seen.mesh_normal, to_eye), SunAcross(at, at.up, sun_x),
                         sky_irradiance, to_eye, seen.among_land);
#endif
  return CoverRadiance(at, seen.albedo, seen.normal, SunAcross(at, seen.mesh_normal, sun_x),
                       sky_irradiance, to_eye, seen.among_land);
}

// Returns the diffuse radiance for an irradiance without direction, of lamps or at night.
vec4 SentOfIrradiance(SeenGround seen, vec4 irradiance, vec3 to_eye) {
  float mu_eye = clamp(dot(seen.normal, to_eye), 1e-4, 1.0);
  vec4 albedo = CoverBodyAlbedo(seen.albedo, mu_eye);
#if HAS_WATER
  if (seen.is_water) albedo = WaterLetsIn(WATER_INDEX, mu_eye) * under_water;
#endif
  return albedo / 3.14159265359 * irradiance;
}

const float kNoEdge = 1e9;  // value of sun_x if no terrain hides the sun

vec4 SkyOnPlanet(SeenGround seen) { return LevelSky(dot(seen.at.up, sun_for_air.xyz)); }

// Returns the irradiance by the sun of the level planet, by straight rays.
vec4 StraightSunOn(GroundPlace at) {
  if (HasSet()) return vec4(0.0);
  float mu_s = dot(at.up, sun_for_air.xyz);
  vec2 disk = DiskOver(at, sun_for_air.xyz);
  return max(mu_s, 0.0) * disk.x * SunlightOverEdge(mu_s / sun.w) *
         TransmittanceToSun(at.altitude, disk.y);
}

// Returns the planet's radiance minus that of uniform ground with the medium's albedo, which the
// sky table contains.
vec4 PlanetBeyondEven(SeenGround seen, vec3 to_eye) {
  vec4 sky = SkyOnPlanet(seen);
  vec4 even = (StraightSunOn(seen.at) + sky) * ground_albedo / 3.14159265359;
  return SentOn(seen, kNoEdge, sky, to_eye) - even;
}
