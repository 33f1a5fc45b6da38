// SPDX-License-Identifier: MIT
// Letters and lines: coverage from an atlas, colour interpolated from the corners.
uniform sampler2D atlas;

in vec2 atlas_at;
in vec4 shade;

out vec4 colour;

void main() { colour = vec4(shade.rgb, shade.a * texture(atlas, atlas_at).r); }
