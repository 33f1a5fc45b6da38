// SPDX-License-Identifier: MIT
// The picture on a display: exposure, AgX, sRGB, dither, as Develop (image.h) does it.
uniform sampler2D linear_picture;
uniform sampler2D dither_noise;  // [codes]; a tile, row 0 at the top of the picture
uniform float exposure;
out vec4 display;

// DitherNoise (lut/picture/dither.h).
vec3 NoiseAt(ivec2 pixel) {
  ivec2 tile = textureSize(dither_noise, 0);
  uvec2 repetition = uvec2(pixel / tile);
  uint hash = DitherHash(repetition.x, repetition.y);
  ivec2 shift = ivec2(uvec2(hash, hash >> 8));
  return texelFetch(dither_noise, (pixel + (shift & (tile - 1))) & (tile - 1), 0).rgb;
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  int height = textureSize(linear_picture, 0).y;
  vec3 noise = NoiseAt(ivec2(pixel.x, height - 1 - pixel.y));
  vec3 rgb = texelFetch(linear_picture, pixel, 0).rgb;
  vec3 exposed = vec3(ExposedChannel(rgb.r, exposure), ExposedChannel(rgb.g, exposure),
                      ExposedChannel(rgb.b, exposure));
  float y = Luminance(exposed.r, exposed.g, exposed.b);
  float smallest = min(exposed.r, min(exposed.g, exposed.b));
  vec3 inside = vec3(InnerChannel(exposed.r, smallest, y), InnerChannel(exposed.g, smallest, y),
                     InnerChannel(exposed.b, smallest, y));
  vec3 printed = vec3(PrintedChannel(inside.r), PrintedChannel(inside.g), PrintedChannel(inside.b));
  float share = AgxWhiteShare(printed.r, printed.g, printed.b);
  vec3 code = vec3(AgxCode(printed.r, share), AgxCode(printed.g, share), AgxCode(printed.b, share));
  float code_share = AgxWhiteShare(code.r, code.g, code.b);
  vec3 srgb =
      255.0 * vec3(SrgbCode(AgxLight(code.r, code_share)), SrgbCode(AgxLight(code.g, code_share)),
                   SrgbCode(AgxLight(code.b, code_share)));
  vec3 dithered = vec3(DitheredValue(srgb.r, noise.r), DitheredValue(srgb.g, noise.g),
                       DitheredValue(srgb.b, noise.b));
  display = vec4(floor(dithered + 0.5) / 255.0, 1.0);
}
