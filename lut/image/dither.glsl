// This text provides the dither noise of 8-bit images (development.h).

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
