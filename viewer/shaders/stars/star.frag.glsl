// SPDX-License-Identifier: MIT
// The light of a star in a pixel, which is added to the picture.
flat in vec3 light;
flat in vec4 across;
flat in vec4 up;
flat in vec4 last;
flat in vec2 corner;
out vec4 picture;

void main() {
  ivec2 at = ivec2(floor(gl_FragCoord.xy - corner));
  float columns[5] = float[5](across.x, across.y, across.z, across.w, last.x);
  float rows[5] = float[5](up.x, up.y, up.z, up.w, last.y);
  picture = vec4(columns[clamp(at.x, 0, 4)] * rows[clamp(at.y, 0, 4)] * light, 0.0);
}
