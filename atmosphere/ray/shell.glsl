// Geometry of rays in a spherical shell. Altitudes and distances in km, radius R of the planet in
// km.
//
// Every formula uses the altitude h, never the radius r = R + h, and never forms r^2: in single
// precision sqrt(r^2 - R^2) at 2 m is wrong by 3 %, sqrt(h (2 R + h)) is not. Differences of
// squares are factored and quadratic roots are computed in conjugate form.

// Returns the altitude at distance d along the ray from altitude h with zenith cosine mu:
//   q = d (d + 2 r mu),   h + q / (sqrt(r^2 + q) + r).
SHARED Length AltitudeAlongRay(Length h, Number mu, Length d, Length R) {
  Length r = R + h;
  Length q = d * (d + Number(2.0) * r * mu);
  return h + q / (sqrt(r * r + q) + r);
}

// Returns the cosine of the zenith angle of the ray's direction at distance d, where the altitude
// is h_d.
SHARED Number ZenithCosineAlongRay(Length h, Number mu, Length d, Length h_d, Length R) {
  Number cosine = ((R + h) * mu + d) / (R + h_d);
  return min(max(cosine, Number(-1.0)), Number(1.0));
}

// Returns the cosine of the zenith angle of a fixed direction (the sun) at distance d along a ray;
// it is mu_s at the origin of the ray, and nu is the cosine between the ray and that direction.
SHARED Number SunCosineAlongRay(Length h, Number mu_s, Number nu, Length d, Length h_d, Length R) {
  Number cosine = ((R + h) * mu_s + d * nu) / (R + h_d);
  return min(max(cosine, Number(-1.0)), Number(1.0));
}

// Returns the distance to the horizon from altitude h >= 0: sqrt(r^2 - R^2).
SHARED Length HorizonDistance(Length h, Length R) {
  return sqrt(max(h * (Number(2.0) * R + h), Length(0.0)));
}

// Returns the cosine of the zenith angle of the horizon from altitude h >= 0.
SHARED Number HorizonCosine(Length h, Length R) { return -HorizonDistance(h, R) / (R + h); }

// Returns the lowest altitude of the whole line through the point: h - r mu^2 / (1 + sin(chi)).
SHARED Length PerigeeAltitude(Length h, Number mu, Length R) {
  Number sine = sqrt(max((Number(1.0) - mu) * (Number(1.0) + mu), Number(0.0)));
  return h - (R + h) * mu * mu / (Number(1.0) + sine);
}

// Returns the distance at which the ray finally leaves altitude z >= h (its last crossing,
// upwards).
SHARED Length DistanceUpTo(Length h, Number mu, Length z, Length R) {
  Length a = (R + h) * mu;
  Length b = max((z - h) * (Number(2.0) * R + z + h), Length(0.0));
  Length root = sqrt(a * a + b);
  return select(a > Length(0.0), b / max(a + root, Length(1e-30)), root - a);
}

// Returns the distance at which a descending ray first reaches altitude z <= h; meaningful only if
// it does, that is if mu < 0 and the perigee lies below z. For a perigee within rounding of z the
// root is clamped to 0.
SHARED Length DistanceDownTo(Length h, Number mu, Length z, Length R) {
  Length a = (R + h) * mu;
  Length c = max((h - z) * (Number(2.0) * R + h + z), Length(0.0));
  Length s = sqrt(c);
  Length root = sqrt(max((-a - s) * (-a + s), Length(0.0)));
  return c / max(-a + root, Length(1e-30));
}

// Returns a positive value if the ray from altitude h >= 0 hits the ground:
// |r mu| > sqrt(r^2 - R^2), downwards. A horizontal ray at altitude 0 does not; a ray below the
// horizontal does there, at distance 0.
SHARED Length GroundClearance(Length h, Number mu, Length R) {
  return select(mu < Number(0.0), -(R + h) * mu - HorizonDistance(h, R), Length(-1.0));
}
