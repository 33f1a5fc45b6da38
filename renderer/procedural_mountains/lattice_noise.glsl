// This text provides gradient noise on a lattice of points with hashed gradients (lattice_noise.h).
// Integers are 32 bits and wrap; positions within a cell are in cells.

// This is the finaliser of MurmurHash3 (Appleby, public domain): every input bit affects every
// output bit.
SHARED_BITS Bits MixedBits(Bits bits) {
  bits ^= bits >> 16;
  bits *= 0x85ebca6bu;
  bits ^= bits >> 13;
  bits *= 0xc2b2ae35u;
  bits ^= bits >> 16;
  return bits;
}

// Returns the hash of a lattice point.
SHARED_BITS Bits LatticePoint(Bits east, Bits north, Bits seed) {
  return MixedBits(east + MixedBits(north + MixedBits(seed + 0x9e3779b9u)));
}

// Returns a component of a lattice point's gradient, uniform in [-1, 1), from half of the hash, in
// steps of 2^-15.
SHARED Number GradientOfHalf(Number half_hash) {
  return half_hash * Number(3.0517578125e-5) - Number(1.0);
}

// Returns the contribution of a corner's gradient at the offset (dx, dy) from the corner.
SHARED Number CornerNoise(Bits corner, Number dx, Number dy) {
  return GradientOfHalf(Number(corner & 0xffffu)) * dx + GradientOfHalf(Number(corner >> 16)) * dy;
}

SHARED Number NoiseFade(Number t) {
  return t * t * t * (t * (t * Number(6.0) - Number(15.0)) + Number(10.0));
}

SHARED Number NoiseFadeSlope(Number t) {
  return Number(30.0) * t * t * (t - Number(1.0)) * (t - Number(1.0));
}

// Returns the corner values weighted by u to the east and v to the north.
SHARED Number NoiseBlend(Number u, Number v, Number sw, Number se, Number nw, Number ne) {
  return (Number(1.0) - v) * ((Number(1.0) - u) * sw + u * se) +
         v * ((Number(1.0) - u) * nw + u * ne);
}

// Returns the noise at (dx, dy) in a cell, from the hashes of its corners.
SHARED Number NoiseInCell(Bits sw, Bits se, Bits nw, Bits ne, Number dx, Number dy) {
  return NoiseBlend(NoiseFade(dx), NoiseFade(dy), CornerNoise(sw, dx, dy),
                    CornerNoise(se, dx - Number(1.0), dy), CornerNoise(nw, dx, dy - Number(1.0)),
                    CornerNoise(ne, dx - Number(1.0), dy - Number(1.0)));
}

// NoiseSlopeEast and NoiseSlopeNorth return the derivatives to the east and to the north, per cell.
SHARED Number NoiseSlopeEast(Bits sw, Bits se, Bits nw, Bits ne, Number dx, Number dy) {
  Number v = NoiseFade(dy);
  Number south = CornerNoise(se, dx - Number(1.0), dy) - CornerNoise(sw, dx, dy);
  Number north =
      CornerNoise(ne, dx - Number(1.0), dy - Number(1.0)) - CornerNoise(nw, dx, dy - Number(1.0));
  return NoiseBlend(NoiseFade(dx), v, GradientOfHalf(Number(sw & 0xffffu)),
                    GradientOfHalf(Number(se & 0xffffu)), GradientOfHalf(Number(nw & 0xffffu)),
                    GradientOfHalf(Number(ne & 0xffffu))) +
         NoiseFadeSlope(dx) * ((Number(1.0) - v) * south + v * north);
}

SHARED Number NoiseSlopeNorth(Bits sw, Bits se, Bits nw, Bits ne, Number dx, Number dy) {
  Number u = NoiseFade(dx);
  Number south =
      (Number(1.0) - u) * CornerNoise(sw, dx, dy) + u * CornerNoise(se, dx - Number(1.0), dy);
  Number north = (Number(1.0) - u) * CornerNoise(nw, dx, dy - Number(1.0)) +
                 u * CornerNoise(ne, dx - Number(1.0), dy - Number(1.0));
  return NoiseBlend(u, NoiseFade(dy), GradientOfHalf(Number(sw >> 16)),
                    GradientOfHalf(Number(se >> 16)), GradientOfHalf(Number(nw >> 16)),
                    GradientOfHalf(Number(ne >> 16))) +
         NoiseFadeSlope(dy) * (north - south);
}

// Returns the noise of NoiseInCell with fewer operations, for images. The heights of the range use
// NoiseInCell, because they depend on every bit of it. Gradients are h * 2^-15 - 1; the terms of
// -1, weighted by the fades u and v, sum to dx - u + dy - v.
SHARED Number CornerOfHash(Bits corner, Number dx, Number dy) {
  return Number(corner & 0xffffu) * dx + Number(corner >> 16) * dy;
}

SHARED Number NoiseOfHashes(Bits sw, Bits se, Bits nw, Bits ne, Number dx, Number dy) {
  Number u = NoiseFade(dx);
  Number v = NoiseFade(dy);
  Number hashes = NoiseBlend(u, v, CornerOfHash(sw, dx, dy), CornerOfHash(se, dx - Number(1.0), dy),
                             CornerOfHash(nw, dx, dy - Number(1.0)),
                             CornerOfHash(ne, dx - Number(1.0), dy - Number(1.0)));
  return hashes * Number(3.0517578125e-5) - (dx - u + (dy - v));
}

SHARED Number SlopeOfHashesEast(Bits sw, Bits se, Bits nw, Bits ne, Number dx, Number dy) {
  Number v = NoiseFade(dy);
  Number fade_slope = NoiseFadeSlope(dx);
  Number south = CornerOfHash(se, dx - Number(1.0), dy) - CornerOfHash(sw, dx, dy);
  Number north =
      CornerOfHash(ne, dx - Number(1.0), dy - Number(1.0)) - CornerOfHash(nw, dx, dy - Number(1.0));
  Number hashes = NoiseBlend(NoiseFade(dx), v, Number(sw & 0xffffu), Number(se & 0xffffu),
                             Number(nw & 0xffffu), Number(ne & 0xffffu)) +
                  fade_slope * ((Number(1.0) - v) * south + v * north);
  return hashes * Number(3.0517578125e-5) - (Number(1.0) - fade_slope);
}

SHARED Number SlopeOfHashesNorth(Bits sw, Bits se, Bits nw, Bits ne, Number dx, Number dy) {
  Number u = NoiseFade(dx);
  Number fade_slope = NoiseFadeSlope(dy);
  Number south =
      (Number(1.0) - u) * CornerOfHash(sw, dx, dy) + u * CornerOfHash(se, dx - Number(1.0), dy);
  Number north = (Number(1.0) - u) * CornerOfHash(nw, dx, dy - Number(1.0)) +
                 u * CornerOfHash(ne, dx - Number(1.0), dy - Number(1.0));
  Number hashes = NoiseBlend(u, NoiseFade(dy), Number(sw >> 16), Number(se >> 16), Number(nw >> 16),
                             Number(ne >> 16)) +
                  fade_slope * (north - south);
  return hashes * Number(3.0517578125e-5) - (Number(1.0) - fade_slope);
}
