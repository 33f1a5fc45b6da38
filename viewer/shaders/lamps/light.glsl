// SPDX-License-Identifier: MIT
// Light of lamps: LampsBlock of lamps_block.h. Frame: east, north, up at the eye, which is the
// origin. Lengths are in metres. One band per component.
//
// Scattered light in the air, with the scattering angle a, the point t_c of the ray nearest to the
// lamp and its distance D (atmosphere/lamp/airlight.h):
//
//   L = I / D  integral of  sum over layers sigma rho p(cos a)  share  T  da,   t = t_c - D cot a
//
// The integral uses Gauss-Legendre nodes in the logarithm of a, in which forward peaks of any width
// are as smooth as the rest. The air of a lamp is layered over the plane that touches the sphere
// between the lamp and the eye.

struct Lamp {
  vec4 position;   // of its centre; radius within which the air scatters as at the lamp
  vec4 intensity;  // in its brightest direction [W sr^-1 nm^-1]
  vec4 axis;       // unit vector; kind of its profile
  vec4 side;       // unit vector; layer of its table
  vec4 profile;    // cosines of the inner and outer angle of a cone; distance;
                   // fourth: 1 if the eye is inside the lamp
  vec4 up;         // vertical of its air; altitude of the eye
  vec4 at_eye;     // densities of molecules, aerosol, layer; altitude of the lamp
  vec4 at_lamp;    // densities at the lamp; its own radius
  vec4 glow;       // mean of its profile; layer of glow_map; size of its core, 0: none
  vec4 shade;      // layer of lamp_shades, -1: none; first layer and number of levels in
                   // lamp_plans; altitude of the lamp over the sphere
};

layout(std140) uniform Lamps {
  vec4 lamp_count;      // number of lamps; angles at which cores start to fade and end [rad];
                        // number of isotropic lamps, which come first
  vec4 lamp_planet;     // radius; altitude of the eye [km]; pixels between rays of the lattice
  vec4 lamp_falls;      // inverse scale heights of molecules, aerosol, layer [1/m]
  vec4 lamp_bases;      // altitudes at which the densities are 1 [m]
  vec4 lamp_molecules;  // scattering at density 1 [1/m]
  vec4 lamp_aerosol;    // scattering
  vec4 lamp_dimming;    // extinction of aerosol
  vec4 lamp_layer;        // scattering and extinction of the layer
  vec4 lamp_mie_phase;  // g, g of the second lobe, its weight, alpha
  vec4 lamp_layer_phase;
  vec4 lamp_red;  // rows of the matrix to linear sRGB [cd m^-2 per W m^-2 sr^-1 nm^-1]
  vec4 lamp_green;
  vec4 lamp_blue;
  vec4 lamp_ground[3];  // east, north and up of the terrain's frame
  Lamp lamps[LAMP_MOST];
};

uniform vec2 lamp_gauss[LAMP_NODES];  // nodes in [0, 1] and weights
#ifdef LAMP_TABLES
uniform sampler2DArray lamp_tables;  // relative intensity by angle from the axis and around it
#endif
#ifdef LAMP_GLOW_MAP
uniform sampler2DArray lamp_airlight_map;  // irradiance by the air around a lamp; see sampled_glow.h
#endif
#ifdef LAMP_SHADE
uniform sampler2DArray lamp_shades;  // slope above which a lamp is visible, by azimuth and distance
uniform sampler2DArray lamp_plans;   // distance of the ground from the shadow edge; see LampShadowField
#endif
#ifdef LAMP_MIE_TABLE
uniform sampler2D lamp_mie_table;  // over (a / pi)^(1/3)
#endif

vec3 LampRgb(vec4 radiance) {
  return vec3(dot(lamp_red, radiance), dot(lamp_green, radiance), dot(lamp_blue, radiance));
}

float LampPhaseMie(float cosine, float angle) {
#ifdef LAMP_MIE_TABLE
  float unit = pow(max(angle, 1e-12) * 0.318309886, 0.333333333);
  float size = float(textureSize(lamp_mie_table, 0).x);
  return textureLod(lamp_mie_table, vec2(TexelFromUnit(unit, size), 0.5), 0.0).x;
#else
  return LAMP_PHASE_MIE(cosine, lamp_mie_phase);
#endif
}

// Returns the logarithms of the densities at an altitude over the plane of a lamp.
vec3 LampLogDensities(float z) {
  vec3 log_density = vec3(LayerLogDensity(z - lamp_bases.x, lamp_falls.x),
                          LayerLogDensity(z - lamp_bases.y, lamp_falls.y), 0.0);
#ifdef LAMP_LAYER
  log_density.z = LayerLogDensity(z - lamp_bases.z, lamp_falls.z);
#endif
  return log_density;
}

// Returns the columns between two points, from their densities and the logarithms of these.
vec3 LampColumns(float span, vec3 log_from, vec3 from, vec3 log_to, vec3 to) {
  vec3 rises = log_from - log_to;
  vec3 columns = vec3(LampColumn(span, from.x, to.x, rises.x),
                      LampColumn(span, from.y, to.y, rises.y), 0.0);
#ifdef LAMP_LAYER
  columns.z = LampColumn(span, from.z, to.z, rises.z);
#endif
  return columns;
}

// Returns the optical depth, at most a value of negligible transmittance. The depths of a wall of
// a layer would overflow, and their differences would be NaN.
vec4 LampDepth(vec3 columns) {
  vec4 depth = lamp_molecules * columns.x + lamp_dimming * columns.y;
#ifdef LAMP_LAYER
  depth += lamp_layer.y * columns.z;
#endif
  return min(depth, vec4(1e4));
}

// Returns exp(-depth), for bands that differ little: exp of the second band times a power series.
// The error is delta^3 / 96 in a band that is deeper by delta.
vec4 LampLeft(vec4 depth) {
  vec4 quarter = 0.25 * (depth - depth.y);
  vec4 rest = 1.0 - quarter * (1.0 - 0.5 * quarter);
  rest *= rest;
  return exp(-depth.y) * rest * rest;
}

// Returns the fraction of the intensity in a direction, given by its cosines to axis, side and side
// x axis.
float LampShare(Lamp lamp, vec3 cosines) {
  int kind = int(lamp.axis.w + 0.5);
  float share = 1.0;
  if (kind == LAMP_CONE) share = SpotShare(cosines.x, lamp.profile.x, lamp.profile.y);
#ifdef LAMP_TABLES
  if (kind == LAMP_TABLE) {
    float gamma = atan(length(cosines.yz), cosines.x) * 0.318309886;
    float around = atan(cosines.z, cosines.y) * 0.159154943;
    vec2 size = vec2(textureSize(lamp_tables, 0).xy);
    share =
        textureLod(lamp_tables,
                   vec3(TexelFromUnit(gamma, size.x),
                        TexelFromUnit(around < 0.0 ? around + 1.0 : around, size.y), lamp.side.w),
                   0.0)
            .x;
  }
#endif
  return share;
}

vec3 LampCosines(Lamp lamp, vec3 direction) {
  return vec3(dot(direction, lamp.axis.xyz), dot(direction, lamp.side.xyz),
              dot(direction, cross(lamp.side.xyz, lamp.axis.xyz)));
}

// Returns a vector in the frame of the terrain.
vec3 LampOfTerrain(vec3 way) {
  return vec3(dot(way, lamp_ground[0].xyz), dot(way, lamp_ground[1].xyz),
              dot(way, lamp_ground[2].xyz));
}

// Returns the height of a point at `way` from the lamp above the shadow of the bare planet, in two
// thousandths of its distance, plus 0.5: half of the light reaches the edge of the shadow, which
// begins at the horizon of the lamp.
float LampOverHorizon(Lamp lamp, vec3 way) {
  float far = length(way);
  float diameter = 2e3 * lamp_planet.x;
  float beyond = far - sqrt(diameter * max(lamp.shade.w, 0.0));
  if (beyond <= 0.0) return 1.0;
  vec3 at = lamp.position.xyz + way;
  float altitude = 1e3 * lamp_planet.y + at.z + dot(at.xy, at.xy) / diameter;
  return 0.5 + (altitude - beyond * beyond / diameter) / (2e-3 * max(far, 1e-3));
}

// Returns the height of a point at `way` from the lamp above the shadow of terrain, in two
// thousandths of its distance, plus `margin`: half of the light reaches a point at 0.5. The terrain
// up to a number of rings nearer is considered.
float LampClearance(Lamp lamp, vec3 way, float rings_nearer, float margin) {
#ifdef LAMP_SHADE
  if (lamp.shade.x < -0.5) return LampOverHorizon(lamp, way);
  vec3 at = LampOfTerrain(way);
  float far = max(length(at.xy), LAMP_SHADE_NEAREST);
  vec2 size = vec2(textureSize(lamp_shades, 0).xy);
  float ring = LampAirlightUnit(far, LAMP_SHADE_NEAREST, LAMP_SHADE_FARTHEST) -
               rings_nearer / (size.y - 1.0);
  float turn = atan(at.y, at.x) * 0.159154943 + 0.5 / size.x;
  float slope =
      textureLod(lamp_shades, vec3(turn, TexelFromUnit(ring, size.y), lamp.shade.x), 0.0).x;
  return margin + (at.z - slope * far) / (2e-3 * max(length(at), 1e-3));
#else
  return LampOverHorizon(lamp, way);
#endif
}

// Returns the clearance of a point in the air. Rings are interpolated: half a ring nearer, the
// terrain up to the point is considered on average.
float LampClearanceInAir(Lamp lamp, vec3 way) { return LampClearance(lamp, way, 0.5, 0.5); }

// Returns the fraction of a lamp's light that terrain and the planet let through to the ground. The
// terrain around the point is left out, and the margin is larger, so that ground does not shadow
// itself.
float LampLit(Lamp lamp, vec3 way) { return clamp(LampClearance(lamp, way, 1.0, 1.0), 0.0, 1.0); }

// Returns this fraction for ground, from its distance to the shadow edge, which is blurred to the
// width of a ray.
float LampLitGround(Lamp lamp, vec3 way, float ray_width_m) {
#ifdef LAMP_SHADE
  vec2 at = LampOfTerrain(way).xy;
  float far = max(max(abs(at.x), abs(at.y)) / LAMP_PLAN_REACH, 1.0);
  float level = ceil(log2(far));
  if (level >= lamp.shade.z) return LampLit(lamp, way);
  float step_m = LAMP_PLAN_STEP * exp2(level);
  vec2 place = (at / step_m + 0.5) / vec2(textureSize(lamp_plans, 0).xy) + 0.5;
  float texel = textureLod(lamp_plans, vec3(place, lamp.shade.y + level), 0.0).x;
  float over_edge = step_m * LAMP_PLAN_RANGE * (255.0 * texel - 128.0) / 127.0;
  return clamp(0.5 + over_edge / ray_width_m, 0.0, 1.0);
#else
  return LampLit(lamp, way);
#endif
}

// Returns the mean of LampLit between two points, assuming that the clearance is linear.
float LampLitBetween(float here, float there) {
  vec2 ends = vec2(here, there);
  vec2 over = clamp(ends, 0.0, 1.0);
  vec2 sums = 0.5 * over * over + max(ends - 1.0, 0.0);
  float apart = here - there;
  return abs(apart) < 1e-3 ? over.x : (sums.x - sums.y) / apart;
}

// Returns the range of scattering angles over which a spot lights the ray; x > y if there is none.
// The cosine to its axis is a cos(angle - middle) along the ray.
vec2 LampBeam(Lamp lamp, float along, float across, vec2 angles) {
  int kind = int(lamp.axis.w + 0.5);
  float edge = kind == LAMP_CONE ? lamp.profile.y : -1.0;
  if (edge < 0.0) return angles;
  float a = length(vec2(along, across));
  float half_angle = acos(clamp(edge / max(a, 1e-6), -1.0, 1.0));
  float middle = atan(along, across) + 1.57079633;
  if (middle - half_angle > 3.14159265) middle -= 6.28318531;
  if (middle + half_angle < 0.0) middle += 6.28318531;
  return vec2(max(angles.x, middle - half_angle),
              a > edge ? min(angles.y, middle + half_angle) : -1.0);
}

// Returns the light that the air in front of a distance scatters from one lamp into the eye.
// @param shaped  a constant: whether the lamp may be anisotropic or contain the eye.
vec4 GlowOfLamp(Lamp lamp, vec3 direction, float distance_m, bool shaped) {
  float nearest = dot(lamp.position.xyz, direction);
  vec3 off = nearest * direction - lamp.position.xyz;
  float from_ray = length(off);
  float approach = max(from_ray, lamp.position.w);
  float reach = min(distance_m, 4.0 * lamp.profile.z + 20e3);
  vec2 angles = vec2(atan(approach, nearest), atan(approach, nearest - reach));
  vec3 along = LampCosines(lamp, direction);
  vec3 across = LampCosines(lamp, off / max(from_ray, 1e-9));
  bool inside = shaped && lamp.profile.w > 0.5;
  float share = 1.0;
  if (inside) {
    share = LampShare(lamp, along);
  } else if (shaped) {
    angles = LampBeam(lamp, along.x, across.x, angles);
  }
  float low = log(angles.x);
  float span = log(max(angles.y, 1e-9)) - low;
  float slope = dot(lamp.up.xyz, direction);
  vec3 log_eye = LampLogDensities(lamp.up.w);
  vec3 log_lamp = LampLogDensities(lamp.at_eye.w);
  vec4 sum = vec4(0.0);
  vec4 light_before = vec4(0.0);
  float clear_before = 0.0;
  for (int i = 0; i < LAMP_NODES; ++i) {
    float angle = exp(low + span * lamp_gauss[i].x);
    float fold = min(angle, 3.14159265 - angle);
    float square = fold * fold;
    float sine =
        fold * (1.0 - square * (0.166666667 -
                                square * (8.33333333e-3 -
                                          square * (1.98412698e-4 - square * 2.7557319e-6))));
    sine = clamp(sine, 1e-7, 1.0);
    float cosine = sqrt((1.0 - sine) * (1.0 + sine)) * (angle > 1.57079633 ? -1.0 : 1.0);
    float away = approach / sine;
    float t = clamp(nearest - away * cosine, 0.0, reach);
    float z = lamp.up.w + slope * t;
    vec3 log_density = LampLogDensities(z);
    vec3 density = exp(log_density);
    vec3 columns = LampColumns(t, log_eye, lamp.at_eye.xyz, log_density, density) +
                   LampColumns(away, log_lamp, lamp.at_lamp.xyz, log_density, density);
    vec4 source = lamp_molecules * (density.x * PhaseRayleigh(cosine)) +
                  lamp_aerosol * (density.y * LampPhaseMie(cosine, angle));
#ifdef LAMP_LAYER
    source += lamp_layer.x * density.z * LAMP_PHASE_LAYER(cosine, lamp_layer_phase);
#endif
    float weight = lamp_gauss[i].y * angle;
    if (shaped && !inside) weight *= LampShare(lamp, sine * across - cosine * along);
    vec4 light = (weight * source) * LampLeft(LampDepth(columns));
    // A node represents half the distance to its neighbours, of which the shadow edge may cut a
    // part. The light is then continuous when the edge passes a node.
    float clear = LampClearanceInAir(lamp, t * direction - lamp.position.xyz);
    float middle = 0.5 * (clear_before + clear);
    sum += 0.5 * (i == 0 ? LampLitBetween(clear, clear) * light
                         : LampLitBetween(clear_before, middle) * light_before +
                               LampLitBetween(clear, middle) * light);
    light_before = light;
    clear_before = clear;
  }
  sum += 0.5 * LampLitBetween(clear_before, clear_before) * light_before;
  return lamp.intensity * (sum * (max(span, 0.0) * share / approach));
}

// Returns 1 in the core of a lamp's scattered light in the picture, 0 outside it.
float LampCore(Lamp lamp, vec3 direction) {
  float apart = length(direction - lamp.position.xyz / lamp.profile.z) / max(lamp.glow.z, 1e-9);
  float fade = clamp((lamp_count.z - apart) / (lamp_count.z - lamp_count.y), 0.0, 1.0);
  return fade * fade * fade * (10.0 - fade * (15.0 - 6.0 * fade));
}

// Returns the radiance of the inside of the luminous sphere, for a lamp that contains the eye.
vec4 LampFromWithin(Lamp lamp, vec3 direction) {
  if (lamp.profile.w < 0.5) return vec4(0.0);
  float radius = lamp.at_lamp.w;
  return lamp.intensity *
         (LampShare(lamp, LampCosines(lamp, -direction)) / (3.14159265 * radius * radius));
}

// Returns the light of all lamps scattered into the eye in front of a distance [W m^-2 sr^-1
// nm^-1].
// @param with_cores  1: all of it; 0: without the part that lamps/core.frag.glsl draws.
vec4 LampAirlightIn(vec3 direction, float distance_m, float with_cores) {
  vec4 sum = vec4(0.0);
  int even = int(lamp_count.w + 0.5);
  for (int i = 0; i < even; ++i) {
    float part = 1.0 - (1.0 - with_cores) * LampCore(lamps[i], direction);
    sum += part * GlowOfLamp(lamps[i], direction, distance_m, false);
  }
  int count = int(lamp_count.x + 0.5);
  for (int i = even; i < count; ++i) {
    float part = 1.0 - (1.0 - with_cores) * LampCore(lamps[i], direction);
    sum += part * GlowOfLamp(lamps[i], direction, distance_m, true) +
           LampFromWithin(lamps[i], direction);
  }
  return sum;
}

#ifdef LAMP_GLOW_MAP
// Returns a term of the glow map of a lamp; `at` counts texels of one term.
vec4 LampAirlightTerm(Lamp lamp, vec2 at, float term) {
  vec2 size = vec2(textureSize(lamp_airlight_map, 0).xy);
  vec2 place = (at + vec2(0.0, term * size.y / float(LAMP_AIRLIGHT_TERMS))) / size;
  return textureLod(lamp_airlight_map, vec3(place, lamp.glow.y), 0.0);
}

// Returns the logarithm of the light on level ground times the distance.
vec4 LampAirlightOnLevel(Lamp lamp, vec2 at, float distance_m) {
  vec4 level = LampAirlightTerm(lamp, at, 0.0);
  if (distance_m <= LAMP_GLOW_FARTHEST) return level;
  float texels = float(textureSize(lamp_airlight_map, 0).x);
  float before_m = LampAirlightDistance((texels - 2.0) / (texels - 1.0), LAMP_GLOW_NEAREST,
                                        LAMP_GLOW_FARTHEST);
  vec4 before = LampAirlightTerm(lamp, at - vec2(1.0, 0.0), 0.0);
  float steps = (distance_m - LAMP_GLOW_FARTHEST) / (LAMP_GLOW_FARTHEST - before_m);
  for (int band = 0; band < 4; ++band)
    level[band] = LampAirlightBeyond(level[band], before[band], steps);
  return level;
}

// Returns the irradiance of a surface by the air that a lamp lights; see sampled_glow.h.
vec4 LampAirOnSurface(Lamp lamp, vec3 point_m, vec3 towards, float distance_m, vec3 normal) {
  vec3 vertical = normalize(point_m + vec3(0.0, 0.0, 1e3 * (lamp_planet.x + lamp_planet.y)));
  float sine = dot(towards, vertical);
  float up = dot(normal, vertical);
  float rise = LampRise(sine, distance_m / (2e3 * lamp_planet.x));
  vec2 size = vec2(textureSize(lamp_airlight_map, 0).xy) / vec2(1.0, LAMP_AIRLIGHT_TERMS);
  float far = max(distance_m, LAMP_GLOW_NEAREST);
  vec2 unit = vec2(min(LampAirlightUnit(far, LAMP_GLOW_NEAREST, LAMP_GLOW_FARTHEST), 1.0),
                   LampRiseUnit(rise));
  vec2 at = vec2(TexelFromUnit(unit.x, size.x), TexelFromUnit(unit.y, size.y)) * size;
  vec4 level = exp(LampAirlightOnLevel(lamp, at, far)) / far;
#ifdef LAMP_GLOW_OF_SLOPES
  vec3 flat_way = towards - sine * vertical;
  float tilt = dot(normal, flat_way) / max(length(flat_way), 1e-6);
  vec4 steep = LampAirlightTerm(lamp, at, 1.0);
  vec4 facing = LampAirlightTerm(lamp, at, 2.0), facing_twice = LampAirlightTerm(lamp, at, 3.0);
  vec4 turned = LampAirlightTerm(lamp, at, 4.0), turned_twice = LampAirlightTerm(lamp, at, 5.0);
  for (int band = 0; band < 4; ++band) {
    level[band] *= LampAirlightOnSlope(tilt, up, steep[band], facing[band], facing_twice[band],
                                   turned[band], turned_twice[band]);
  }
  return level;
#else
  return level * max(up, 0.0);
#endif
}
#endif

// Returns the irradiance of a surface by one lamp.
// @param shaped  as in GlowOfLamp.
vec4 LampOnGround(Lamp lamp, vec3 point_m, vec3 normal, float ray_width_m, bool shaped) {
  vec3 way = lamp.position.xyz - point_m;
  float far = max(length(way), lamp.at_lamp.w);
  vec3 towards = way / far;
  float z = lamp.up.w + dot(lamp.up.xyz, point_m);
  vec3 log_density = LampLogDensities(z);
  vec3 columns = LampColumns(far, LampLogDensities(lamp.at_eye.w), lamp.at_lamp.xyz, log_density,
                             exp(log_density));
  float facing = max(dot(normal, towards), 0.0) / (far * far);
  if (shaped) facing *= LampShare(lamp, LampCosines(lamp, -towards));
  facing *= LampLitGround(lamp, -way, ray_width_m);
  vec4 light = facing * LampLeft(LampDepth(columns));
#ifdef LAMP_GLOW_MAP
  light += lamp.glow.x * LampAirOnSurface(lamp, point_m, towards, far, normal);
#endif
  return lamp.intensity * light;
}

// Returns the irradiance of a surface by all lamps [W m^-2 nm^-1].
// @param point_m  from the eye.
// @param normal  unit.
// @param ray_width_m  of the ray that ends there.
vec4 LampsOnGround(vec3 point_m, vec3 normal, float ray_width_m) {
  vec4 sum = vec4(0.0);
  int even = int(lamp_count.w + 0.5);
  for (int i = 0; i < even; ++i) sum += LampOnGround(lamps[i], point_m, normal, ray_width_m, false);
  int count = int(lamp_count.x + 0.5);
  for (int i = even; i < count; ++i)
    sum += LampOnGround(lamps[i], point_m, normal, ray_width_m, true);
  return sum;
}
