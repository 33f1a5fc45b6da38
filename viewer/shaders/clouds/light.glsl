// SPDX-License-Identifier: MIT
// Clouds dim the light of sun and sky and add to it, by the values of CloudsBlock of cloud_textures.h.
// Defined before this text: CLOUD_LAYERS. A place is given in the flat frame of the clouds relative
// to the eye: metres east and north along the ground, and the altitude [m].
//
// While new clouds fade in, both the earlier ones (numbers from MOST_CLOUD_LAYERS on) and the new
// ones (from 0 on) exist.
#define MOST_CLOUD_LAYERS 4
#define DIFFUSE_ELEVATIONS 16
#define DIFFUSE_AZIMUTHS 9

const float kToSpace_km = 1e3;  // length of a ray that meets no ground

layout(std140) uniform Clouds {
  vec4 cloud_turn;   // cosine and sine from the eye's axes to those of the clouds; share of the new
                     // clouds
  vec4 cloud_place[2 * MOST_CLOUD_LAYERS];   // of the eye in the lattice [m]; inverse sides [1/m]
  vec4 cloud_levels[2 * MOST_CLOUD_LAYERS];  // lowest node of light [m]; levels per metre; the first
                                             // level, and their number
  vec4 cloud_shear[2 * MOST_CLOUD_LAYERS];   // shift of the nodes per metre of height; the scale s of
                                             // the medium without forward peak; altitude from which
                                             // on nothing is hidden [m]
  vec4 cloud_range[2 * MOST_CLOUD_LAYERS];   // lowest and highest cloud [m]; 1: an open field
  vec4 cloud_interface[MOST_CLOUD_LAYERS + 1];  // lowest altitude [m]; beam left in the mean
  vec4 cloud_added[MOST_CLOUD_LAYERS + 1];      // irradiance that layers add
  vec4 cloud_sky_low[MOST_CLOUD_LAYERS];        // radiance from above, at the base
  vec4 cloud_sky_high[MOST_CLOUD_LAYERS];       // and at the top of a layer [1/sr]
  vec4 cloud_ground_low[MOST_CLOUD_LAYERS];     // the same from below
  vec4 cloud_ground_high[MOST_CLOUD_LAYERS];
  // The factor on light scattered more than once along rays, see InterfaceLight of the renderer.
  vec4 cloud_diffuse_towards[(MOST_CLOUD_LAYERS + 1) * DIFFUSE_ELEVATIONS * DIFFUSE_AZIMUTHS];
};

uniform sampler3D cloud_sun_map, earlier_cloud_sun_map;

#define NEW_CLOUDS_SHARE cloud_turn.z

// Returns a place.
// @param point  from the eye [m].
// @param altitude_km  of the point.
vec3 InCloudFrame(vec3 point, float altitude_km) {
  float arc = PLANET_RADIUS / (PLANET_RADIUS + EYE_ALTITUDE + 1e-3 * point.z);
  vec2 level = arc * point.xy;
  return vec3(cloud_turn.x * level.x - cloud_turn.y * level.y,
              cloud_turn.y * level.x + cloud_turn.x * level.y, 1e3 * altitude_km);
}

// A layer and its nodes of light, see the block.
struct LayerNodes {
  vec4 place, levels, shear, range;
};

LayerNodes NodesOfLayer(int number) {
  return LayerNodes(cloud_place[number], cloud_levels[number], cloud_shear[number],
                    cloud_range[number]);
}

// Returns the transmittance of one layer from a place to the light.
float LeftByNodes(sampler3D map, LayerNodes of, vec3 place) {
  float height = place.z - of.levels.x;
  vec2 foot = (of.place.xy + place.xy - height * of.shear.xy) * of.place.zw;
  float level = of.levels.z + clamp(height * of.levels.y, 0.0, of.levels.w - 1.0);
  float left = textureLod(map, vec3(foot, (level + 0.5) / float(textureSize(map, 0).z)), 0.0).r;
  bool is_beside = of.range.z > 0.5 && any(greaterThan(abs(foot - 0.5), vec2(0.5)));
  return place.z >= of.shear.w || is_beside ? 1.0 : left;
}

float LeftByLayer(sampler3D map, int number, vec3 place) {
  return LeftByNodes(map, NodesOfLayer(number), place);
}

// Returns the transmittance of all layers.
float BeamLeftByClouds(vec3 place) {
  float left = 1.0, earlier = 1.0;
  for (int i = 0; i < CLOUD_LAYERS; ++i) {
    left *= LeftByLayer(cloud_sun_map, i, place);
    earlier *= LeftByLayer(earlier_cloud_sun_map, MOST_CLOUD_LAYERS + i, place);
  }
  return mix(earlier, left, NEW_CLOUDS_SHARE);
}

// Returns the number of the interface that an altitude [m] belongs to.
int CloudInterfaceAt(float altitude) {
  int number = 0;
  for (int i = 1; i <= CLOUD_LAYERS; ++i) number += altitude > cloud_interface[i].x ? 1 : 0;
  return number;
}

// Returns the irradiance of a surface by the sky behind, between and by clouds.
// @param sky  in a clear sky. @param cos_up  of the normal.
vec4 SkyUnderClouds(vec4 sky, float altitude_km, float cos_up) {
  int number = CloudInterfaceAt(1e3 * altitude_km);
  return cloud_interface[number].y * sky + 0.5 * (1.0 + cos_up) * cloud_added[number];
}
