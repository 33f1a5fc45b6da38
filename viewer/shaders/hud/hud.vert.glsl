// SPDX-License-Identifier: MIT
// Vertices of the triangles of instruments and panels, in pixels from the upper left corner.
uniform vec2 picture_size;

in vec2 place;
in vec2 atlas_place;
in vec4 colour;

out vec2 atlas_at;
out vec4 shade;

void main() {
  atlas_at = atlas_place;
  shade = colour;
  vec2 share = place / picture_size;
  gl_Position = vec4(2.0 * share.x - 1.0, 1.0 - 2.0 * share.y, 0.0, 1.0);
}
