// SPDX-License-Identifier: MIT
// The map of diffuse light around the eye: the light of higher orders of whole rays.
uniform float layer;
uniform vec2 map_size;
out vec4 diffuse;

void main() {
  vec2 unit = vec2(UnitFromTexel(gl_FragCoord.x / map_size.x, map_size.x),
                   UnitFromTexel(gl_FragCoord.y / map_size.y, map_size.y));
  vec2 angles = SkyMapAngles(unit, layer);
  vec2 towards = SunAzimuth();
  vec2 across = vec2(-towards.y, towards.x);
  vec2 flat_direction = cos(angles.y) * towards + sin(angles.y) * across;
  vec3 direction = vec3(cos(angles.x) * flat_direction, sin(angles.x));
  AirRay ray = RayOf(direction, 1e9);
  diffuse = LightAlong(ray, SKY_RULE, SKY_NODES, false, true).diffuse;
}
