// SPDX-License-Identifier: MIT
// The square of a lamp's disk, unless terrain hides its centre.
in vec4 disk_towards;  // unit vector; angular radius [rad]
in vec4 disk_light;    // irradiance at the eye, one value per band [W m^-2 nm^-1]
in vec4 disk_place;    // distance [m]
out vec2 screen;
flat out vec4 towards;
flat out vec3 light;

uniform sampler2D surface_map;
uniform float pixel_angle;  // [rad]

// A lamp stands on terrain or just above it. It is visible if the ray of at least one pixel around
// its centre reaches as far as the lamp.
bool IsHidden(vec2 screen, float distance_m) {
  ivec2 size = textureSize(surface_map, 0);
  ivec2 middle = ivec2(floor((0.5 * screen + 0.5) * vec2(size)));
  if (any(lessThan(middle, ivec2(1))) || any(greaterThan(middle, size - 2))) return false;
  float reach = 0.99 * distance_m - 0.5;
  for (int i = 0; i < 9; ++i) {
    float seen = texelFetch(surface_map, middle + ivec2(i % 3 - 1, i / 3 - 1), 0).w;
    if (seen <= 0.0 || seen > reach) return false;
  }
  return true;
}

void main() {
  towards = vec4(disk_towards.xyz, max(disk_towards.w, 0.9 * pixel_angle));
  light = LampRgb(disk_light);
  vec4 corner = LampCorner(towards.xyz, towards.w);
  float ahead = max(dot(towards.xyz, view_forward.xyz), 1e-6);
  vec2 size = vec2(dot(view_right.xyz, view_right.xyz), dot(view_up.xyz, view_up.xyz));
  vec2 middle =
      vec2(dot(towards.xyz, view_right.xyz), dot(towards.xyz, view_up.xyz)) / (size * ahead) -
      PICTURE_SHIFT;
  bool hidden = IsHidden(middle, disk_place.x);
  gl_Position = hidden ? vec4(2.0, 2.0, 2.0, 1.0) : corner;
  screen = gl_Position.xy;
}
