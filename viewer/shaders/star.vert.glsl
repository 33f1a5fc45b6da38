// SPDX-License-Identifier: MIT
// A star as a square of five pixels around the one that it is in, over depth 0.
in vec3 star_direction;
in vec4 star_irradiance;
flat out vec3 direction;
flat out vec4 radiance;  // of a pixel that had all of its light
flat out vec2 place;     // in pixels
flat out vec2 bell_sum;

uniform vec2 picture_size;

// Sum of the bell over the pixels of one side.
float BellSum(float at) {
  float sum = 0.0;
  for (int i = -2; i <= 2; ++i) {
    float off = 2.0 * (floor(at) + float(i) + 0.5 - at);
    sum += exp(-0.5 * off * off);
  }
  return sum;
}

void main() {
  direction = star_direction;
  float along = dot(star_direction, view_forward.xyz);
  vec2 half_view = vec2(length(view_right.xyz), length(view_up.xyz));
  vec2 seen = vec2(dot(star_direction, view_right.xyz) / (half_view.x * half_view.x),
                   dot(star_direction, view_up.xyz) / (half_view.y * half_view.y));
  vec2 screen = seen / max(along, 1e-3) - PICTURE_SHIFT;
  place = 0.5 * (screen + 1.0) * picture_size;
  bell_sum = vec2(BellSum(place.x), BellSum(place.y));
  float pixel_area = 4.0 * half_view.x * half_view.y / (picture_size.x * picture_size.y);
  radiance = star_irradiance / (pixel_area * along * along * along);
  vec2 middle = 2.0 * (floor(place) + 0.5) / picture_size - 1.0;
  gl_Position = along > 1e-3 ? vec4(middle, -1.0, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
  gl_PointSize = 5.0;
}
