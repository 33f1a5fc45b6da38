// SPDX-License-Identifier: MIT
// Sunlight and skylight scattered by a layer, from the map of scene_layer.h, and the transmittance of
// the layer: LayerBlock of scene_layer.h. Frame: east, north, up at the eye. Lengths are in
// kilometres; light is per unit solar irradiance. The layer is grey.
#define MEDIA_STRETCHES 4
#define LAYER_SURFACES 2  // first rows of layer_surface_map; the phase function follows, row after row
#define LAYER_QUANTITIES 6.0  // of the map: light scattered once, in four parts, glow, light of the sky

const float kOutOfMedia_km = 1e3;  // length of rays that hit nothing

layout(std140) uniform Layer {
  vec4 layer_shape;  // extinction at the base [1/km]; scale height, 0 if homogeneous; base, top of
                     // the air
  vec4 layer_eye;  // altitude of the eye; radius of the planet; vertical optical depth of the layer;
                   // factor of optical depths without the forward peak
  vec4 layer_sun;       // unit vector
  vec4 layer_map_size;  // elevations, azimuths, depths, angles of the phase function
  vec4 layer_other_sun;  // as layer_sun, of the second light
};

uniform sampler3D layer_light_map;
uniform sampler2D layer_surface_map;
#ifdef TWO_LIGHTS
uniform sampler3D other_layer_light_map;
uniform sampler2D other_layer_surface_map;
#endif
#define LAYER_SUN OF_LIGHT(layer_sun, layer_other_sun)

float LayerDensityAt(float h) {
  if (layer_shape.y > 0.0) return LayerDensity(h - layer_shape.z, layer_shape.y);
  return h < layer_shape.w ? 1.0 : 0.0;
}

// Returns the column from altitude h to space, for a direction with mu >= 0.
float LayerColumnOut(float h, float mu) {
  if (layer_shape.y > 0.0) return LayerColumnUp(h, mu, LayerDensityAt(h), layer_shape.y, layer_eye.y);
  return h < layer_shape.w ? DistanceUpTo(h, mu, layer_shape.w, layer_eye.y) : 0.0;
}

// Returns the column from altitude h to space, for any direction that does not hit the planet.
float LayerColumnToSpace(float h, float mu) {
  float out_of_it = LayerColumnOut(h, abs(mu));
  if (mu >= 0.0) return out_of_it;
  return max(2.0 * LayerColumnOut(PerigeeAltitude(h, mu, layer_eye.y), 0.0) - out_of_it, 0.0);
}

// Returns the optical depth along a view ray.
float MediaDepthTo(vec3 direction, float distance_km) {
  float h = layer_eye.x;
  float mu = direction.z;
  float h_end = AltitudeAlongRay(h, mu, distance_km, layer_eye.y);
  float mu_end = ZenithCosineAlongRay(h, mu, distance_km, h_end, layer_eye.y);
  float perigee = mu < 0.0 && mu_end > 0.0 ? PerigeeAltitude(h, mu, layer_eye.y) : min(h, h_end);
  return layer_shape.x * ColumnBetween(mu, mu_end, LayerColumnOut(h, abs(mu)),
                                     LayerColumnOut(h_end, abs(mu_end)), LayerColumnOut(perigee, 0.0));
}

// Returns the optical depth of the whole ray, to the bare planet or to space.
float LayerDepthOfRay(vec3 direction) {
  if (GroundClearance(layer_eye.x, direction.z, layer_eye.y) <= 0.0)
    return layer_shape.x * LayerColumnToSpace(layer_eye.x, direction.z);
  float far = DistanceDownTo(layer_eye.x, min(direction.z, -1e-9), 0.0, layer_eye.y);
  return MediaDepthTo(direction, far);
}

// Returns the transmittance of the layer up to a distance.
float MediaTransmittance(vec3 direction, float distance_km) {
  return exp(-MediaDepthTo(direction, distance_km));
}

struct MediaAlong {
  vec4 transmittance;
  vec4 radiance;  // of sun and sky, scattered by the layer [1/sr]
};

// Returns the texture coordinates for the first quantity of the map.
// @param scale  of optical depths: whether the layer's forward peak removes light.
vec3 LayerPlace(vec3 direction, float taken, float scale) {
  float whole = 1.0 - exp(-scale * LayerDepthOfRay(direction));
  float share = clamp(taken / max(whole, 1e-9), 0.0, 1.0);
  vec2 level = LAYER_SUN.xy;
  float along = dot(direction.xy, level);
  float across = abs(direction.x * level.y - direction.y * level.x);
  float azimuth = along * along + across * across > 0.0 ? atan(across, along) * 0.318309886 : 0.0;
  float root = sqrt(abs(direction.z));
  float elevation = 0.5 + (direction.z < 0.0 ? -0.5 : 0.5) * root;
  return vec3(TexelFromUnit(elevation, layer_map_size.x), TexelFromUnit(azimuth, layer_map_size.y),
              TexelFromUnit(share, layer_map_size.z) / LAYER_QUANTITIES);
}

vec4 LayerQuantity(vec3 place, float number) {
  return TEXEL_OF_LIGHT(layer_light_map, other_layer_light_map, place + vec3(0.0, 0.0, number / LAYER_QUANTITIES));
}

vec4 LayerPhaseTexel(int index) {
  int width = textureSize(layer_surface_map, 0).x;
  return texelFetch(layer_surface_map, ivec2(index % width, LAYER_SURFACES + index / width), 0);
}

// Returns the phase function at four depths of the forward peak. The angle is exact near the sun.
vec4 LayerPhases(vec3 direction) {
  float angle = 2.0 * asin(min(0.5 * length(direction - LAYER_SUN.xyz), 1.0));
  float last = layer_map_size.w - 1.0;
  float at = last * sqrt(angle * 0.318309886);
  int low = int(min(at, last - 1.0));
  return mix(LayerPhaseTexel(low), LayerPhaseTexel(low + 1), at - float(low));
}

// Returns the light of the sun that the layer scatters once.
// @param depth  its optical depth.
vec4 LayerSunOnce(vec3 direction, float depth) {
  float taken = 1.0 - exp(-layer_eye.w * depth);
  vec3 place = LayerPlace(direction, taken, layer_eye.w);
  vec4 phases = LayerPhases(direction);
  return taken * (phases.x * LayerQuantity(place, 0.0) + phases.y * LayerQuantity(place, 1.0) +
                  phases.z * LayerQuantity(place, 2.0) + phases.w * LayerQuantity(place, 3.0));
}

// Returns the transmittance of an optical depth without the forward peak, and its inverse.
float MediaSunLeft(float depth) { return exp(-layer_eye.w * depth); }
float MediaSunDepth(float left) { return -log(max(left, 1e-30)) / layer_eye.w; }

// Returns the scattered light of the sun alone, above ground without shadows. Terrain shadows
// remove the light that comes from shadowed stretches of the ray.
vec4 MediaSunTo(vec3 direction, float distance_km) {
  float depth = MediaDepthTo(direction, distance_km);
  float taken = 1.0 - exp(-depth);
  return LayerSunOnce(direction, depth) +
         taken * LayerQuantity(LayerPlace(direction, taken, 1.0), 4.0);
}

MediaAlong MediaTo(vec3 direction, float distance_km) {
  float depth = MediaDepthTo(direction, distance_km);
  float left = exp(-depth);
  vec3 place = LayerPlace(direction, 1.0 - left, 1.0);
  vec4 glow = LayerQuantity(place, 4.0) + LayerQuantity(place, 5.0);
  return MediaAlong(vec4(left), LayerSunOnce(direction, depth) + (1.0 - left) * glow);
}

// Returns the distance at which a layer around the eye reaches an optical depth, assuming a flat ground.
float LayerDistanceFromWithin(float mu, float depth, float distance_km) {
  float per_km = layer_shape.x * LayerDensityAt(layer_eye.x);
  float bend = layer_shape.y > 0.0 ? mu / layer_shape.y : 0.0;
  float level = depth / max(per_km, 1e-30);
  float argument = 1.0 - bend * level;
  return abs(bend * level) < 1e-4 ? level
         : argument > 0.0         ? -log(argument) / bend
                                  : distance_km;
}

// Returns the distance at which a ray from an eye above the layer, where the density may be too small
// for a float, has passed a share of the layer before its end. Down to the end the layer is that over
// flat ground; around the lowest point of a ray it is a logistic curve with the slope of its bell,
// exp(-x^2 / (2 R H)), in the middle.
float LayerDistanceFromAbove(float mu, float share, float distance_km) {
  float h = layer_eye.x, radius = layer_eye.y, scale = layer_shape.y;
  float h_end = AltitudeAlongRay(h, mu, distance_km, radius);
  float perigee_km = -(radius + h) * mu;
  if (distance_km < perigee_km) {
    float fall = max(h - h_end, 0.0);
    float down = fall + scale * log(mix(exp(-fall / scale), 1.0, share));
    return DistanceDownTo(h, mu, h - clamp(down, 0.0, fall), radius);
  }
  float width_km = 0.62665707 * sqrt(radius * scale);
  float beyond = 1.0 / (1.0 + exp((distance_km - perigee_km) / width_km));
  float passed = share * (1.0 - beyond);
  return perigee_km + width_km * log(max(passed, 1e-6) / max(1.0 - passed, 1e-6));
}

// Returns the distance at which the layer reaches an optical depth along a ray.
// @param whole  optical depth of the layer on the ray.
float MediaDistanceOf(vec3 direction, float depth, float whole, float distance_km) {
  const float kAbove = 4.0;  // scale heights over the lowest point of the ray
  float h = layer_eye.x, mu = direction.z, radius = layer_eye.y;
  float far;
  if (layer_shape.y > 0.0) {
    float end = AltitudeAlongRay(h, mu, min(distance_km, max(-(radius + h) * mu, 0.0)), radius);
    far = h - end > kAbove * layer_shape.y
              ? LayerDistanceFromAbove(mu, clamp(depth / max(whole, 1e-30), 0.0, 1.0), distance_km)
              : LayerDistanceFromWithin(mu, depth, distance_km);
  } else {
    float entry_km = h > layer_shape.w ? DistanceDownTo(h, min(mu, -1e-9), layer_shape.w, radius) : 0.0;
    far = entry_km + depth / layer_shape.x;
  }
  return clamp(far, 0.0, distance_km);
}

// In-scattered light of the air up to a distance, L(d), is attenuated by the layer in front of the
// place where it is scattered: sum of weight[i] L(distance_km[i]), where the last distance is that
// of the ray. Within a stretch the light is assumed to increase linearly, and the mean
// transmittance of the layer follows from Simpson's rule. The last stretch may reach to space, far
// beyond the place where the light increases and the layer ends. Its contribution in excess of `left`
// is at most `fade` times the light of the stretch before, as if the transmittance of the layer
// continued to decrease there at the previous rate.
struct MediaStretches {
  vec4 distance_km;
  vec4 weight;  // with at most `left` for the last stretch
  float rest;   // remaining weight of the last stretch, by Simpson's rule
  float fade;
};

// Returns the mean transmittance between two distances at which it is a and b.
float LayerMean(vec3 direction, float from_km, float to_km, float a, float b) {
  return (a + 4.0 * MediaTransmittance(direction, 0.5 * (from_km + to_km)) + b) / 6.0;
}

MediaStretches MediaStretchesTo(vec3 direction, float distance_km) {
  float whole = MediaDepthTo(direction, distance_km);
  float left = exp(-whole);
  vec4 ends;
  vec4 at;
  // A downward ray passes clear air before the layer, an upward ray after it.
  vec3 shares = direction.z < 0.0 ? vec3(0.97, 0.5, 0.02) : vec3(0.5, 0.12, 0.015);
  for (int i = 0; i < 3; ++i) {
    at[i] =
        MediaDistanceOf(direction, -log(left + shares[i] * (1.0 - left)), whole, distance_km);
    ends[i] = MediaTransmittance(direction, at[i]);
  }
  at.w = distance_km;
  ends.w = left;
  vec4 mean = vec4(LayerMean(direction, 0.0, at.x, 1.0, ends.x),
                   LayerMean(direction, at.x, at.y, ends.x, ends.y),
                   LayerMean(direction, at.y, at.z, ends.y, ends.z),
                   LayerMean(direction, at.z, at.w, ends.z, ends.w));
  float rest = mean.w - left;
  mean.w = left;
  float fall = log(max(ends.y - left, 1e-20) / max(ends.z - left, 1e-20));
  float fade = fall > 1e-3 ? (ends.z - left) / fall : 0.0;
  return MediaStretches(at, mean - vec4(mean.yzw, 0.0), rest, fade);
}

// Returns the light of the last stretch in excess of `left`.
// @param all, light, before  light of the whole path and up to the ends of the two stretches before
//   the last.
vec4 MediaRest(MediaStretches stretches, vec4 all, vec4 light, vec4 before) {
  return max(min(stretches.rest * (all - light), stretches.fade * (light - before)), vec4(0.0));
}

// Returns the transmittance of the layer for sunlight at the ground; mu_s is of a sun above the horizon.
float SunLeftByMedia(float h, float mu_s) {
  return exp(-layer_eye.w * layer_shape.x * LayerColumnToSpace(h, mu_s));
}

float LayerDepthAbove(float h) { return min(layer_shape.x * LayerColumnOut(h, 1.0), layer_eye.z); }

// Returns the transmittance of the layer for the sky's irradiance.
float SkyLeftByMedia(float h) { return exp(-layer_eye.w * LayerDepthAbove(h) * 1.66666667); }

// Returns the irradiance of a surface by light that the layer scatters.
// @param cos_up  of the surface's normal.
vec4 MediaOnSurface(float h, float cos_up) {
  float unit = sqrt(sqrt(LayerDepthAbove(h) / max(layer_eye.z, 1e-9)));
  float x = TexelFromUnit(unit, float(textureSize(layer_surface_map, 0).x));
  float row = 1.0 / float(textureSize(layer_surface_map, 0).y);
  vec4 level = TEXEL_OF_LIGHT(layer_surface_map, other_layer_surface_map, vec2(x, 0.5 * row));
  vec4 upright = TEXEL_OF_LIGHT(layer_surface_map, other_layer_surface_map, vec2(x, 1.5 * row));
  return max(level + (1.0 - cos_up) * upright, vec4(0.0));
}
