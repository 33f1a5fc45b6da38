// SPDX-License-Identifier: MIT
// Clouds in the colours of their light, behind the air in front of them, as LitClouds of the renderer
// has them: what they leave of the light behind, and what they add to it. Defined before this text:
// CLOUD_LAYERS.
//
// Layers are screens at the mean distance of their light. With the light L of what is behind a screen
// at the distance d, the air A(d) in front of it, its transmittance a(d), and the screen's T and C,
//
//   L <- T L + (1 - T) A(d) + a(d) C
//
// for all screens from the farthest to the nearest. Clouds also dim the beam in the air, and change
// the light that it scatters more than once, below, between and above the layers (their interfaces).
layout(location = 0) out vec4 clouds;  // added [cd/m^2, linear sRGB]; transmittance
layout(location = 1) out vec4 beam;    // transmittance without scattered light; binary logarithm of
                                       // the length of the ray [km]

uniform sampler2D layer_light_0, layer_light_1, layer_light_2, layer_light_3;  // of march.frag.glsl

// The air up to the places where a ray leaves an interface.
struct InterfaceAir {
  float distance_km[CLOUD_LAYERS];  // in order; 1e6: the ray stays in it
  vec4 single[CLOUD_LAYERS], diffuse[CLOUD_LAYERS];
  int number[CLOUD_LAYERS + 1];  // of the interface before each of them, and behind the last
  vec4 diffuse_factor[CLOUD_LAYERS + 1];  // there
};

// Returns the factor on light that air at an interface scatters more than once along a ray.
vec4 DiffuseTowards(int number, vec3 direction) {
  float root = sign(direction.z) * sqrt(abs(direction.z));
  float across = length(direction.xy) * length(sun.xy);
  float cosine = across > 1e-6 ? dot(direction.xy, sun.xy) / across : 1.0;
  float row = (0.5 + 0.5 * root) * float(DIFFUSE_ELEVATIONS - 1);
  float column = acos(clamp(cosine, -1.0, 1.0)) / 3.14159265 * float(DIFFUSE_AZIMUTHS - 1);
  int y = min(int(row), DIFFUSE_ELEVATIONS - 2), x = min(int(column), DIFFUSE_AZIMUTHS - 2);
  int at = (number * DIFFUSE_ELEVATIONS + y) * DIFFUSE_AZIMUTHS + x;
  float share = column - float(x);
  vec4 low = mix(cloud_diffuse_towards[at], cloud_diffuse_towards[at + 1], share);
  at += DIFFUSE_AZIMUTHS;
  vec4 high = mix(cloud_diffuse_towards[at], cloud_diffuse_towards[at + 1], share);
  return mix(low, high, row - float(y));
}

// Returns the factor on single scattering, and on other light in the air.
vec4 AirFactor(InterfaceAir of, int stretch, AirTo air) {
  return cloud_interface[of.number[stretch]].y * air.single +
         of.diffuse_factor[stretch] * air.diffuse;
}

InterfaceAir InterfacesOn(vec3 direction) {
  InterfaceAir of;
  float h = EYE_ALTITUDE, mu = direction.z;
  int here = CloudInterfaceAt(1e3 * h);
  of.number[0] = here;
  of.diffuse_factor[0] = DiffuseTowards(here, direction);
  bool rises = mu >= 0.0;
  for (int i = 0; i < CLOUD_LAYERS; ++i) {
    // The interface that is entered, and the altitude between both.
    int next = rises ? of.number[i] + 1 : of.number[i] - 1;
    bool is_there = rises ? next <= CLOUD_LAYERS : next >= 0;
    float z = 1e-3 * cloud_interface[clamp(rises ? next : next + 1, 0, CLOUD_LAYERS)].x;
    is_there = is_there && (rises || PerigeeAltitude(h, mu, PLANET_RADIUS) < z);
    float d = rises ? DistanceUpTo(h, mu, z, PLANET_RADIUS)
                    : DistanceDownTo(h, mu, z, PLANET_RADIUS);
    of.distance_km[i] = is_there ? d : 1e6;
    of.number[i + 1] = is_there ? next : of.number[i];
    of.diffuse_factor[i + 1] = DiffuseTowards(of.number[i + 1], direction);
    AirTo air = AirToPoint(direction, min(of.distance_km[i], kToSpace_km));
    of.single[i] = air.single;
    of.diffuse[i] = air.diffuse;
  }
  return of;
}

// Returns the light of the air between the eye and a distance behind clouds' shadows.
vec4 AirInShadow(InterfaceAir of, float distance_km, AirTo air) {
  vec4 sum = vec4(0.0);
  int last = 0;
  for (int i = 0; i < CLOUD_LAYERS; ++i) {
    if (of.distance_km[i] >= distance_km) continue;
    AirTo upto = AirTo(of.single[i], of.diffuse[i], vec4(1.0));
    sum += AirFactor(of, i, upto) - AirFactor(of, i + 1, upto);
    last = i + 1;
  }
  return sum + AirFactor(of, last, air);
}

// Returns the light of the air on a ray to space behind clouds' shadows.
// @param inside  up to the end of the tables. Behind it, air scatters light once and more often in the
//     same proportion.
vec4 AirToSpace(InterfaceAir of, vec3 direction, AirTo inside) {
  vec4 both = inside.single + inside.diffuse;
  vec4 share = inside.diffuse / max(both, vec4(1e-20));
  vec4 behind = max(SkyRadiance(direction) - both, vec4(0.0));
  AirTo rest = AirTo((1.0 - share) * behind, share * behind, vec4(1.0));
  return AirInShadow(of, kToSpace_km, inside) + AirFactor(of, CLOUD_LAYERS, rest) - behind;
}

// Returns the light of the beam, the sky and the ground that a screen scatters to the eye.
vec4 ScreenLight(int layer, vec4 gathered, vec3 direction, float distance_km) {
  float altitude = AltitudeAlongRay(EYE_ALTITUDE, direction.z, distance_km, PLANET_RADIUS);
  vec3 point = 1e3 * distance_km * direction;
  vec3 up = normalize(vec3(point.xy, 1e3 * (PLANET_RADIUS + EYE_ALTITUDE) + point.z));
  vec2 disk = DiskOverHorizon(clamp(dot(up, sun.xyz), -1.0, 1.0), HorizonCosine(altitude, PLANET_RADIUS), sun.w);
  vec3 place = InCloudFrame(point, altitude);
  float past = 1.0;
  for (int i = 0; i < CLOUD_LAYERS; ++i)
    past *= i == layer ? 1.0 : LeftByLayer(cloud_sun_map, i, place);
  vec4 from_beam = past * disk.x * BeamOfSun(altitude, disk.y);
  vec2 range = 1e-3 * cloud_range[layer].xy;
  float share = clamp((altitude - range.x) / (range.y - range.x), 0.0, 1.0);
  float ground = max(1.0 - gathered.z - gathered.y, 0.0);
  return gathered.x * from_beam +
         gathered.y * mix(cloud_sky_low[layer], cloud_sky_high[layer], share) +
         ground * mix(cloud_ground_low[layer], cloud_ground_high[layer], share);
}

vec4 Gathered(int layer, ivec2 texel) {
  vec4 of = texelFetch(layer_light_0, texel, 0);
#if CLOUD_LAYERS > 1
  of = layer == 1 ? texelFetch(layer_light_1, texel, 0) : of;
#endif
#if CLOUD_LAYERS > 2
  of = layer == 2 ? texelFetch(layer_light_2, texel, 0) : of;
#endif
#if CLOUD_LAYERS > 3
  of = layer == 3 ? texelFetch(layer_light_3, texel, 0) : of;
#endif
  return of;
}

// The screens on a ray, from the farthest to the nearest.
struct CloudScreens {
  int count;
  int layer[CLOUD_LAYERS];
  vec4 gathered[CLOUD_LAYERS];
  float distance_km[CLOUD_LAYERS];
};

CloudScreens ScreensOn(ivec2 texel) {
  vec4 gathered[CLOUD_LAYERS];
  float distance_km[CLOUD_LAYERS];
  for (int i = 0; i < CLOUD_LAYERS; ++i) {
    gathered[i] = Gathered(i, texel);
    float taken = 1.0 - gathered[i].z;
    distance_km[i] = taken > 1e-5 ? gathered[i].w / taken : 0.0;
  }
  CloudScreens screens;
  screens.count = 0;
  float before_km = 1e9;
  for (int n = 0; n < CLOUD_LAYERS; ++n) {
    int layer = -1;
    float d = 0.0;
    for (int i = 0; i < CLOUD_LAYERS; ++i) {
      bool is_next = distance_km[i] < before_km && distance_km[i] > d;
      layer = is_next ? i : layer;
      d = is_next ? distance_km[i] : d;
    }
    screens.layer[n] = max(layer, 0);
    screens.distance_km[n] = d;
    screens.gathered[n] = layer < 0 ? vec4(0.0, 0.0, 1.0, 0.0) : gathered[max(layer, 0)];
    screens.count += layer < 0 ? 0 : 1;
    before_km = d;
  }
  return screens;
}

// Returns the light that clouds and their shadows add to a ray lit by the current light.
// @param is_key  whether it lights the clouds, too.
vec4 AddedOn(vec3 direction, float length_km, CloudScreens screens, bool is_key) {
  InterfaceAir interfaces = InterfacesOn(direction);
  AirTo whole = AirToPoint(direction, min(length_km, kToSpace_km));
  vec4 added = (length_km < kToSpace_km ? AirInShadow(interfaces, length_km, whole)
                                        : AirToSpace(interfaces, direction, whole)) -
               (whole.single + whole.diffuse);
  for (int n = 0; n < CLOUD_LAYERS; ++n) {
    if (n >= screens.count) break;
    vec4 of = screens.gathered[n];
    AirTo air = AirToPoint(direction, screens.distance_km[n]);
    added = of.z * added + (1.0 - of.z) * AirInShadow(interfaces, screens.distance_km[n], air);
    if (is_key)
      added += air.transmittance *
               ScreenLight(screens.layer[n], of, direction, screens.distance_km[n]);
  }
  return sun_irradiance * added;
}

void main() {
  CloudMapRay ray = RayOfTexel(ivec2(gl_FragCoord.xy));
  CloudScreens screens = ScreensOn(ivec2(gl_FragCoord.xy));
  vec4 added = AddedOn(ray.direction, ray.length_km, screens, true);
#ifdef TWO_LIGHTS
  of_other = true;
  added += AddedOn(ray.direction, ray.length_km, screens, false);
#endif
  float left = 1.0, unscattered = 1.0;
  for (int n = 0; n < CLOUD_LAYERS; ++n) {
    left *= screens.gathered[n].z;
    unscattered *= pow(screens.gathered[n].z, 1.0 / cloud_shear[screens.layer[n]].z);
  }
  clouds = vec4(LinearSrgb(added), left);
  beam = vec4(unscattered, log2(ray.length_km), 0.0, 0.0);
}
