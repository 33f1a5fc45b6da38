// SPDX-License-Identifier: MIT
// The disk of a lamp, at least as large as a pixel, added to the picture.
in vec2 screen;
flat in vec4 towards;
flat in vec3 light;
out vec4 picture;

void main() {
  vec3 direction = ViewDirection(screen);
  float off = length(direction - towards.xyz) / towards.w;
  picture = vec4(SoftDiskPerSr(min(off, 1.0), towards.w) * light, 0.0);
}
