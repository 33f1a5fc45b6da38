// SPDX-License-Identifier: MIT
// What the ground sends towards the eye, per unit solar irradiance [1/sr]: ground_light.h of the
// renderer, with the light of sky and slopes, and the edges of shade, as LitGround interpolates
// them. Lamps are apart.

// What the sky's light gains where a surface tilts: GroundLightBlock of ground_block.h.
layout(std140) uniform GroundLight {
  vec4 sky_level;  // irradiance of an open place: level + up n.up + sunward n.sunward, by band
  vec4 sky_up;
  vec4 sky_sunward;
  vec4 sky_towards;  // horizontal direction towards the sun
  vec4 ground_view;  // angle of a pixel [rad]
};

// A place of the ground as its light and material see it.
struct GroundPlace {
  vec3 up;
  float altitude;   // km
  float footprint;  // across the ray [m]
  vec3 offset;      // from the eye, east, north and upwards in the frame of the pattern [m]
};

// Components of a normal upwards and to the north.
vec2 TiltOf(vec3 normal, vec3 up) { return vec2(dot(normal, up), dot(normal, mesh_north.xyz)); }

// @param point  from the eye [m].
GroundPlace GroundPlaceAt(vec3 point) {
  vec3 at = 1e-3 * point;
  float d = length(at);
  float h = AltitudeAlongRay(EYE_ALTITUDE, at.z / max(d, 1e-9), d, RADIUS);
  return GroundPlace(normalize(vec3(at.xy, RADIUS + EYE_ALTITUDE + at.z)), max(h, 0.0),
                     1e3 * d * ground_view.x,
                     vec3(dot(point, mesh_east.xyz), dot(point, mesh_north.xyz),
                          dot(point, mesh_up.xyz)));
}

// Of the sun on a level across its beams: what of the disk stands over the planet's horizon, over
// terrain and over the plane of the mesh there, through the air.
vec4 SunAcross(GroundPlace at, vec3 mesh_normal, float sun_x) {
  vec2 disk = DiskOverHorizon(clamp(dot(at.up, sun.xyz), -1.0, 1.0),
                              HorizonCosine(at.altitude, RADIUS), sun.w);
  float over_plane = dot(mesh_normal, sun.xyz) / sun.w;
  float seen = disk.x * SunlightOverEdge(min(sun_x, over_plane));
  return seen * TransmittanceToSun(at.altitude, disk.y);
}

// The normal that light falls on: with the relief that the mesh does not have, where there is any.
vec3 NormalInLight(vec3 offset, vec3 mesh_normal, float footprint) {
#if HAS_FINE_RELIEF
  return DetailedNormal(offset, mesh_normal, footprint);
#else
  return mesh_normal;
#endif
}

// The light of the sky on a surface that is tilted against that of the mesh: in an open place's
// ratio.
vec4 SkyOn(vec3 normal, vec3 mesh_normal, vec3 up, vec4 sky_irradiance) {
  vec3 tilt = normal - mesh_normal;
  vec4 open =
      sky_level + sky_up * dot(mesh_normal, up) + sky_sunward * dot(mesh_normal, sky_towards.xyz);
  vec4 gained = sky_up * dot(tilt, up) + sky_sunward * dot(tilt, sky_towards.xyz);
  return sky_irradiance * max(1.0 + gained / max(open, 0.1 * sky_level), 0.1);
}

// The terrain.
// @param point_m  from the eye; mesh_normal: unit, without finer relief; sun_x, sky_irradiance: of
//     LitVertex (lit_ground.h); to_eye: unit.
vec4 GroundRadiance(vec3 point_m, vec3 mesh_normal, float sun_x, vec4 sky_irradiance, vec3 to_eye) {
  GroundPlace at = GroundPlaceAt(point_m);
  vec4 sky_on_level = SkyOn(at.up, mesh_normal, at.up, sky_irradiance);
#if GROUND_COVER == WATER_COVER
  return WaterRadiance(at.up, at.offset, at.footprint, dot(mesh_normal, to_eye),
                       SunAcross(at, at.up, sun_x), sky_on_level, to_eye);
#else
  float altitude = 1e3 * at.altitude;
  float footprint = SeenFootprint(at.footprint, dot(mesh_normal, to_eye));
  vec3 normal = NormalInLight(at.offset, mesh_normal, footprint);
  vec4 draped = DrapeAt(at.offset, altitude, at.footprint);
  vec4 albedo = LandAlbedo(at.offset, altitude, TiltOf(mesh_normal, at.up), footprint, draped);
  vec4 radiance = CoverRadiance(albedo, normal, SunAcross(at, mesh_normal, sun_x),
                                SkyOn(normal, mesh_normal, at.up, sky_irradiance), to_eye);
#if HAS_SEA || HAS_LAND_COVER
  if (IsWater(altitude, draped))
    radiance = WaterRadiance(at.up, at.offset, at.footprint, dot(mesh_normal, to_eye),
                             SunAcross(at, at.up, sun_x), sky_on_level, to_eye);
#endif
  return radiance;
#endif
}

// An even planet of the medium's albedo, which is what the light of the sky has at its lower end.
vec4 EvenPlanetRadiance(GroundPlace at, vec4 across, vec4 sky_irradiance) {
  return (max(dot(at.up, sun.xyz), 0.0) * across + sky_irradiance) * ground_albedo / 3.14159265359;
}

vec4 PlanetAt(GroundPlace at, vec4 across, vec4 sky_irradiance, vec3 to_eye) {
#if PLANET_IS_WATER
  return WaterRadiance(at.up, at.offset, at.footprint, dot(at.up, to_eye), across, sky_irradiance,
                       to_eye);
#elif GROUND_COVER == MOUNTAIN_COVER && !PLANET_IS_LAND
  return EvenPlanetRadiance(at, across, sky_irradiance);
#elif GROUND_COVER == MOUNTAIN_COVER
  vec4 albedo = GroundAlbedo(at.offset, 0.0, TiltOf(at.up, at.up),
                             SeenFootprint(at.footprint, dot(at.up, to_eye)), vec4(0.0));
  return CoverRadiance(albedo, at.up, across, sky_irradiance, to_eye);
#else
  return CoverRadiance(cover_albedo, at.up, across, sky_irradiance, to_eye);
#endif
}

// The planet beyond the terrain: low land of the season, where there is any.
vec4 PlanetRadiance(vec3 point_m, vec3 to_eye) {
  GroundPlace at = GroundPlaceAt(point_m);
  return PlanetAt(at, SunAcross(at, at.up, 1e9), LevelSky(dot(at.up, sun.xyz)), to_eye);
}

// What it sends more than the even planet that the sky's table has.
vec4 PlanetBeyondEven(vec3 point_m, vec3 to_eye) {
  GroundPlace at = GroundPlaceAt(point_m);
  vec4 across = SunAcross(at, at.up, 1e9);
  vec4 sky = LevelSky(dot(at.up, sun.xyz));
  return PlanetAt(at, across, sky, to_eye) - EvenPlanetRadiance(at, across, sky);
}
