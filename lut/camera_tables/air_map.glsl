// SPDX-License-Identifier: MIT
// Maps a direction and a distance to coordinates of the air's tables for one eye. Lengths are in
// km; h is the altitude of the eye, R the radius of the planet.
//
// Rows are counted from the horizon. They are quadratic in the tangent of half the angle from the
// horizon, relative to that of the range. The rows above the horizon end where rays no longer meet
// any land. Columns are counted from the azimuth of the sun. They are quadratic in the tangent of a
// quarter of the angle from it. No function needs the angle itself. Distances are fractions t of a
// ray's reach. The reach begins where the ray first meets air below the upper bound of all land
// (the ceiling). It ends at the ground or, above the horizon, where the ray leaves this air. With
// crowding k > -1
//
//   w = t (1 + k) / (1 + k t)
//
// concentrates nodes near the eye (k > 0) or at the far end (k < 0).

// AirRow returns the row for the tangent of half the angle from the horizon; AirHalfTangent inverts
// it. `range` is the tangent of half the range.
SHARED Number AirRow(Number half_tangent, Number range) {
  return sqrt(min(max(half_tangent / range, Number(0.0)), Number(1.0)));
}
SHARED Number AirHalfTangent(Number row, Number range) { return range * row * row; }

// AirColumn returns the column for the squared sine of half the azimuth, which is in 0 to pi.
// AirQuarterTangent returns the tangent of a quarter of the azimuth for a column.
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

// Returns the distance at which a ray descends below an altitude that it meets; 0 if the eye is
// below it.
SHARED Length AirEntry(Length h, Number mu, Length altitude, Length R) {
  return select(h > altitude, DistanceDownTo(h, mu, altitude, R), Length(0.0));
}

// Returns the distance from the eye to the far end of a ray above the horizon.
SHARED Length AirEndUp(Length h, Number mu, Length ceiling, Length R) {
  Length through = Number(-2.0) * (R + h) * mu - DistanceDownTo(h, mu, ceiling, R);
  return select(h < ceiling, DistanceUpTo(h, mu, ceiling, R), through);
}

// Returns the distance from the eye to the ground for a ray below the horizon.
SHARED Length AirEndDown(Length h, Number mu, Length R) {
  return DistanceDownTo(h, mu, Length(0.0), R);
}

// Returns the distance to the densest air of a whole ray: at the ground, at the lowest point, or at
// the eye.
SHARED Length AirFoot(Length h, Number mu, Number ground, Length R) {
  return select(ground > Number(0.5), AirEndDown(h, mu, R), max(-(R + h) * mu, Length(0.0)));
}

// Returns an estimate of the decrease of light when the sun sinks below the horizon; texels are
// divided by it. It is for distance d along a ray, where nu is the cosine between ray and sun and
// the radius is about `reference`.
SHARED Number AirTwilight(Length h, Number mu_s, Number nu, Length d, Number fall, Length reference,
                          Length R) {
  Number x = Number(-0.03) - ((R + h) * mu_s + d * nu) / reference;
  return exp(Number(-0.5) * fall * (x + sqrt(x * x + Number(0.0025))));
}
