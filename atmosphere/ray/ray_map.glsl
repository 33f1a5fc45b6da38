// Where along a ray the light is sampled, and where the planet's shadow lies on it. Lengths in one
// unit, kilometres but where it is said otherwise; stretches in kilometres of air as deep as the
// Earth's, into which shallower air is scaled (MapLengthsPerKm of ray_panels.h).
//
// A panel is a stretch of the ray on which the altitude is monotone; t is the distance from its
// lower end. With v in [0, 1] of a Gauss rule,
//
//   t = length sinh(b v) / sinh(b),   b = 1.3 ln(2 length / half)
//
// where `half` is the distance to 10 km above the lower end, or 10
// optical depths if less: beyond it nodes thin out exponentially, as
// the air does. With g = exp(b v) this costs no further exponential.
//
// A gentle stretch, 1.1 ln(2 length / half) and 12 km, has fewer nodes at the lower end: for panels
// that get no more of them where that end is hard to integrate, and for those that begin behind an
// edge of the planet's shadow, where sunlight comes back slowly. It is better than the rational map
// t = length v / (1 + k (1 - v)), half of its nodes within 20 km or 8 optical depths: 12 nodes a
// panel are wrong by (rms, earth and hazy)
//
//                                       rational           gentle
//   sky, sun at 0 to 5 deg              3e-6    1e-4       7e-6    1e-4
//   sky in twilight                     1.3e-4  3e-3       1.5e-4  7e-4
//   ground from 400 km, sun over 5 deg  2.3e-4  7e-3       4e-5    6e-4
//   limb from 400 km, sun over 5 deg    3.1e-4  7.5e-3     5e-5    7e-4

// Stretch b of a panel whose lower end has altitude z and zenith cosine mu >= 0 upwards; gentle is
// 1 or 0. 0 where t is as good as length v: there sinh(b v) / sinh(b) differs from v by 1 %, and
// would cancel in float.
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

// length / sinh(b) from g = exp(b), b > 0.
SHARED Length StretchedScale(Length length, Number g) {
  return length / (Number(0.5) * (g - Number(1.0) / g));
}

// t from that scale and g = exp(b v).
SHARED Length StretchedDistance(Length scale, Number g) {
  return scale * Number(0.5) * (g - Number(1.0) / g);
}

// dt / dv there.
SHARED Length StretchedSlope(Length scale, Number b, Number g) {
  return scale * b * Number(0.5) * (g + Number(1.0) / g);
}

// The shadow is the half of a cylinder behind the planet. At distance t of the ray the squared
// distance from its axis less R^2 is a t^2 + 2 b t + c, and sun + t nu the height over the plane
// through the centre, across the axis: dark is where both are negative. a = 1 - nu^2, from where it
// does not cancel.

// The ray runs along the axis: the cylinder has no ends on it.
SHARED Number AlongShadow(Number a) { return select(a > Number(1e-14), Number(0.0), Number(1.0)); }

SHARED Length ShadowSlope(Length h, Number mu, Number mu_s, Number nu, Length R) {
  return (R + h) * (mu - mu_s * nu);
}

SHARED Length ShadowClearance(Length h, Number mu_s, Length R) {
  Length sun = (R + h) * mu_s;
  Length horizon = HorizonDistance(h, R);
  return (horizon - sun) * (horizon + sun);
}

// 1 if the ray, as a line without ends, has a dark piece: between ShadowBegin and ShadowEnd.
SHARED Number MeetsShadow(Length h, Number mu, Number mu_s, Number nu, Number a, Length R) {
  Length b = ShadowSlope(h, mu, mu_s, nu, R);
  Length c = ShadowClearance(h, mu_s, R);
  Number clearance = select(AlongShadow(a) > Number(0.5), c, a * c - b * b);
  Number height = select(abs(nu) > Number(0.0), Number(-1.0), mu_s);
  return select(max(clearance, height) < Number(0.0), Number(1.0), Number(0.0));
}

// Root of a t^2 + 2 b t + c that does not cancel, times a; the other root is c over it.
SHARED Length ShadowRoot(Number a, Length b, Length c) {
  Length root = sqrt(max(b * b - a * c, Length(0.0)));
  return select(b > Length(0.0), -b - root, root - b);
}

SHARED Length ShadowOtherRoot(Length root, Length c) {
  Length divisor = select(abs(root) > Length(0.0), root, Length(1.0));
  return select(abs(root) > Length(0.0), c / divisor, Length(0.0));
}

// Distances at which a ray that MeetsShadow comes into it and leaves it.
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
