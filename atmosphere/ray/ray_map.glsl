// Positions of samples along a ray, and the planet's shadow on the ray. Lengths have one unit,
// kilometres unless stated otherwise. Lengths for the stretch are in kilometres of air as deep as
// the Earth's, to which shallower air is scaled (MapLengthsPerKm, ray.h).
//
// A panel is a segment of the ray on which the altitude is monotone; t is the distance from its
// lower end. With v in [0, 1] of a Gauss rule,
//
//   t = length sinh(b v) / sinh(b),   b = 1.3 ln(2 length / half)
//
// where `half` is the distance to 10 km above the lower end, or 10 optical depths if less: beyond
// it the density of nodes decreases exponentially, like that of the air. With g = exp(b v) this
// needs no further exponential.
//
// A gentle stretch, 1.1 ln(2 length / half) and 12 km, has fewer nodes at the lower end. It is used
// for panels whose lower end is hard to integrate and which get no additional nodes for it, and for
// panels that begin behind an edge of the planet's shadow, where sunlight returns slowly. It is
// more accurate than the rational map t = length v / (1 + k (1 - v)), with half of its nodes within
// 20 km or 8 optical depths. The errors of 12 nodes a panel are (rms, earth and hazy)
//
//                                       rational           gentle
//   sky, sun at 0 to 5 deg              3e-6    1e-4       7e-6    1e-4
//   sky in twilight                     1.3e-4  3e-3       1.5e-4  7e-4
//   ground from 400 km, sun over 5 deg  2.3e-4  7e-3       4e-5    6e-4
//   limb from 400 km, sun over 5 deg    3.1e-4  7.5e-3     5e-5    7e-4

// Returns the stretch b of a panel whose lower end has altitude z and zenith cosine mu >= 0
// upwards; gentle is 1 or 0. The result is 0 if t = length v is as good: there sinh(b v) / sinh(b)
// differs from v by 1 %, and would cancel in float.
// @param extinction  per kilometre at altitude 0, largest over bands.
SHARED Number PanelStretch(Length z, Number mu, Length length, Number extinction, Number gentle,
                           Length R) {
  Length rise = select(gentle > Number(0.5), Length(12.0), Length(10.0));
  Number strength = select(gentle > Number(0.5), Number(1.1), Number(1.3));
  Number dense = max(extinction * exp(-z / Length(8.0)), Number(1e-20));
  Length half_way = min(DistanceUpTo(z, mu, z + rise, R), Number(10.0) / dense);
  Number b = strength * log(max(Number(2.0) * length / half_way, Number(1.0)));
  return select(b < Number(0.25), Number(0.0), b);
}

// Returns length / sinh(b) from g = exp(b), b > 0.
SHARED Length StretchedScale(Length length, Number g) {
  return length / (Number(0.5) * (g - Number(1.0) / g));
}

// Returns t from this scale and g = exp(b v).
SHARED Length StretchedDistance(Length scale, Number g) {
  return scale * Number(0.5) * (g - Number(1.0) / g);
}

// Returns dt / dv at g = exp(b v).
SHARED Length StretchedSlope(Length scale, Number b, Number g) {
  return scale * b * Number(0.5) * (g + Number(1.0) / g);
}

// Returns the distance from the low end of a panel at v in [0, 1], divided by the length of the
// panel, by the map of direct integration (direct_scattering.h). A slope s = 1 gives v itself;
// smaller slopes move the nodes towards the low end. No exponential is needed.
SHARED Number DirectDistance(Number v, Number s) {
  Number square = v * v;
  Number bend = square * (Number(0.3) + Number(0.7) * square);
  return v * (s + (Number(1.0) - s) * bend);
}

// Returns the derivative of DirectDistance by v.
SHARED Number DirectSlope(Number v, Number s) {
  Number square = v * v;
  Number bend = square * (Number(0.9) + Number(3.5) * square);
  return s + (Number(1.0) - s) * bend;
}

// The shadow is the half of a cylinder behind the planet. At distance t of the ray the squared
// distance from its axis minus R^2 is a t^2 + 2 b t + c, and sun + t nu is the height above the
// plane through the centre perpendicular to the axis: the ray is dark where both are negative.
// a = 1 - nu^2 must be computed without cancellation.

// Returns 1 if the ray is parallel to the axis, and therefore does not cross the cylinder.
SHARED Number AlongShadow(Number a) { return select(a > Number(1e-14), Number(0.0), Number(1.0)); }

SHARED Length ShadowSlope(Length h, Number mu, Number mu_s, Number nu, Length R) {
  return (R + h) * (mu - mu_s * nu);
}

SHARED Length ShadowClearance(Length h, Number mu_s, Length R) {
  Length sun = (R + h) * mu_s;
  Length horizon = HorizonDistance(h, R);
  Length below = min(h, Length(0.0)) * (Number(2.0) * R + h);
  return (horizon - sun) * (horizon + sun) + below;
}

// Returns 1 if the ray, as an infinite line, has a dark segment: between ShadowBegin and ShadowEnd.
SHARED Number MeetsShadow(Length h, Number mu, Number mu_s, Number nu, Number a, Length R) {
  Length b = ShadowSlope(h, mu, mu_s, nu, R);
  Length c = ShadowClearance(h, mu_s, R);
  Number clearance = select(AlongShadow(a) > Number(0.5), c, a * c - b * b);
  Number height = select(abs(nu) > Number(0.0), Number(-1.0), mu_s);
  return select(max(clearance, height) < Number(0.0), Number(1.0), Number(0.0));
}

// Returns the root of a t^2 + 2 b t + c that has no cancellation, times a; the other root is c over
// it.
SHARED Length ShadowRoot(Number a, Length b, Length c) {
  Length root = sqrt(max(b * b - a * c, Length(0.0)));
  return select(b > Length(0.0), -b - root, root - b);
}

SHARED Length ShadowOtherRoot(Length root, Length c) {
  Length divisor = select(abs(root) > Length(0.0), root, Length(1.0));
  return select(abs(root) > Length(0.0), c / divisor, Length(0.0));
}

// Distances at which a ray with MeetsShadow enters and leaves the shadow.
SHARED Length ShadowBegin(Length h, Number mu, Number mu_s, Number nu, Number a, Length R) {
  Length c = ShadowClearance(h, mu_s, R);
  Length root = ShadowRoot(a, ShadowSlope(h, mu, mu_s, nu, R), c);
  Length inside = min(root / max(a, Number(1e-14)), ShadowOtherRoot(root, c));
  Length begin = select(AlongShadow(a) > Number(0.5), Length(-1e30), inside);
  Number divisor = select(abs(nu) > Number(0.0), nu, Number(1.0));
  return select(nu < Number(0.0), max(begin, -((R + h) * mu_s) / divisor), begin);
}

SHARED Length ShadowEnd(Length h, Number mu, Number mu_s, Number nu, Number a, Length R) {
  Length c = ShadowClearance(h, mu_s, R);
  Length root = ShadowRoot(a, ShadowSlope(h, mu, mu_s, nu, R), c);
  Length inside = max(root / max(a, Number(1e-14)), ShadowOtherRoot(root, c));
  Length end = select(AlongShadow(a) > Number(0.5), Length(1e30), inside);
  Number divisor = select(abs(nu) > Number(0.0), nu, Number(1.0));
  return select(nu > Number(0.0), min(end, -((R + h) * mu_s) / divisor), end);
}
