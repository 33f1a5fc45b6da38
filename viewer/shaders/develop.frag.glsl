// SPDX-License-Identifier: MIT
// The picture on a display: exposure, gamut, tone curve, dither, as Develop (image.h) does it. CURVE,
// a ToneCurve, is defined before this text; AgX comes from its table (tone_table.h).
uniform sampler2D linear_picture;  // any size
uniform sampler2D dither_noise;    // [codes]; a tile, row 0 at the top of the picture
uniform sampler3D tone_table;
uniform vec2 stops;        // over saturation, at the first and the last node of the table
uniform vec2 screen_size;  // pixels
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

#if CURVE == 0
vec3 CodesOf(vec3 inside) {
  vec3 share = (log2(max(inside, vec3(1e-9))) - stops.x) / (stops.y - stops.x);
  float side = float(textureSize(tone_table, 0).x);
  vec3 texel = (0.5 + clamp(share, 0.0, 1.0) * (side - 1.0)) / side;
  return texture(tone_table, texel).rgb;
}
#else
vec3 LightOf(vec3 inside) {
#if CURVE == 4
  return min(inside, vec3(1.0));
#else
  float r = PrintedChannel(inside.r), g = PrintedChannel(inside.g), b = PrintedChannel(inside.b);
#if CURVE == 1
  float red = AcesCurve(AcesRed(r, g, b));
  float green = AcesCurve(AcesGreen(r, g, b));
  float blue = AcesCurve(AcesBlue(r, g, b));
  return vec3(AcesLightRed(red, green, blue), AcesLightGreen(red, green, blue),
              AcesLightBlue(red, green, blue));
#else
  float largest = max(r, max(g, b));
#if CURVE == 2
  float y = Luminance(r, g, b);
  return vec3(ReinhardLight(r, largest, y), ReinhardLight(g, largest, y),
              ReinhardLight(b, largest, y));
#else
  float smallest = min(r, min(g, b));
  return vec3(NeutralLight(r, largest, smallest), NeutralLight(g, largest, smallest),
              NeutralLight(b, largest, smallest));
#endif
#endif
#endif
}

vec3 CodesOf(vec3 inside) {
  vec3 light = LightOf(inside);
  return vec3(SrgbCode(light.r), SrgbCode(light.g), SrgbCode(light.b));
}
#endif

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec3 noise = NoiseAt(ivec2(pixel.x, int(screen_size.y) - 1 - pixel.y));
  vec3 rgb = texture(linear_picture, gl_FragCoord.xy / screen_size).rgb;
  vec3 exposed = vec3(ExposedChannel(rgb.r, exposure), ExposedChannel(rgb.g, exposure),
                      ExposedChannel(rgb.b, exposure));
  float y = Luminance(exposed.r, exposed.g, exposed.b);
  float smallest = min(exposed.r, min(exposed.g, exposed.b));
  vec3 inside = vec3(InnerChannel(exposed.r, smallest, y), InnerChannel(exposed.g, smallest, y),
                     InnerChannel(exposed.b, smallest, y));
  vec3 srgb = 255.0 * CodesOf(inside);
  vec3 dithered = vec3(DitheredValue(srgb.r, noise.r), DitheredValue(srgb.g, noise.g),
                       DitheredValue(srgb.b, noise.b));
  display = vec4(floor(dithered + 0.5) / 255.0, 1.0);
}
