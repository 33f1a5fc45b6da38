// Lift of land by refraction: the angle at the observer between the ray from a place, and the
// straight line to the place.
//
// A ray of curvature k has the height k D^2 t (1 - t) / 2 above its chord of length D at its
// fraction t, and the angle between both at the observer is
//
//   D integral of k(t) (1 - t) from t = 0 to 1,
//
// which is computed with the three nodes of Gauss-Jacobi quadrature, at the heights of a ray with a
// given constant curvature. Above `top` rays are straight: D is then the length of the chord below
// it. At the upper end of this chord, the height of the ray above the chord is the angle at the
// observer times the distance above.

// Returns the curvature of level rays [1/km] at an altitude: the sum of three layers,
// slope_i exp(-fall_i h).
SHARED Number CurvatureAt(Length h, Number slope_1, Number slope_2, Number slope_3, Number fall_1,
                          Number fall_2, Number fall_3) {
  Length over = max(h, Length(-1.0));
  return slope_1 * exp(-fall_1 * over) + slope_2 * exp(-fall_2 * over) +
         slope_3 * exp(-fall_3 * over);
}

// Returns the length of the initial part of the straight line from altitude h0 to h1, of length d,
// that lies above an altitude.
SHARED Length WayAbove(Length h0, Length h1, Length d, Length top, Length R) {
  Number mu = ((h1 - h0) * (Number(2.0) * R + h0 + h1) - d * d) / (Number(2.0) * d * (R + h0));
  Length enters = DistanceDownTo(h0, min(mu, Number(0.0)), min(top, h0), R);
  return select(h0 > top, min(enters, d), Length(0.0));
}

// Returns the altitude of the ray at a fraction t of its lower part, the chord of which begins at the
// altitude `begin` and ends at h1.
// @param bump, sag  of the ray over that chord, and of the chord into the planet, each divided by
// t (1 - t); before: the length of the way before that chord, relative to the whole way.
SHARED Length RayAltitude(Length begin, Length h1, Number t, Length bump, Length sag, Number before) {
  return begin + (h1 - begin) * t + (Number(1.0) - t) * (bump * (before + t) - sag * t);
}

// Returns the lift [rad].
// @param h0, h1  altitudes of observer and place; d: distance between them, > 0 [km]; R: radius of
// the planet; top: rays are straight above; usual: approximate curvature of the ray [1/km].
SHARED Number LandLift(Length h0, Length h1, Length d, Length R, Length top, Number usual,
                       Number slope_1, Number slope_2, Number slope_3, Number fall_1, Number fall_2,
                       Number fall_3) {
  Length above = WayAbove(h0, h1, d, top, R);
  Length below = d - above;
  Length begin = min(h0, top);
  Length sag = below * below / (Number(2.0) * R);
  Length bump = Number(0.5) * usual * below * below;
  Number before = above / d;
  Length z1 = RayAltitude(begin, h1, Number(0.0885879595), bump, sag, before);
  Length z2 = RayAltitude(begin, h1, Number(0.4094668644), bump, sag, before);
  Length z3 = RayAltitude(begin, h1, Number(0.7876594618), bump, sag, before);
  Number mean =
      Number(0.4018638275) *
          CurvatureAt(z1, slope_1, slope_2, slope_3, fall_1, fall_2, fall_3) +
      Number(0.4584822127) *
          CurvatureAt(z2, slope_1, slope_2, slope_3, fall_1, fall_2, fall_3) +
      Number(0.1396539598) * CurvatureAt(z3, slope_1, slope_2, slope_3, fall_1, fall_2, fall_3);
  return Number(0.5) * mean * below * below / d;
}

// Returns LandLift with one node of the quadrature instead of three, which is exact where the
// curvature is linear along the ray. It needs a third of the exponentials, most of the time.
SHARED Number RoughLandLift(Length h0, Length h1, Length d, Length R, Length top, Number usual,
                            Number slope_1, Number slope_2, Number slope_3, Number fall_1,
                            Number fall_2, Number fall_3) {
  Length above = WayAbove(h0, h1, d, top, R);
  Length below = d - above;
  Length sag = below * below / (Number(2.0) * R);
  Length bump = Number(0.5) * usual * below * below;
  Length z = RayAltitude(min(h0, top), h1, Number(1.0 / 3.0), bump, sag, above / d);
  return Number(0.5) * CurvatureAt(z, slope_1, slope_2, slope_3, fall_1, fall_2, fall_3) * below *
         below / d;
}
