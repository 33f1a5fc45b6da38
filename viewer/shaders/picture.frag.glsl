// SPDX-License-Identifier: MIT
// The linear picture [cd/m^2, linear sRGB]: sky, terrain, ground beyond it, and the air before
// them.
in vec2 screen;
out vec4 picture;

uniform sampler2D surface_map;       // of terrain.frag.glsl; distance 0 where there is no terrain
uniform sampler2DArray diffuse_sky;  // of diffuse_sky.frag.glsl
uniform sampler2DShadow sun_shadow;
uniform mat4 shadow_from_eye;
uniform float shadow_texel;  // size on the ground [m]; 0 without terrain
uniform float pixel_angle;   // [rad]
uniform float sample_angle;  // of one of its rays [rad]

vec4 DiffuseOfWholeRay(vec3 direction, bool ground) {
  float layer = ground ? 1.0 : 0.0;
  vec2 towards = SunAzimuth();
  vec2 turned = vec2(dot(direction.xy, towards), towards.x * direction.y - towards.y * direction.x);
  float azimuth = abs(turned.x) + abs(turned.y) > 0.0 ? atan(turned.y, turned.x) : 0.0;
  vec2 unit = SkyMapUnit(asin(clamp(direction.z, -1.0, 1.0)), azimuth, layer);
  vec2 size = vec2(textureSize(diffuse_sky, 0).xy);
  return texture(diffuse_sky,
                 vec3(TexelFromUnit(unit.x, size.x), TexelFromUnit(unit.y, size.y), layer));
}

// Share of the sun's light that terrain lets through: the shadow map around the point, moved off
// the surface by what a texel of the map may hide.
float SunThroughTerrain(vec3 point, vec3 normal) {
  if (shadow_texel <= 0.0) return 1.0;
  vec3 moved = point + (0.5 * shadow_texel) * normal;
  vec4 clip = shadow_from_eye * vec4(moved, 1.0);
  vec3 at = 0.5 * clip.xyz + 0.5;
  if (any(lessThan(at, vec3(0.0))) || any(greaterThan(at.xy, vec2(1.0)))) return 1.0;
  at.z = min(at.z, 1.0);  // behind all terrain: what is clear in the map is clear
  vec2 texel = 1.0 / vec2(textureSize(sun_shadow, 0));
  float lit = 0.0;
  for (int y = -1; y <= 1; ++y) {
    for (int x = -1; x <= 1; ++x) {
      lit += texture(sun_shadow, vec3(at.xy + vec2(x, y) * texel, at.z));
    }
  }
  return lit / 9.0;
}

// Radiance that a surface reflects towards the eye, per unit solar irradiance [1/sr].
// @param point  [m] from the eye.
vec4 Reflected(vec3 point, vec3 normal, bool terrain) {
  vec3 at = 1e-3 * point;
  float d = length(at);
  float h = max(AltitudeAlongRay(EYE_ALTITUDE, at.z / max(d, 1e-9), d, RADIUS), 0.0);
  vec3 up = normalize(vec3(at.xy, RADIUS + EYE_ALTITUDE + at.z));
  float footprint = 1e3 * d * pixel_angle;
  vec2 offset = vec2(dot(point, mesh_east.xyz), dot(point, mesh_north.xyz));
  vec3 mesh_normal = normal;
  normal = terrain ? DetailedNormal(offset, mesh_normal, footprint) : up;
  float mu_s = clamp(dot(up, sun.xyz), -1.0, 1.0);
  float incidence = dot(normal, sun.xyz);
  vec2 disk = DiskOverHorizon(mu_s, HorizonCosine(h, RADIUS), sun.w);
  vec4 irradiance = vec4(0.0);
  if (incidence > 0.0 && disk.x > 0.0) {
    float seen = disk.x * SunThroughTerrain(point, terrain ? mesh_normal : up);
    irradiance += seen * incidence * exp(-OpticalDepth(ColumnsToSun(h, disk.y)));
  }
  float normal_mu = clamp(dot(normal, up), -1.0, 1.0);
  vec3 flat_sun = sun.xyz - mu_s * up;
  vec3 flat_normal = normal - normal_mu * up;
  float lengths = length(flat_sun) * length(flat_normal);
  float azimuth = lengths > 1e-6 ? clamp(dot(flat_sun, flat_normal) / lengths, -1.0, 1.0) : 1.0;
  irradiance += DiffuseIrradiance(h, mu_s, normal_mu, azimuth);
  vec4 albedo =
      terrain ? GroundAlbedo(offset, 1e3 * h, dot(mesh_normal, up), footprint) : ground_albedo;
  return albedo * irradiance / 3.14159265359;
}

// Whether the planet stands before a piece of terrain: the ray dips deeper than ground ever lies
// below the sphere, half a kilometre, before it gets there.
bool BehindPlanet(vec3 direction, float d) {
  const float deepest = -0.5;
  if (direction.z >= 0.0 || PerigeeAltitude(EYE_ALTITUDE, direction.z, RADIUS) > deepest)
    return false;
  return d > DistanceDownTo(EYE_ALTITUDE, direction.z, deepest, RADIUS);
}

void main() {
  vec3 direction = normalize(view_forward.xyz + screen.x * view_right.xyz + screen.y * view_up.xyz);
  vec4 surface = texelFetch(surface_map, ivec2(gl_FragCoord.xy), 0);
  bool terrain = surface.w > 0.0 && !BehindPlanet(direction, 1e-3 * surface.w);
  AirRay ray = RayOf(direction, terrain ? 1e-3 * surface.w : 1e9);
  bool near = terrain && surface.w < 50e3;
  AirLight light =
      LightAlong(ray, near ? NEAR_RULE : SKY_RULE, near ? NEAR_NODES : SKY_NODES, true, terrain);
  vec4 radiance =
      light.single + (terrain ? light.diffuse : DiffuseOfWholeRay(direction, ray.ground));
  if (terrain) {
    radiance += light.transmittance * Reflected(surface.w * direction, surface.xyz, true);
  } else if (ray.ground) {
    vec3 point = 1e3 * (ray.begin + ray.reach) * direction;
    radiance += light.transmittance * Reflected(point, vec3(0.0), false);
  } else {
    radiance += light.transmittance * SunDiskRadiance(direction, sample_angle);
  }
  picture = vec4(LinearSrgb(sun_irradiance * radiance), 1.0);
}
