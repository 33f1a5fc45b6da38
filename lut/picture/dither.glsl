// Noise of the last bit of a picture (develop.h).

// Where a repetition of the tile begins in it: column in
// the lowest bits, row eight bits up. 0 at the origin.
SHARED_BITS Bits DitherHash(Bits tile_x, Bits tile_y) {
  Bits hash = tile_x * 73856093u ^ tile_y * 19349663u;
  hash = (hash ^ (hash >> 13)) * 0x85ebca6bu;
  return hash ^ (hash >> 16);
}

// A code in [0, 255] with noise, to be rounded. Within half a code of the ends there is less room
// for noise: exact black and white stay what they are.
SHARED Number DitheredValue(Number code, Number noise) {
  Number room = min(Number(1.0), min(Number(2.0) * code, Number(2.0) * (Number(255.0) - code)));
  return min(max(code + noise * max(room, Number(0.0)), Number(0.0)), Number(255.0));
}
