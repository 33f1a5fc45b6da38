// Light of a lamp along a view ray: angular distributions, columns of the air between two points,
// and the soft disk that represents a small lamp. All lengths have one unit, for lamps metres.

// Returns the logarithm of a density that decreases exponentially above its base. Far below the
// base the layer is opaque; the density is limited to e^80 so that later products stay finite.
// @param fall  1 / scale height; 0 where the layer is homogeneous.
SHARED Number LayerLogDensity(Length above_base, Number fall) {
  return min(-above_base * fall, Number(80.0));
}

// Returns the integral of a density that is exponential in the altitude, along a straight line of
// this length over a flat ground: rho_a and rho_b are the densities at its ends, with b higher than
// a by this many scale heights. Near 0, it is (1 - e^-x) / x over its trapezoid (1 + e^-x) / 2; the
// next term is 17 x^6 / 20160.
// @param span_over_rise  span / rise_over_h where that is not 0.
SHARED Length LampColumnOver(Length span, Number rho_a, Number rho_b, Number rise_over_h,
                             Length span_over_rise) {
  Number small = Number(0.02);
  Number square = min(rise_over_h * rise_over_h, small * small);
  Number series = Number(1.0) - square * (Number(1.0) / Number(12.0) - square / Number(120.0));
  return select(abs(rise_over_h) < small, span * Number(0.5) * (rho_a + rho_b) * series,
                (rho_a - rho_b) * span_over_rise);
}

SHARED Length LampColumn(Length span, Number rho_a, Number rho_b, Number rise_over_h) {
  Number divisor = select(abs(rise_over_h) > Number(0.0), rise_over_h, Number(1.0));
  return LampColumnOver(span, rho_a, rho_b, rise_over_h, span / divisor);
}

// Returns the relative intensity of a spot: 1 inside the inner cone, 0 outside the outer cone,
// smooth in the cosine to its axis in between.
SHARED Number SpotShare(Number cosine, Number cos_inner, Number cos_outer) {
  Number t = (cosine - cos_outer) / (cos_inner - cos_outer);
  t = min(max(t, Number(0.0)), Number(1.0));
  return t * t * (Number(3.0) - Number(2.0) * t);
}

// Returns the fraction per solid angle [1/sr] of the light of a soft disk of angular radius
// `radius`, at `off` radii from its centre: (1 - off^2)^2 over the disk integrates to pi / 3.
SHARED Number SoftDiskPerSr(Number off, Number radius) {
  Number inside = max(Number(1.0) - off * off, Number(0.0));
  return inside * inside * Number(0.95492965855137202) / (radius * radius);
}

// Returns how much higher than a point a lamp is, relative to its distance: the sine of its elevation,
// from which a lamp of the same altitude sinks by distance / diameter as the planet curves away. The
// error is (distance / radius)^2 / 2.
SHARED Number LampRise(Number sine, Number distance_over_diameter) {
  Number rise = sine + (Number(1.0) - sine * sine) * distance_over_diameter;
  return min(max(rise, Number(-1.0)), Number(1.0));
}

// Coordinates in the map of irradiance by airlight of a lamp (LampAirlightIrradiance): logarithmic
// in the distance, piecewise linear in the rise of the lamp between 0, 0.04, 0.2, 0.6 and 1.
SHARED Number LampAirlightUnit(Length distance, Length nearest, Length farthest) {
  return log(distance / nearest) / log(farthest / nearest);
}

// Returns the distance at a coordinate, the inverse of LampAirlightUnit.
SHARED Length LampAirlightDistance(Number unit, Length nearest, Length farthest) {
  return nearest * exp(unit * log(farthest / nearest));
}

SHARED Number LampRiseUnit(Number rise) {
  Number a = min(abs(rise), Number(1.0));
  Number steps = min(a / Number(0.04), Number(1.0)) +
                 min(max((a - Number(0.04)) / Number(0.16), Number(0.0)), Number(1.0)) +
                 min(max((a - Number(0.2)) / Number(0.4), Number(0.0)), Number(1.0)) +
                 max((a - Number(0.6)) / Number(0.4), Number(0.0));
  return Number(0.5) + select(rise < Number(0.0), Number(-0.125), Number(0.125)) * steps;
}

SHARED Number LampRiseFromUnit(Number unit) {
  Number steps = abs(unit - Number(0.5)) * Number(8.0);
  Number a = Number(0.04) * min(steps, Number(1.0)) +
             Number(0.16) * min(max(steps - Number(1.0), Number(0.0)), Number(1.0)) +
             Number(0.4) * max(steps - Number(2.0), Number(0.0));
  return select(unit < Number(0.5), -a, a);
}

// Returns the logarithm of a lamp's airlight times the distance beyond the last distance of a map,
// from its logarithms there and one step before: light that decays between them continues to decay
// exponentially, and no light grows.
// @param steps  beyond the last distance.
SHARED Number LampAirlightBeyond(Number last, Number before, Number steps) {
  return last + min(last - before, Number(0.0)) * steps;
}

// Returns the irradiance of a slope by airlight of a lamp, relative to the irradiance of level
// ground: six terms, of which the first is 1. The light comes from around the lamp, so slopes
// towards it and away from it have separate terms.
// @param towards, up  components of the unit normal: along the horizontal direction to the lamp,
// and upwards.
SHARED Number LampAirlightOnSlope(Number towards, Number up, Number steep, Number facing,
                              Number facing_twice, Number turned, Number turned_twice) {
  Number face = max(towards, Number(0.0));
  Number turn = max(-towards, Number(0.0));
  Number share = Number(1.0) + steep * (Number(1.0) - up) +
                 face * (facing + facing_twice * face) + turn * (turned + turned_twice * turn);
  return max(share, Number(0.0));
}
