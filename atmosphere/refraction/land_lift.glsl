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
  Number t1 = Number(0.0885879595), t2 = Number(0.4094668644), t3 = Number(0.7876594618);
  Length z1 = begin + (h1 - begin) * t1 + (Number(1.0) - t1) * (bump * (before + t1) - sag * t1);
  Length z2 = begin + (h1 - begin) * t2 + (Number(1.0) - t2) * (bump * (before + t2) - sag * t2);
  Length z3 = begin + (h1 - begin) * t3 + (Number(1.0) - t3) * (bump * (before + t3) - sag * t3);
  Number mean =
      Number(0.4018638275) *
          CurvatureAt(z1, slope_1, slope_2, slope_3, fall_1, fall_2, fall_3) +
      Number(0.4584822127) *
          CurvatureAt(z2, slope_1, slope_2, slope_3, fall_1, fall_2, fall_3) +
      Number(0.1396539598) * CurvatureAt(z3, slope_1, slope_2, slope_3, fall_1, fall_2, fall_3);
  return Number(0.5) * mean * below * below / d;
}
