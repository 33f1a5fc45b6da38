// SPDX-License-Identifier: MIT
// This text provides the tone curves: from exposed linear sRGB (1 saturates) to linear light of an
// sRGB display in [0, 1]. Each function returns one channel and is called three times. Dither noise
// is added to the code values.
//
//   scene rgb --ExposedChannel--> exposed --InnerChannel--> no negative channel
//     --PrintedChannel--> middle grey at 0.18 --curve--> display light --SrgbCode--> code value
//
// Only "linear" omits PrintedChannel: it shows which values saturate.
//
// Colours outside the display's gamut (a negative channel) keep their luminance and are mixed with
// the grey of that luminance until the smallest channel is 0. All curves are finite for every
// finite input.

// Returns the relative luminance of linear sRGB. IEC 61966-2-1.
SHARED Number Luminance(Number red, Number green, Number blue) {
  return Number(0.2126) * red + Number(0.7152) * green + Number(0.0722) * blue;
}

// Returns the exposed channel. Far beyond white all curves are flat; the bound keeps squares finite
// in float.
SHARED Number ExposedChannel(Number value, Number scale) {
  return min(max(value * scale, Number(-1.0e6)), Number(1.0e6));
}

// Mixes a channel with the grey of luminance y so that the smallest channel becomes 0. Colours of
// zero or negative luminance become black.
SHARED Number InnerChannel(Number value, Number smallest, Number y) {
  Number share = max(y, Number(0.0)) / max(y - smallest, Number(1.0e-30));
  Number mixed = select(y > Number(0.0), y + (value - y) * share, Number(0.0));
  return max(select(smallest < Number(0.0), mixed, value), Number(0.0));
}

// Metered middle grey, 12.5/100 2^EV, is 0.104 of saturation, 1.2 2^EV. Curves with a shoulder
// print it at 0.18, as cameras do (standard output sensitivity, ISO 12232): 0.18 * 1.2 * 100 / 12.5
// = 1.728.
SHARED Number PrintedChannel(Number exposed) { return Number(1.728) * exposed; }

// ---- AgX: Sobotka (2022), https://github.com/sobotka/AgX --------------------------------------
//
// The primaries of sRGB move a fifth of the way to white on the chromaticity diagram ("inset"),
// the channels are encoded in 16.5 stops around middle grey, pass a sigmoid, and the inset is
// undone. On the chromaticity diagram colours mix in proportion to X + Y + Z, so the inset of a
// channel is 0.8 of itself and 0.2 of the colour's share of white's X + Y + Z:

// (X + Y + Z of the colour) / (X + Y + Z of D65 white), from the chromaticities of the primaries.
SHARED Number AgxWhiteShare(Number red, Number green, Number blue) {
  return Number(0.21199464526) * red + Number(0.39215082552) * green + Number(0.39585452922) * blue;
}

SHARED Number AgxInset(Number value, Number white_share) {
  return Number(0.8) * value + Number(0.2) * white_share;
}

// The inset leaves the share unchanged, so the inverse needs only the share.
SHARED Number AgxOutset(Number value, Number white_share) {
  return Number(1.25) * value - Number(0.25) * white_share;
}

// Returns log2 of the channel over [-12.47393, 4.026069]: from 10 stops below to 6.5 above middle
// grey 0.18.
SHARED Number AgxLogCode(Number value) {
  Number stops = log(max(value, Number(1.0e-6))) * Number(1.4426950408889634);
  Number code = (stops + Number(12.47393)) / Number(16.499999);
  return min(max(code, Number(0.0)), Number(1.0));
}

// Multiplies the distance [stops] from middle grey, at code 20/33, by a contrast.
SHARED Number AgxContrast(Number code, Number contrast) {
  Number grey = Number(0.6060606060606061);
  return min(max(grey + (code - grey) * contrast, Number(0.0)), Number(1.0));
}

// This equals AgxContrast below middle grey. Above it the contrast fades, so that the white of the
// encoding stays 6.5 stops over grey, and bright skies keep their gradient: with x from 0 at grey
// to 1 at white, c x / (1 + (c^3 - 1) x^3)^(1/3), which is within 1 % of c x up to 1.1 stops for c
// = 1.8.
SHARED Number AgxContrastWithShoulder(Number code, Number contrast) {
  Number grey = Number(0.6060606060606061);
  Number x = max(code - grey, Number(0.0)) / (Number(1.0) - grey);
  Number bend = (contrast * contrast * contrast - Number(1.0)) * x * x * x;
  Number above = contrast * x * pow(Number(1.0) + bend, Number(-0.3333333333333333));
  return select(code < grey, AgxContrast(code, contrast), grey + (Number(1.0) - grey) * above);
}

// The exact sigmoid of AgX: 0.5 + s x / (1 + a |x|^b)^(1/b), x = code - 20/33, slope s = 2 at
// middle grey, b = 3 below and 13/4 above; a makes it end in (0, 0) and (1, 1):
//   below: a = 4^3 - (33/20)^3 = 59.507875,  above: a = 4^(13/4) - (33/13)^(13/4) = 69.8628.
SHARED Number AgxSigmoid(Number code) {
  Number x = code - Number(0.6060606060606061);
  Number distance = abs(x);
  Number below = pow(Number(1.0) + Number(59.507875) * distance * distance * distance,
                     Number(-0.3333333333333333));
  Number above = pow(
      Number(1.0) + Number(69.86278913545539) * pow(max(distance, Number(1.0e-20)), Number(3.25)),
      Number(-0.3076923076923077));
  Number display = Number(0.5) + Number(2.0) * x * select(x < Number(0.0), below, above);
  return min(max(display, Number(0.0)), Number(1.0));
}

// Returns display light from the codes, which are made for a display of exponent 2.2; code_share is
// AgxWhiteShare of the three codes.
SHARED Number AgxLight(Number code, Number code_share) {
  Number value = min(max(AgxOutset(code, code_share), Number(0.0)), Number(1.0));
  return pow(max(value, Number(1.0e-6)), Number(2.2)) *
         select(value > Number(1.0e-6), Number(1.0), Number(0.0));
}

// Adds the toe of a print. In deep shade the sigmoid approaches black as a power of the scene's
// light; with the toe display light becomes proportional to scene light, by a factor `share`. The
// toe saturates above middle grey: it adds at most 0.18 times the share.
SHARED Number AgxWithToe(Number light, Number printed, Number share) {
  Number toe = share * printed / (Number(1.0) + printed / Number(0.18));
  return min(sqrt(light * light + toe * toe), Number(1.0));
}

// ---- ACES: fit of RRT and sRGB ODT by Hill (2016), published in Pettineo's BakingLab ------------
//
// Each channel of the matrix product is one call with that row.

SHARED Number RowTimes(Number a, Number b, Number c, Number red, Number green, Number blue) {
  return a * red + b * green + c * blue;
}

SHARED Number AcesRed(Number red, Number green, Number blue) {
  return RowTimes(Number(0.59719), Number(0.35458), Number(0.04823), red, green, blue);
}

SHARED Number AcesGreen(Number red, Number green, Number blue) {
  return RowTimes(Number(0.07600), Number(0.90834), Number(0.01566), red, green, blue);
}

SHARED Number AcesBlue(Number red, Number green, Number blue) {
  return RowTimes(Number(0.02840), Number(0.13383), Number(0.83777), red, green, blue);
}

SHARED Number AcesCurve(Number value) {
  Number above = value * (value + Number(0.0245786)) - Number(0.000090537);
  Number below = value * (Number(0.983729) * value + Number(0.4329510)) + Number(0.238081);
  return above / below;
}

SHARED Number AcesLightRed(Number red, Number green, Number blue) {
  Number value = RowTimes(Number(1.60475), Number(-0.53108), Number(-0.07367), red, green, blue);
  return min(max(value, Number(0.0)), Number(1.0));
}

SHARED Number AcesLightGreen(Number red, Number green, Number blue) {
  Number value = RowTimes(Number(-0.10208), Number(1.10813), Number(-0.00605), red, green, blue);
  return min(max(value, Number(0.0)), Number(1.0));
}

SHARED Number AcesLightBlue(Number red, Number green, Number blue) {
  Number value = RowTimes(Number(-0.00327), Number(-0.07276), Number(1.07602), red, green, blue);
  return min(max(value, Number(0.0)), Number(1.0));
}

// ---- Reinhard, Stark, Shirley, Ferwerda (2002), equation 4, of luminance ------------------------
//
// Luminance 4 (two stops over saturation) becomes white. A channel that still exceeds 1 is mixed
// with the grey of the same luminance.

SHARED Number ReinhardLuminance(Number y) {
  return min(y * (Number(1.0) + y / Number(16.0)) / (Number(1.0) + y), Number(1.0));
}

// @param y luminance of the printed colour, largest its largest channel.
SHARED Number ReinhardLight(Number value, Number largest, Number y) {
  Number mapped = ReinhardLuminance(y);
  Number scale = mapped / max(y, Number(1.0e-20));
  Number top = largest * scale;
  Number share = (Number(1.0) - mapped) / max(top - mapped, Number(1.0e-20));
  Number inside = mapped + (value * scale - mapped) * min(share, Number(1.0));
  return min(max(inside, Number(0.0)), Number(1.0));
}

// ---- Khronos PBR Neutral tone mapper (2024), specification in KhronosGroup/ToneMapping --
//
// Colours below 0.8 keep their hue and brightness except for the 0.04 that a dielectric reflects.

SHARED Number NeutralOffset(Number smallest) {
  return select(smallest < Number(0.08), smallest - Number(6.25) * smallest * smallest,
                Number(0.04));
}

// @param largest and smallest channel of the printed colour.
SHARED Number NeutralLight(Number value, Number largest, Number smallest) {
  Number offset = NeutralOffset(smallest);
  Number peak = largest - offset;
  Number start = Number(0.76);
  Number room = Number(0.24);
  Number new_peak = Number(1.0) - room * room / (max(peak, start) + room - start);
  Number grey =
      Number(1.0) - Number(1.0) / (Number(0.15) * (max(peak, start) - new_peak) + Number(1.0));
  Number scaled = (value - offset) * new_peak / max(peak, start);
  Number compressed = scaled + (new_peak - scaled) * grey;
  Number light = select(peak < start, value - offset, compressed);
  return min(max(light, Number(0.0)), Number(1.0));
}

// ---- The display --------------------------------------------------------------------------------

// Returns the code value in [0, 1] of linear light in [0, 1]. IEC 61966-2-1.
SHARED Number SrgbCode(Number light) {
  Number bounded = min(max(light, Number(0.0)), Number(1.0));
  Number curved = Number(1.055) * pow(max(bounded, Number(0.0031308)), Number(0.4166666666666667)) -
                  Number(0.055);
  return select(bounded <= Number(0.0031308), Number(12.92) * bounded, curved);
}

// Returns linear light in [0, 1] of a code value in [0, 1]. IEC 61966-2-1.
SHARED Number SrgbLight(Number code) {
  Number bounded = min(max(code, Number(0.0)), Number(1.0));
  Number curved = pow((max(bounded, Number(0.04045)) + Number(0.055)) / Number(1.055), Number(2.4));
  return select(bounded <= Number(0.04045), bounded / Number(12.92), curved);
}

// ---- Dither noise of 8-bit images (dither.h) ----------------------------------------------------

// Returns the place in the tile at which a repetition of it begins: column in the lowest bits, row
// eight bits up. It is 0 at the origin.
SHARED_BITS Bits DitherHash(Bits tile_x, Bits tile_y) {
  Bits hash = tile_x * 73856093u ^ tile_y * 19349663u;
  hash = (hash ^ (hash >> 13)) * 0x85ebca6bu;
  return hash ^ (hash >> 16);
}

// Returns a code in [0, 255] with noise, before rounding. Within half a code of the ends the noise
// is reduced, so that exact black and white are unchanged.
SHARED Number DitheredValue(Number code, Number noise) {
  Number room = min(Number(1.0), min(Number(2.0) * code, Number(2.0) * (Number(255.0) - code)));
  return min(max(code + noise * max(room, Number(0.0)), Number(0.0)), Number(255.0));
}
