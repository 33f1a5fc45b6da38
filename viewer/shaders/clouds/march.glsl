// SPDX-License-Identifier: MIT
// Light that one layer of clouds scatters into a ray, as in CloudGather of the renderer, from the
// textures of cloud_texels.h. Defined before this text: CLOUD_STEPS, the most steps of a ray, and
// CLOUD_SUN_STEPS, the number of samples of the shape towards the sun.

uniform isampler3D cloud_bricks;     // tile of the atlas: 10 bits along each axis; or minus the distance
                                     // to the nearest brick with values [bricks]
uniform sampler3D cloud_depth;       // atlas of 9 x 9 x 9 corners per slot
uniform sampler2D cloud_extinction;  // [1/km], by depth and altitude
uniform sampler3D cloud_sun_source, cloud_sky_source;  // four components per cell
uniform sampler2D cloud_basis;       // their functions of the direction: sun, then sky
uniform sampler2D cloud_peak;        // p_eff
uniform sampler3D cloud_light;       // transmittance to the light

uniform int layer_number;   // in the block Clouds
uniform vec4 layer_shape;   // voxels per metre; altitude of the lowest brick [m]; metres per brick;
                            // cells along z
uniform vec3 layer_cells;   // of light: base over the lowest brick [m], inverse height of all [1/m];
                            // scaled albedo w'
uniform vec3 layer_texel;   // of the atlas: inverse sides
uniform vec3 layer_voxels;  // of a period
uniform vec2 layer_periods_per_voxel;
uniform vec3 beam_towards;  // unit vector to the light of the solution, in the frame of the clouds
uniform float layer_factor[6];

const float kBrickVoxels = 8.0, kBrickCorners = 9.0, kSurfaceCode = 96.0;
const float kLeastPassed = 0.02;
const float kLeastPeakDepth = 1e-3, kDeepestPeak = 200.0;

// The layer, as read from the block once.
LayerNodes layer;
float layer_rows, layer_row_m;  // of the table of extinction, and their number per metre

// A place in the bricks.
struct InBricks {
  int brick;      // as in cloud_bricks
  vec3 in_brick;  // [bricks]
};

// @param place  metres in the lattice.
InBricks BricksAt(vec3 place) {
  vec3 voxel = (place - vec3(0.0, 0.0, layer_shape.y)) * layer_shape.x;
  voxel.xy -= layer_voxels.xy * floor(voxel.xy * layer_periods_per_voxel);
  voxel = clamp(voxel, vec3(0.0), layer_voxels - 1e-3) * (1.0 / kBrickVoxels);
  ivec3 number = ivec3(voxel);
  return InBricks(texelFetch(cloud_bricks, number, 0).r, voxel - vec3(number));
}

// Returns the code of the depth at a place in a brick with values.
float CodeAt(InBricks at) {
  ivec3 tile = ivec3(max(at.brick, 0)) >> ivec3(0, 10, 20) & 1023;
  vec3 corner =
      (kBrickCorners * vec3(tile) + kBrickVoxels * at.in_brick + 0.5) * layer_texel;
  return 255.0 * textureLod(cloud_depth, corner, 0.0).r;
}

// Returns the extinction of a code at an altitude [1/m].
float ExtinctionOf(float code, float altitude) {
  vec2 at = vec2((code + 0.5) * (1.0 / 256.0), layer_rows + layer_row_m * (altitude - layer.range.x));
  return 1e-3 * textureLod(cloud_extinction, at, 0.0).r;
}

// Returns the extinction at a place [1/m].
float ExtinctionAt(vec3 place) {
  InBricks at = BricksAt(place);
  float per_m = ExtinctionOf(CodeAt(at), place.z);
  return at.brick < 0 ? 0.0 : per_m;
}

// Returns the distance to the border of the empty bricks around a place [m].
float ClearAhead(InBricks at, vec3 direction) {
  float reach = float(-at.brick);
  vec3 ahead = mix(at.in_brick + (reach - 1.0), reach - at.in_brick, step(0.0, direction));
  vec3 exit = ahead * layer_shape.z / max(abs(direction), vec3(1e-6));
  return min(exit.x, min(exit.y, exit.z)) + 0.5;
}

// Returns the optical depth from a place to the light: by a few samples, and the map behind them.
float DepthToLight(vec3 place, vec3 offset) {
  float depth = 0.0, ahead = 0.0;
#if CLOUD_SUN_STEPS > 0
  const float kLength = 30.0;
  for (int i = 0; i < CLOUD_SUN_STEPS; ++i) {
    float step_m = i == 0 ? kLength : 2.0 * kLength;
    depth += step_m * ExtinctionAt(place + (ahead + 0.5 * step_m) * beam_towards);
    ahead += step_m;
  }
#endif
  float left = LeftByNodes(cloud_light, layer, offset + ahead * beam_towards);
  return depth - log(max(left, 1e-7));
}

// Returns the factor on light of higher orders: CloudFactor of the renderer.
float FactorAt(float depth_to_light) {
  float at = 5.0 / log(41.0) * log(1.0 + clamp(depth_to_light, 0.0, 40.0));
  int node = min(int(at), 4);
  return mix(layer_factor[node], layer_factor[node + 1], at - float(node));
}

// The ray in the flat frame.
struct CloudRay {
  float altitude_m, rise, bend;  // z(t) = altitude + rise t + bend t^2
  vec2 towards;                  // along the ground, per metre
};

vec3 OffsetOn(CloudRay ray, float t) {
  float arc = 1e3 * PLANET_RADIUS /
              (1e3 * (PLANET_RADIUS + EYE_ALTITUDE) + ray.rise * t);
  return vec3(arc * t * ray.towards, ray.altitude_m + t * (ray.rise + ray.bend * t));
}

// The distances [m] within which a ray is in the range of a layer, and the hole between them in which
// it is below the layer.
struct CloudStretch {
  float begin, end, hole, hole_end;
};

CloudStretch StretchIn(vec3 direction, float length_km) {
  vec2 range = 1e-3 * layer.range.xy;
  float h = EYE_ALTITUDE, radius = PLANET_RADIUS, mu = direction.z;
  float lowest = mu < 0.0 ? PerigeeAltitude(h, mu, radius) : h;
  float nadir = -(radius + h) * mu;  // distance of the lowest point
  CloudStretch stretch = CloudStretch(0.0, 0.0, 1e9, 1e9);
  if (h > range.y) {
    if (lowest >= range.y || mu >= 0.0) return stretch;
    stretch.begin = DistanceDownTo(h, mu, range.y, radius);
    stretch.end = 2.0 * nadir - stretch.begin;
  } else {
    if (h < range.x) stretch.begin = DistanceUpTo(h, mu, range.x, radius);
    stretch.end = DistanceUpTo(h, mu, range.y, radius);
  }
  if (h > range.x && lowest < range.x) {
    stretch.hole = DistanceDownTo(h, mu, range.x, radius);
    stretch.hole_end = 2.0 * nadir - stretch.hole;
  }
  stretch.end = min(stretch.end, min(length_km, 400.0));
  return CloudStretch(1e3 * stretch.begin, 1e3 * stretch.end, 1e3 * stretch.hole,
                      1e3 * stretch.hole_end);
}

// Returns light of the beam [1/sr], light of the sky, the scaled transmittance, and the mean distance
// [km] times the share that is taken away.
vec4 GatheredAlong(vec3 direction, float length_km) {
  layer = NodesOfLayer(layer_number);
  float rows = float(textureSize(cloud_extinction, 0).y);
  layer_rows = 0.5 / rows;
  layer_row_m = (rows - 1.0) / rows / (layer.range.y - layer.range.x);
  CloudStretch stretch = StretchIn(direction, length_km);
  vec2 level = vec2(cloud_turn.x * direction.x - cloud_turn.y * direction.y,
                    cloud_turn.y * direction.x + cloud_turn.x * direction.y);
  float flat2 = dot(level, level);
  CloudRay ray = CloudRay(1e3 * EYE_ALTITUDE, direction.z,
                          0.5e-3 * flat2 / (PLANET_RADIUS + EYE_ALTITUDE), level);
  // Tables of the direction.
  vec2 around = vec2(atan(level.x, level.y) / 6.28318531,
                     asin(clamp(direction.z, -1.0, 1.0)) / 3.14159265);
  float most = 0.5 - 1.0 / float(textureSize(cloud_basis, 0).y);
  vec2 basis_at = vec2(around.x, 0.25 + 0.5 * clamp(around.y, -most, most));
  vec4 sun_basis = textureLod(cloud_basis, basis_at, 0.0);
  vec4 sky_basis = textureLod(cloud_basis, basis_at + vec2(0.0, 0.5), 0.0);
  vec3 apart = vec3(level, direction.z) - beam_towards;
  float angle = sqrt(0.5 * length(apart));
  float scale = layer.shear.z;
  vec2 peak_size = vec2(textureSize(cloud_peak, 0));
  float peak_angle = (0.5 + angle * (peak_size.x - 1.0)) / peak_size.x;
  float peak_row = (peak_size.y - 1.0) / peak_size.y / log2(kDeepestPeak / kLeastPeakDepth);
  float lowest_cell = 0.5 / layer_shape.w;

  float t = stretch.begin, passed = 1.0, depth = 0.0, lit = 0.0, weighted = 0.0;
  vec2 light = vec2(0.0);
  int steps = 0;
  while (steps < CLOUD_STEPS && t < stretch.end && passed > kLeastPassed) {
    // Software drivers evaluate both sides of a branch, so that each of these loops has only what it
    // needs: passing empty bricks, approaching the surface, and the light in the cloud.
    vec3 offset, place;
    InBricks at;
    float code = 0.0, least = 6.0;
    for (; steps < CLOUD_STEPS; ++steps) {
      for (; steps < CLOUD_STEPS; ++steps) {
        if (t > stretch.hole) t = max(t, stretch.hole_end);
        offset = OffsetOn(ray, t);
        place = vec3(layer.place.xy, 0.0) + offset;
        at = BricksAt(place);
        least = 6.0 + 0.003 * t;
        if (at.brick >= 0 || t >= stretch.end) break;
        t += max(ClearAhead(at, vec3(level, ray.rise + 2.0 * ray.bend * t)), least);
      }
      code = CodeAt(at);
      if (code > kSurfaceCode || t >= stretch.end) break;
      t += max(0.6 * (kSurfaceCode - code), least);
    }
    ++steps;
    float per_m = t < stretch.end && at.brick >= 0 ? ExtinctionOf(code, place.z) : 0.0;
    float length_m = min(0.5 / max(scale * per_m, 1e-6), 40.0 + 0.005 * t);
    length_m = max(min(length_m, 4.0 + 0.4 * (code - kSurfaceCode)), least);
    length_m = min(length_m, max(stretch.end - t, 0.0) + 0.01);
    float more = per_m * length_m;
    offset = OffsetOn(ray, t + 0.5 * length_m);
    place = vec3(layer.place.xy, 0.0) + offset;
    float to_light = DepthToLight(place, offset);
    float peak_depth = clamp((1.0 - scale) * (to_light + depth + 0.5 * more), kLeastPeakDepth, kDeepestPeak);
    float peak_at = 0.5 / peak_size.y + peak_row * log2(peak_depth / kLeastPeakDepth);
    float peak = textureLod(cloud_peak, vec2(peak_angle, peak_at), 0.0).r;
    float cell_z = (place.z - layer_shape.y - layer_cells.x) * layer_cells.y;
    vec3 cell = vec3(place.xy * layer.place.zw, clamp(cell_z, lowest_cell, 1.0 - lowest_cell));
    float of_sun = max(dot(sun_basis, textureLod(cloud_sun_source, cell, 0.0)), 0.0);
    float of_sky = max(dot(sky_basis, textureLod(cloud_sky_source, cell, 0.0)), 0.0);
    float left = exp(-scale * more);
    float share = passed * (1.0 - left);
    light += share * vec2(layer_cells.z * exp(-scale * to_light) * peak + FactorAt(to_light) * of_sun,
                          of_sky);
    lit += share;
    weighted += share * (t + 0.5 * length_m);
    depth += more;
    passed *= left;
    t += length_m;
  }
  // The rest of a ray that was not followed to its end is like its beginning.
  if (passed <= kLeastPassed) passed = 0.0;
  float taken = 1.0 - passed;
  if (lit > 0.0) light *= taken / lit;
  light.y = min(light.y, taken);
  return vec4(light, passed, lit > 0.0 ? 1e-3 * taken * weighted / lit : 0.0);
}
