// Formulas of relief finer than an elevation model (relief.h). Lengths are in metres. A wavelength
// is that of an octave; `spacing` is that of the model's samples. OctaveShare and SmoothRise are
// those of ground_cover.glsl.

// Octaves of gullies have cells of 1024, 512, ..., 16 m, and 1.7 stripes per cell. All lattices
// have cells of a power of two, which divide a block of 1024 m: indices of cells are exact.
SHARED_CONSTANT int kBlock_m = 1024;
SHARED_CONSTANT int kGullyOctaves = 7;
SHARED_CONSTANT int kSoftOctaves = 5;  // soil is smooth below waves of 38 m
SHARED_CONSTANT int kCragCell_m = 32;  // and 16, 8, 4, 2 m
SHARED_CONSTANT int kCragOctaves = 5;
SHARED_CONSTANT int kBandHeight_m = 32;  // and 8 m
SHARED_CONSTANT int kBandOctaves = 2;
SHARED_CONSTANT int kRaggedCell_m = 64;  // and 32, ..., 2 m
SHARED_CONSTANT int kRaggedOctaves = 6;

// Fraction of an octave that a model lacks. Its samples represent waves of four spacings and more,
// and none below two.
SHARED Number MissingShare(Length wavelength, Length spacing) {
  return Number(1.0) - OctaveShare(wavelength, spacing);
}

// Part of an octave's variance that a footprint removes, of an octave with a share.
SHARED Number UnresolvedPart(Number share) { return Number(1.0) - share * share; }

// Sine of a quarter of a turn times x in [-1, 1]: Taylor's series, with an error below 4e-6.
SHARED Number QuarterTurnSine(Number x) {
  Number y = x * x;
  return x * (Number(1.5707963268) +
              y * (Number(-0.6459640975) +
                   y * (Number(0.0796926262) +
                        y * (Number(-0.0046817541) + y * Number(0.0001604412)))));
}

// Sine of a number of turns in [-1/2, 1/2].
SHARED Number SineOfTurns(Number turns) {
  Number x = Number(4.0) * turns;
  Number folded = select(x > Number(1.0), Number(2.0) - x, x);
  return QuarterTurnSine(select(x < Number(-1.0), Number(-2.0) - x, folded));
}

// Weight of a cell of stripes at a squared distance from its centre, in cells. Centres lie in the
// middle six tenths of their cells, so that the weights of all but 3 x 3 cells are 0.
SHARED Number StripeKernel(Number squared_distance) {
  Number t = max(Number(1.0) - squared_distance / Number(1.44), Number(0.0));
  return t * t * t;
}

// Place of a centre in its cell along one axis, and stripes of a cell per cell, from 16 and 8
// random bits. Unequal stripes keep gullies from looking like pleats.
SHARED Number StripeCentre(Number half_hash) {
  return Number(0.2) + half_hash * Number(9.1552734375e-6);
}
SHARED Number StripesPerCell(Number byte) {
  return Number(1.7) * (Number(0.72) + byte * Number(0.0021875));
}

// Profile of gullies with sharp crests and round floors by the cosine of their phase. The mean of
// the root is 0.65068.
SHARED Number GullyRoot(Number cosine) {
  return sqrt(Number(0.5) * (Number(1.0) - Number(0.95) * cosine));
}
SHARED Number GullyProfile(Number root) { return Number(1.5) * (Number(0.65068) - root); }
// Its derivative by the phase in radians.
SHARED Number GullyProfileSlope(Number root, Number sine) { return Number(-0.35625) * sine / root; }

// Half height of an octave of gullies in rock at full strength. All octaves have the same slopes;
// bands and crags add to the short ones.
SHARED Length GullyHeight(Length wavelength) { return Number(0.14) * wavelength; }

// Half height of an octave of soil relative to rock. It falls below the length of hillslopes, where
// creep of soil removes relief (Perron, Kirchner, Dietrich 2008, J. Geophys. Res. 113, F04003).
SHARED Number SoftPart(Length wavelength) {
  return Number(0.36) * min(wavelength / Length(150.0), Number(1.0));
}

// Strength of gullies on a slope. Cliffs have fewer of them: a gully along the fall line of a cliff
// is a vertical stripe in pictures, and crags take its place.
SHARED Number GullyStrength(Number slope, Number patches, Number ice) {
  Number steep = SmoothRise(Number(0.12), Number(0.75), slope) *
                 (Number(1.0) - Number(0.65) * SmoothRise(Number(1.0), Number(2.0), slope));
  Number uneven = Number(0.78) + Number(0.5) * SmoothRise(Number(-0.5), Number(0.5), patches);
  return steep * uneven * (Number(1.0) - Number(0.85) * ice);
}

// Fraction of a slope's forms that are of rock, and fraction of rock that is broken into crags.
SHARED Number StonyRise(Number slope, Number patches) {
  return SmoothRise(Number(0.30), Number(0.85), slope + Number(0.12) * patches);
}
SHARED Number CraggyRise(Number slope, Number patches) {
  return SmoothRise(Number(0.30), Number(0.85), slope + Number(0.25) * patches);
}

// Height of an octave of crags, a crease where the noise of its cells is 0, and of an octave of
// bands by the sine of its phase. Crags steepen the ground, so that they are lower on cliffs.
SHARED Length CragHeight(Length cell, Number noise_size, Number slope) {
  return Number(0.16) * cell * (noise_size - Number(0.2101)) / (Number(1.0) + Number(0.5) * slope);
}
SHARED Length BandHeight(Length height, Number sine) { return Number(0.08) * height * sine; }

// Thickness of debris over rock. It lies up to its angle of repose (36 degrees where it is cold,
// 45 degrees where plants hold soil), and fills hollows.
SHARED Length DebrisThickness(Number cold, Number model_slope, Number slope, Number hollow,
                              Number patches, Number fine) {
  Number steepest = Number(1.0) - Number(0.28) * cold;
  return Length(9.0) * (steepest - Number(0.65) * model_slope - Number(0.35) * slope) +
         Length(2.5) * hollow + Length(1.6) * patches + Length(2.0) * fine;
}
SHARED Length LargestDebris(Number patches) { return Length(1.7) + Length(0.5) * patches; }

// Fraction of the ground under firn and ice, which fill gullies, by the height above the snow line.
SHARED Number IceShare(Length above_line, Number slope) {
  return SmoothRise(Length(50.0), Length(600.0), above_line) *
         (Number(1.0) - SmoothRise(Number(0.75), Number(1.15), slope));
}

// Depth of snow by the height above its line.
// `too_steep` is the part of the slope beyond 0.95.
SHARED Length SnowDepth(Length above_line, Number ice, Number hollow, Number valley,
                        Number too_steep) {
  Number gathered = min(above_line / Length(260.0), Number(1.4) + Number(1.2) * ice);
  return Length(3.4) * gathered + Length(2.0) * hollow + Length(1.8) * valley -
         Length(7.0) * too_steep;
}

// Fraction of ground with debris that is scree rather than soil, before the threshold of 1/2. Where
// it is warm, plants hold most of the steep ground.
SHARED Number ScreeTendency(Number cold, Number slope, Number hollow, Number valley, Number patches,
                            Number fine) {
  Number steep = SmoothRise(Number(0.5), Number(0.95), slope) *
                 (Number(0.6) + Number(0.8) * hollow + Number(0.5) * valley);
  return cold - Number(0.2) + (Number(0.35) + Number(0.65) * cold) * steep +
         Number(0.75) * patches + Number(0.8) * fine;
}

// Fraction of soil under wood, before the threshold of 0.
SHARED Number WoodTendency(Number treeless, Number slope, Number patches, Number fine) {
  return Number(0.35) - Number(1.6) * treeless -
         Number(1.2) * SmoothRise(Number(0.9), Number(1.3), slope) + Number(0.6) * patches +
         Number(0.5) * fine;
}

// Probability that a normal variable of a root mean square is below a value: the logistic
// distribution, which differs from the normal one by at most 0.0095 (Johnson, Kotz, Balakrishnan
// 1995, Continuous Univariate Distributions 2, ch. 23).
SHARED Number ShareAbove(Number value, Number rms) {
  return Number(1.0) / (Number(1.0) + exp(min(Number(-1.702) * value / rms, Number(60.0))));
}

// Mean of that variable, in units of its root mean square, where it is not the larger one: the
// density at the threshold over the rest.
SHARED Number HazardOfShare(Number share) { return Number(-1.702) * share; }

// Mean of the larger one of two uncertain heights, `above` a second one with their difference
// uncertain by `rms`: the integral of ShareAbove, within 0.02 rms of Clark (1961), Operations
// Research 9, 145, eq. 1.
SHARED Length MeanOfHigher(Length above, Length rms) {
  Number x = Number(1.702) * above / rms;
  Number larger = max(x, Number(0.0));
  return rms / Number(1.702) * (larger + log(Number(1.0) + exp(x - Number(2.0) * larger)));
}
