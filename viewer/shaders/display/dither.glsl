// SPDX-License-Identifier: MIT
// Quantises display codes to bytes with the dither of Develop (look.h).
uniform sampler2D dither_noise;  // [codes]; a tile, row 0 at the top of the picture
uniform vec2 screen_size;        // pixels

// Returns DitherNoise (lut/image/dither.h).
vec3 NoiseAt(ivec2 pixel) {
  ivec2 tile = textureSize(dither_noise, 0);
  uvec2 repetition = uvec2(pixel / tile);
  uint hash = DitherHash(repetition.x, repetition.y);
  ivec2 shift = ivec2(uvec2(hash, hash >> 8));
  return texelFetch(dither_noise, (pixel + (shift & (tile - 1))) & (tile - 1), 0).rgb;
}

// Returns codes in [0, 1] dithered at the fragment's pixel.
vec3 Dithered(vec3 codes) {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec3 noise = NoiseAt(ivec2(pixel.x, int(screen_size.y) - 1 - pixel.y));
  vec3 srgb = 255.0 * codes;
  vec3 dithered = vec3(DitheredValue(srgb.r, noise.r), DitheredValue(srgb.g, noise.g),
                       DitheredValue(srgb.b, noise.b));
  return floor(dithered + 0.5) / 255.0;
}
