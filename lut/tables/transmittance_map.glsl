// This text maps a ray to space to its coordinates in the transmittance table, and back. Lengths
// are in km; R is the planet's radius, top the altitude at which the air ends. Bruneton (2017),
// "Precomputed atmospheric scattering: a new implementation", functions of rho = sqrt(r^2 - R^2)
// and of the distance d to the top:
//
//   u_r  = rho / H                        H = rho at the top
//   u_mu = (d - d_min) / (d_max - d_min)  d_min = top - h, d_max = rho + H (towards the horizon)
//
// They are written here in altitudes, so that single precision is as accurate as double. A unit
// range [0, 1] is stretched over the centres of the first and the last texel.

// Returns the texture coordinate of x in [0, 1] on an axis of n >= 2 texels; UnitFromTexel is the
// inverse.
SHARED Number TexelFromUnit(Number x, Number n) {
  return Number(0.5) / n + x * (Number(1.0) - Number(1.0) / n);
}
SHARED Number UnitFromTexel(Number u, Number n) {
  return (u - Number(0.5) / n) / (Number(1.0) - Number(1.0) / n);
}

SHARED Number UnitFromAltitude(Length h, Length top, Length R) {
  return HorizonDistance(h, R) / HorizonDistance(top, R);
}

// Uses h = rho^2 / (R + r), the conjugate of r - R.
SHARED Length AltitudeFromUnit(Number x, Length top, Length R) {
  Length rho = x * HorizonDistance(top, R);
  return min(rho * rho / (R + sqrt(R * R + rho * rho)), top);
}

// Returns the excess of the longest distance to the top, along the horizon, over the shortest,
// straight up.
SHARED Length SkyDistanceRange(Length h, Length top, Length R) {
  return HorizonDistance(h, R) + HorizonDistance(top, R) - (top - h);
}

// Returns the zenith cosine of the ray from altitude h that covers `excess` more than the shortest
// distance to the top. It uses the law of cosines, with a the distance to the top of the horizontal
// ray:
//   mu = (a^2 - d^2) / (2 r d),  a^2 = (top - h) (2 R + top + h)
// which preserves the small cosines of rays near the horizontal. On the top itself d = 0 is
// straight up.
SHARED Number ZenithCosineFromSkyExcess(Length excess, Length h, Length top, Length R) {
  Length d = top - h + excess;
  Length a = sqrt(max((top - h) * (Number(2.0) * R + top + h), Length(0.0)));
  Number mu = (a - d) * (a + d) / (Number(2.0) * (R + h) * max(d, Length(1e-30)));
  return select(d > Length(0.0), min(max(mu, Number(-1.0)), Number(1.0)), Number(1.0));
}

// Returns the coordinate of rays that miss the ground; 0 straight up, 1 towards the horizon. On the
// top itself every ray upwards has coordinate 0 (and transmittance 1).
SHARED Number UnitFromSkyCosine(Length h, Number mu, Length top, Length R) {
  Number x = (DistanceUpTo(h, mu, top, R) - (top - h)) / SkyDistanceRange(h, top, R);
  return min(max(x, Number(0.0)), Number(1.0));
}
SHARED Number SkyCosineFromUnit(Number x, Length h, Length top, Length R) {
  return ZenithCosineFromSkyExcess(x * SkyDistanceRange(h, top, R), h, top, R);
}
