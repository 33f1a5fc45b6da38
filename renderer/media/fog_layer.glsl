// Fog of exponential density over the sphere: exp(-(h - base) / H). Lengths in one unit.

// Far below its base fog is a wall; e^80 of it can still be multiplied by what follows.
SHARED Number FogDensity(Length above_base, Length H) {
  return exp(min(-above_base / H, Number(80.0)));
}

// Column from altitude h, where that is the density, along mu >= 0 to infinity.
SHARED Length FogColumnUp(Length h, Number mu, Number density, Length H, Length R) {
  return density * H * ChapmanUp((R + h) / H, mu);
}
