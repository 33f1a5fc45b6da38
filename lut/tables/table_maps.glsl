// This text maps rays to their coordinates in the tables of transmittance and of scattering, and
// back. Lengths are in km; R is the planet's radius, top the altitude at which the air ends.
//
// ---- A ray to space in the transmittance table --------------------------------------------------
//
// Bruneton (2017), "Precomputed atmospheric scattering: a new implementation", functions of
// rho = sqrt(r^2 - R^2) and of the distance d to the top:
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

// ---- A view ray in the four-dimensional scattering table ----------------------------------------
//
//   r     as in the transmittance table
//   mu    two halves, divided by the horizon: below 1/2 rays that hit the ground, by the distance
//         d to it, u = (d - h) / (rho - h), 0 straight down, 1 at the horizon; above 1/2 rays to
//         space, as in the transmittance table. Both halves begin at the middle of the axis and end
//         at the horizon, so that no look-up mixes them.
//   mu_s  by the distance to the top along the sunbeam from the ground,
//         a = (d - d_min) / (d_max - d_min):
//         u = max(1 - a / A, 0) / (1 + a), A = a of the lowest sun of the table
//   nu    (nu + 1) / 2
//
// After Bruneton and Neyret (2008), Computer Graphics Forum 27, 1079, and Bruneton (2017).

// Returns 0 straight down, 1 at the horizon. On the ground itself every ray has length 0 and
// coordinate 0.
SHARED Number UnitFromGroundCosine(Length h, Number mu, Length R) {
  Length rho = HorizonDistance(h, R);
  Number x = (DistanceDownTo(h, mu, Length(0.0), R) - h) / max(rho - h, Length(1e-30));
  return select(h > Length(0.0), min(max(x, Number(0.0)), Number(1.0)), Number(0.0));
}

// Uses the law of cosines, -mu = (rho^2 + d^2) / (2 r d), which has no cancellation. On the ground
// itself the ray points straight down.
SHARED Number GroundCosineFromUnit(Number x, Length h, Length R) {
  Length rho = HorizonDistance(h, R);
  Length d = h + x * (rho - h);
  Number down = (rho / max(d, Length(1e-30)) * rho + d) / (Number(2.0) * (R + h));
  return select(h > Length(0.0), max(-down, Number(-1.0)), Number(-1.0));
}

// Returns the texture coordinate on the mu axis of n texels (even, >= 4) from the unit of its half;
// `ground` is 1 for rays that hit the ground.
SHARED Number MuTexelFromUnit(Number x, Number ground, Number n) {
  Number half_axis = Number(0.5) * TexelFromUnit(x, Number(0.5) * n);
  return select(ground > Number(0.5), Number(0.5) - half_axis, Number(0.5) + half_axis);
}
SHARED Number GroundFromMuTexel(Number u) {
  return select(u < Number(0.5), Number(1.0), Number(0.0));
}
SHARED Number UnitFromMuTexel(Number u, Number n) {
  return UnitFromTexel(abs(Number(2.0) * u - Number(1.0)), Number(0.5) * n);
}

// Returns the length of the sunbeam that reaches the ground, in units in which the vertical one is
// 0 and the horizontal one 1.
SHARED Number SunbeamExcess(Number mu_s, Length top, Length R) {
  return (DistanceUpTo(Length(0.0), mu_s, top, R) - top) / SkyDistanceRange(Length(0.0), top, R);
}
SHARED Number UnitFromSunCosine(Number mu_s, Number mu_s_min, Length top, Length R) {
  Number a = SunbeamExcess(mu_s, top, R);
  Number lowest = SunbeamExcess(mu_s_min, top, R);
  return max(Number(1.0) - a / lowest, Number(0.0)) / (Number(1.0) + a);
}
SHARED Number SunCosineFromUnit(Number x, Number mu_s_min, Length top, Length R) {
  Number lowest = SunbeamExcess(mu_s_min, top, R);
  Number a = lowest * (Number(1.0) - x) / (Number(1.0) + x * lowest);
  return ZenithCosineFromSkyExcess(a * SkyDistanceRange(Length(0.0), top, R), Length(0.0), top, R);
}

SHARED Number UnitFromScatteringCosine(Number nu) { return Number(0.5) * (nu + Number(1.0)); }
SHARED Number ScatteringCosineFromUnit(Number x) { return Number(2.0) * x - Number(1.0); }

// Returns the cosine between view and sun that is nearest to nu among those possible for their
// zenith cosines.
SHARED Number PossibleScatteringCosine(Number nu, Number mu, Number mu_s) {
  Number sines = sqrt(
      max((Number(1.0) - mu) * (Number(1.0) + mu) * (Number(1.0) - mu_s) * (Number(1.0) + mu_s),
          Number(0.0)));
  return min(max(nu, mu * mu_s - sines), mu * mu_s + sines);
}
