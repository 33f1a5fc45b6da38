// SPDX-License-Identifier: MIT
// The passes that show a linear picture on the screen.

//// display.tone_map.frag.glsl
// Tone mapping of the picture for a display: white balance, exposure, gamut, tone curve and dither,
// as in Develop (look.h). AgX is read from its table (display_pass.h). Defined before this text:
// CURVE_ and the name of the tone curve in capitals (CURVE_PBR_NEUTRAL for pbr-neutral); DITHERS, 0
// for codes that display.upscale.frag.glsl reads, else 1.
uniform sampler2D linear_picture;  // any size
uniform sampler3D tone_table;
uniform vec2 stops;        // relative to saturation, at the first and last node of the table
uniform float exposure;
uniform mat3 balance;      // white balance, linear sRGB to linear sRGB
out vec4 display;

#ifdef CURVE_AGX
vec3 CodesOf(vec3 inside) {
  vec3 share = (log2(max(inside, vec3(1e-9))) - stops.x) / (stops.y - stops.x);
  float side = float(textureSize(tone_table, 0).x);
  vec3 texel = (0.5 + clamp(share, 0.0, 1.0) * (side - 1.0)) / side;
  return texture(tone_table, texel).rgb;
}
#else
vec3 LightOf(vec3 inside) {
#ifdef CURVE_LINEAR
  return min(inside, vec3(1.0));
#else
  float r = PrintedChannel(inside.r), g = PrintedChannel(inside.g), b = PrintedChannel(inside.b);
#ifdef CURVE_ACES
  float red = AcesCurve(AcesRed(r, g, b));
  float green = AcesCurve(AcesGreen(r, g, b));
  float blue = AcesCurve(AcesBlue(r, g, b));
  return vec3(AcesLightRed(red, green, blue), AcesLightGreen(red, green, blue),
              AcesLightBlue(red, green, blue));
#else
  float largest = max(r, max(g, b));
#if defined(CURVE_REINHARD)
  float y = Luminance(r, g, b);
  return vec3(ReinhardLight(r, largest, y), ReinhardLight(g, largest, y),
              ReinhardLight(b, largest, y));
#elif defined(CURVE_PBR_NEUTRAL)
  float smallest = min(r, min(g, b));
  return vec3(NeutralLight(r, largest, smallest), NeutralLight(g, largest, smallest),
              NeutralLight(b, largest, smallest));
#else
#error no branch for this tone curve
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
  vec4 found = texture(linear_picture, gl_FragCoord.xy / screen_size);
  vec3 rgb = balance * found.rgb;
  vec3 exposed = vec3(ExposedChannel(rgb.r, exposure), ExposedChannel(rgb.g, exposure),
                      ExposedChannel(rgb.b, exposure));
  float y = Luminance(exposed.r, exposed.g, exposed.b);
  float smallest = min(exposed.r, min(exposed.g, exposed.b));
  vec3 inside = vec3(InnerChannel(exposed.r, smallest, y), InnerChannel(exposed.g, smallest, y),
                     InnerChannel(exposed.b, smallest, y));
#if DITHERS
  display = vec4(Dithered(CodesOf(inside)), 1.0);
#else
  display = vec4(CodesOf(inside), found.a);
#endif
}

//// display.dither.glsl
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

//// display.upscale.frag.glsl
// Upscales a picture that is smaller than the screen. Where the four nearest pixels lie on the same
// surface as this fragment, they are interpolated bilinearly. At an edge of land, whose position
// `outline` holds at screen resolution, the pixels at about the fragment's distance are used.
// DITHERS is 1 for display codes, else 0.
uniform sampler2D small_picture;  // fourth component: InverseDepthOf (gbuffer.inverse_depth.glsl)
uniform sampler2D outline;        // depth of DepthPrepass; of the screen's size
uniform vec2 half_view;           // tangents of half the horizontal and vertical field of view
in vec2 screen;
out vec4 shown;

// Returns the weights of four pixels with inverse depths `near` for a place between them with
// inverse depth `own`.
vec4 WeightsAt(vec2 share, vec4 near, float own) {
  const float kEven = 0.02, kTolerance = 0.01;
  vec2 left = 1.0 - share;
  vec4 weight = vec4(left.x * left.y, share.x * left.y, left.x * share.y, share.x * share.y);
  float between = dot(weight, near);
  vec4 off = (near - own) / max(max(own, between), 1e-9);
  // A minimum weight of a thousandth lets a pixel count if all nearer ones belong to other land.
  vec4 alike = (weight + 1e-3) / (off * off + kTolerance * kTolerance);
  bool is_even = abs(between - own) <= kEven * own;
  return is_even ? weight : alike / dot(alike, vec4(1.0));
}

vec4 SmallAt(vec2 screen, float own) {
  ivec2 last = textureSize(small_picture, 0) - 1;
  vec2 at = clamp((0.5 * screen + 0.5) * vec2(last + 1) - 0.5, vec2(0.0), vec2(last));
  ivec2 low = ivec2(at);
  ivec2 high = min(low + 1, last);
  vec4 a = texelFetch(small_picture, low, 0);
  vec4 b = texelFetch(small_picture, ivec2(high.x, low.y), 0);
  vec4 c = texelFetch(small_picture, ivec2(low.x, high.y), 0);
  vec4 d = texelFetch(small_picture, high, 0);
  vec4 weight = WeightsAt(at - vec2(low), vec4(a.w, b.w, c.w, d.w), own);
  return weight.x * a + weight.y * b + weight.z * c + weight.w * d;
}

void main() {
  float slant = length(vec3(screen * half_view, 1.0));
  float depth = texelFetch(outline, ivec2(gl_FragCoord.xy), 0).x;
  vec4 found = SmallAt(screen, InverseDepthOf(depth, slant));
#if DITHERS
  shown = vec4(Dithered(found.rgb), 1.0);
#else
  shown = found;
#endif
}
