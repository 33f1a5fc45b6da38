// SPDX-License-Identifier: MIT
// Where a direction and a distance lie in the tables of one eye's air. Lengths in km; h is the
// altitude of the eye, R the radius of the planet.
//
// Rows count from the horizon: quadratic in the tangent of half the angle from it, over that of the
// range; those above it end where rays meet no land any more. Columns count from the sun's azimuth,
// quadratic in the tangent of a quarter of the angle between. None needs the angle itself.
// Distances are shares t of a ray's reach: from where it first meets air below the altitude that no
// land exceeds (the ceiling) to the ground or, above the horizon, to where it leaves it. With
// crowding k > -1
//
//   w = t (1 + k) / (1 + k t)
//
// crowds nodes near the eye (k > 0) or at the far end (k < 0).

// From tangents of half an angle; and the tangent back.
SHARED Number AirRow(Number half_tangent, Number range) {
  return sqrt(min(max(half_tangent / range, Number(0.0)), Number(1.0)));
}
SHARED Number AirHalfTangent(Number row, Number range) { return range * row * row; }

// From the square of the sine of half the azimuth, 0 to pi; and the tangent of its quarter back.
SHARED Number AirColumn(Number half_sine_squared) {
  Number x = min(max(half_sine_squared, Number(0.0)), Number(1.0));
  return sqrt(sqrt(x) / (Number(1.0) + sqrt(Number(1.0) - x)));
}
SHARED Number AirQuarterTangent(Number column) { return column * column; }

SHARED Number AirNodeFromShare(Number t, Number crowding) {
  return t * (Number(1.0) + crowding) / (Number(1.0) + crowding * t);
}
SHARED Number AirShareFromNode(Number w, Number crowding) {
  return w / (Number(1.0) + crowding * (Number(1.0) - w));
}

// Distance at which a ray comes below an altitude that it meets; 0 from below it.
SHARED Length AirEntry(Length h, Number mu, Length altitude, Length R) {
  return select(h > altitude, DistanceDownTo(h, mu, altitude, R), Length(0.0));
}

// Distance to the far end of a ray above the horizon, from the eye.
SHARED Length AirEndUp(Length h, Number mu, Length ceiling, Length R) {
  Length through = Number(-2.0) * (R + h) * mu - DistanceDownTo(h, mu, ceiling, R);
  return select(h < ceiling, DistanceUpTo(h, mu, ceiling, R), through);
}

// And of one below it.
SHARED Length AirEndDown(Length h, Number mu, Length R) {
  return DistanceDownTo(h, mu, Length(0.0), R);
}

// Where the air of a whole ray is densest: at the ground, at the lowest point, or at the eye.
SHARED Length AirFoot(Length h, Number mu, Number ground, Length R) {
  return select(ground > Number(0.5), AirEndDown(h, mu, R), max(-(R + h) * mu, Length(0.0)));
}

// How light falls, roughly, where the sun sinks below the horizon: what texels are divided by. At
// distance d of a ray, nu its cosine with the sun, where the radius is about `reference`.
SHARED Number AirTwilight(Length h, Number mu_s, Number nu, Length d, Number fall, Length reference,
                          Length R) {
  Number x = Number(-0.03) - ((R + h) * mu_s + d * nu) / reference;
  return exp(Number(-0.5) * fall * (x + sqrt(x * x + Number(0.0025))));
}
