// Distances between places of a sphere by their latitudes and longitudes.

// Returns the square of the chord between two places of a sphere of radius 1, by the haversine
// formula, which is exact for small angles. A place beyond a pole counts as the pole.
// @param across  sine of half the angle between their meridians.
// @param south  sine of half the angle by which the second place is south of the first.
// @param sin_latitude, cos_latitude  of the first place.
SHARED Number ChordSquare(Number across, Number south, Number sin_latitude, Number cos_latitude) {
  Number turned = Number(2.0) * south * sqrt(max(Number(1.0) - south * south, Number(0.0)));
  Number cosine = cos_latitude * (Number(1.0) - Number(2.0) * south * south) + sin_latitude * turned;
  return Number(4.0) *
         (south * south + cos_latitude * max(cosine, Number(0.0)) * across * across);
}
