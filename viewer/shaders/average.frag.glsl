// SPDX-License-Identifier: MIT
// The mean of `samples` x `samples` pixels of a larger picture.
uniform sampler2D larger;
uniform int samples;
out vec4 picture;

void main() {
  ivec2 corner = samples * ivec2(gl_FragCoord.xy);
  vec4 sum = vec4(0.0);
  for (int y = 0; y < samples; ++y) {
    for (int x = 0; x < samples; ++x) sum += texelFetch(larger, corner + ivec2(x, y), 0);
  }
  picture = sum / float(samples * samples);
}
