// SPDX-License-Identifier: MIT
// Vertices of land relative to the eye, morphed between their own level of detail and the next
// coarser one (see renderer/terrain/level_ranges.h). Defined before this text, because software drivers
// evaluate both sides of every branch (LandProgramKind of land_pass.h):
//   BENDS            refraction lifts land
//   MOONLIT          moonlight is an output
//   FADES            the old light has a weight; otherwise the new one has all of it
//   MOMENTARY_EDGES  horizon_sines have a weight
in vec3 position;  // [m]
in vec3 coarse_position;
in vec2 sample_place;
in vec4 normal;  // of any length; fourth: the level
in vec4 coarse_normal;
// ChunkLight of land_chunk.h, of the vertex's own level and of the coarser level.
in vec4 new_sky, new_coarse_sky;
in vec2 new_disk_over_edge;
#if MOONLIT
in vec4 new_moon_sky, new_coarse_moon_sky;
#endif
#if FADES
in vec4 sky, coarse_sky;
in vec2 disk_over_edge;
#endif
#if FADES && MOONLIT
in vec4 moon_sky, coarse_moon_sky;
#endif
out vec3 facing;  // normal, in the eye's frame: east, north, up
out vec4 sky_light;
#if MOONLIT
out vec4 moon_sky_light;
#endif
out float disk_height;
out float sunk;  // [km]; positive: hidden by the planet

vec3 InEyeFrame(vec3 v) { return vec3(dot(v, east.xyz), dot(v, north.xyz), dot(v, up.xyz)); }

// Returns the morph weight: 0 for the own level, 1 for the coarser level.
float Turned() {
  vec2 range = turning[int(normal.w)].xy;
  float turns = round((sample_place.x - eye_sample.x) / max(globe.w, 1.0));
  vec2 near = vec2(sample_place.x - globe.w * turns, sample_place.y);
  vec2 s = sin(0.5 * (near - eye_sample.xy) * eye_sample.zw);  // of half the angles
  float square = globe.z * globe.z * ChordSquare(s.x, s.y, globe.x, globe.y);
  float d = sqrt(square + eye_above.x * eye_above.x);
  return clamp((d - range.x) * range.y, 0.0, 1.0);
}

#if MOMENTARY_EDGES
// Sines of the horizon's elevation towards the current sun: HorizonTexture.
uniform sampler2D horizon_sines;

// Returns the elevation of the disk above that horizon, in its radii. Beyond the map no terrain
// hides it.
float DiskOverHorizonHere(vec3 at, vec3 from_eye) {
  vec2 place = vec2(dot(horizon_u, vec4(at, 1.0)), dot(horizon_v, vec4(at, 1.0)));
  if (any(lessThan(place, vec2(0.0))) || any(greaterThan(place, vec2(1.0)))) return 64.0;
  vec3 up_here = normalize(from_eye + vec3(0.0, 0.0, 1e3 * (PLANET_RADIUS + EYE_ALTITUDE)));
  return (asin(dot(up_here, sun.xyz)) - asin(textureLod(horizon_sines, place, 0.0).x)) / sun.w;
}
#endif

// Returns how far the ray to a place beyond the horizon dips below all land, which is half a
// kilometre under the sphere.
// @param from_eye  apparent position.
float SunkBehindPlanet(vec3 from_eye) {
  const float deepest_km = -0.5;
  float d = 1e-3 * length(from_eye);
  float mu = from_eye.z / max(length(from_eye), 1e-6);
  bool beyond = PLANET_RADIUS > 0.0 && mu < 0.0 && d > -(LOOK_RADIUS + EYE_ALTITUDE) * mu;
  return beyond ? deepest_km - PerigeeAltitude(EYE_ALTITUDE, mu, LOOK_RADIUS) : -1.0;
}

void main() {
  const float nearest = 0.1;  // m
  float turned = Turned();
  // At weight 1 the coarse position is used exactly, so that adjacent chunks share vertices.
  vec3 at = turned == 1.0 ? coarse_position : mix(position, coarse_position, turned);
  vec3 from_eye = InEyeFrame((at - eye_high.xyz) - eye_low.xyz);
  facing = InEyeFrame(mix(normal.xyz, coarse_normal.xyz, turned));
  sky_light = mix(new_sky, new_coarse_sky, turned);
  disk_height = mix(new_disk_over_edge.x, new_disk_over_edge.y, turned) + risen.y;
#if MOONLIT
  moon_sky_light = mix(new_moon_sky, new_coarse_moon_sky, turned);
#endif
#if FADES
  sky_light = mix(mix(sky, coarse_sky, turned), sky_light, eye_above.y);
  disk_height = mix(mix(disk_over_edge.x, disk_over_edge.y, turned) + risen.x, disk_height,
                    eye_above.y);
#endif
#if FADES && MOONLIT
  moon_sky_light = mix(mix(moon_sky, coarse_moon_sky, turned), moon_sky_light, eye_above.y);
#endif
#if MOMENTARY_EDGES
  disk_height = mix(disk_height, DiskOverHorizonHere(at, from_eye), eye_above.w);
#endif
#if BENDS
  vec3 from_eye_seen = SeenAt(from_eye);
#else
  vec3 from_eye_seen = from_eye;
#endif
  sunk = SunkBehindPlanet(from_eye_seen);
  float along_view = dot(from_eye_seen, view_forward.xyz);
  float width = dot(view_right.xyz, view_right.xyz);
  float height = dot(view_up.xyz, view_up.xyz);
  // The near plane is the only plane that clips. With reversed depth z is nearest / w; otherwise
  // the fragment stage writes the depth.
  float z = eye_above.z > 0.0 ? nearest : along_view - 2.0 * nearest;
  vec2 seen = vec2(dot(from_eye_seen, view_right.xyz) / width,
                   dot(from_eye_seen, view_up.xyz) / height);
  gl_Position = vec4(seen - PICTURE_SHIFT * along_view, z, along_view);
}
