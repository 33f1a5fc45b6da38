// Cosine of the azimuth between two directions of zenith cosines mu and mu_s that enclose an angle
// of cosine nu:
//
//   nu = mu mu_s + sines cos(azimuth)          spherical law of cosines
//
// `sines` is the product of the sines of both zenith angles, > 0. Callers decide what holds where a
// direction is vertical.
SHARED Number AzimuthCosine(Number mu, Number mu_s, Number nu, Number sines) {
  return min(max((nu - mu * mu_s) / sines, Number(-1.0)), Number(1.0));
}
