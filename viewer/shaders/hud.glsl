// SPDX-License-Identifier: MIT
// Instruments and panels.

//// hud.vert.glsl
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

//// hud.frag.glsl
// Letters and lines: coverage from an atlas, colour interpolated from the corners.
uniform sampler2D atlas;

in vec2 atlas_at;
in vec4 shade;

out vec4 colour;

void main() { colour = vec4(shade.rgb, shade.a * texture(atlas, atlas_at).r); }
