// This text maps a view ray to its coordinates in the four-dimensional scattering table, and back.
// Lengths are in km. It is included after transmittance_map.glsl, which provides the coordinates of
// altitude and of rays to space.
//
//   r     as in the transmittance map
//   mu    two halves, divided by the horizon: below 1/2 rays that hit the ground, by the distance
//         d to it, u = (d - h) / (rho - h), 0 straight down, 1 at the horizon; above 1/2 rays to
//         space, as in the transmittance map. Both halves begin at the middle of the axis and end
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
