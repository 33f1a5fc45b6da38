// SPDX-License-Identifier: MIT
// The light of a disk that is too small for the rays of a picture, from a picture of the disk alone
// (small_disk_painter.h). Each texel is a point whose light falls on the pixels around it: its weights are
// triangles of whole widths in pixels, so that they sum to 1 wherever the point is.
in vec2 screen;
out vec4 picture;

uniform sampler2D disk_light;
uniform vec4 disk_place;  // place of the lower left texel, and half widths of the triangles [pixels]
uniform vec4 disk_steps;  // from texel to texel to the right, and upwards [pixels]
uniform float texel_per_pixel;  // solid angle of a texel, over that of a pixel in the view's middle

void main() {
  ivec2 size = textureSize(disk_light, 0);
  vec3 light = vec3(0.0);
  for (int row = 0; row < size.y; ++row) {
    for (int column = 0; column < size.x; ++column) {
      vec2 place = disk_place.xy + float(column) * disk_steps.xy + float(row) * disk_steps.zw;
      vec2 weight =
          max(1.0 - abs(gl_FragCoord.xy - place) / disk_place.zw, 0.0) / disk_place.zw;
      if (weight.x * weight.y > 0.0)
        light += weight.x * weight.y * texelFetch(disk_light, ivec2(column, row), 0).rgb;
    }
  }
  float along = dot(ViewDirection(screen), view_forward.xyz);
  picture = vec4(texel_per_pixel / (along * along * along) * light, 0.0);
}
