// Fog of exponential density over the sphere: exp(-(h - base) / H). Lengths in one unit.

SHARED Number FogDensity(Length above_base, Length H) {
  return exp(LayerLogDensity(above_base, Number(1.0) / H));
}

// Column from altitude h, where that is the density, along mu >= 0 to infinity.
SHARED Length FogColumnUp(Length h, Number mu, Number density, Length H, Length R) {
  return density * H * ChapmanUp((R + h) / H, mu);
}
