// SPDX-License-Identifier: MIT
// Tone mapping of the picture for a display: white balance, exposure, gamut, tone curve and dither,
// as in Develop (look.h). AgX is read from its table (display_pass.h). Defined before this text:
// CURVE_ and the name of the tone curve in capitals (CURVE_PBR_NEUTRAL for pbr-neutral); DITHERS, 0
// for codes that display/upscale.frag.glsl reads, else 1.
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
