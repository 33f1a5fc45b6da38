// A layer of exponential density above the sphere: exp(-(h - base) / H). All lengths have the same
// unit.

SHARED Number LayerDensity(Length above_base, Length H) {
  return exp(LayerLogDensity(above_base, Number(1.0) / H));
}

// Column from altitude h, where the density is `density`, along mu >= 0 to infinity.
SHARED Length LayerColumnUp(Length h, Number mu, Number density, Length H, Length R) {
  return density * H * ChapmanUp((R + h) / H, mu);
}
