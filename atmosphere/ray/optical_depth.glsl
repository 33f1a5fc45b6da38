// Columns (integrals of relative density along a ray) of the shells of the atmosphere, in km.
//
// Exponential layer, density exp(-h / H), upward ray of zenith cosine mu >= 0 from altitude h to
// infinity:
//
//   column = H exp(-h/H) Ch(X, mu),   X = (R + h) / H
//   Ch     = sqrt(X/2) [J0(y) + J2(y) / (2 X) + O(X^-2)],   y = mu sqrt(X/2)
//   Jn(y)  = integral_0^inf p^n e^-p (y^2 + p)^-1/2 dp
//
// This results from expanding the altitude in the half-chord variable; J0 = sqrt(pi) erfcx(y) is
// the first order of Chapman (1931) and Fitzmaurice (1964), and the series is that of Huestis
// (2001), JQSRT 69, 709. The functions Jn depend neither on the planet nor on the layer: one
// rational fit in u = 1 / (1 + y) serves all.

// J0 = u P / Q, rational (5/4) in u: relative error 1.7e-8.
SHARED Number ColumnJ0Numerator(Number u) {
  Number p = Number(3.7599521088357672) + u * Number(-0.45666849255125075);
  p = Number(4.6178636259970203) + u * p;
  p = Number(4.7885790402196191) + u * p;
  p = Number(1.4948750040038796) + u * p;
  return Number(0.99999997945504882) + u * p;
}

SHARED Number ColumnJ0Denominator(Number u) {
  Number q = Number(1.0829487493940633) + u * Number(2.2069809883276656);
  q = Number(3.7934707763572888) + u * q;
  q = Number(0.49487729060583163) + u * q;
  return Number(1.0) + u * q;
}

// J2 = u P / Q, rational (3/3) in u: relative error 1.6e-4, which enters the column
// divided by 2 X > 1000.
SHARED Number ColumnJ2Numerator(Number u) {
  Number p = Number(4.8712710358375837) + u * Number(-0.22254811537963715);
  p = Number(6.1873477180424246) + u * p;
  return Number(2.0001234440078335) + u * p;
}

SHARED Number ColumnJ2Denominator(Number u) {
  Number q = Number(0.54834473083938295) + u * Number(6.0033003663485607);
  q = Number(2.1058187744751793) + u * q;
  return Number(1.0) + u * q;
}

// Returns Ch(X, mu) for mu >= 0: the column divided by the vertical column. J0 + J2 / 2X has one
// common denominator, because divisions dominate the cost.
SHARED Number ChapmanUp(Number X, Number mu) {
  Number root = sqrt(Number(0.5) * X);
  Number u = Number(1.0) / (Number(1.0) + mu * root);
  Number q0 = ColumnJ0Denominator(u);
  Number q2 = Number(2.0) * X * ColumnJ2Denominator(u);
  return root * u * (ColumnJ0Numerator(u) * q2 + ColumnJ2Numerator(u) * q0) / (q0 * q2);
}

// Returns the column of the exponential layer from altitude h along mu >= 0 to infinity.
SHARED Length ExponentialColumnToInfinity(Length h, Number mu, Length H, Length R) {
  Number inverse = Number(1.0) / H;
  return H * exp(-h * inverse) * ChapmanUp((R + h) * inverse, mu);
}

// Returns the column of the exponential layer up to the top of the atmosphere (h <= top), above
// which there is no air. The sine of the zenith angle decreases with the radius on the way up; its
// cosine is computed from the chord, without cancellation.
SHARED Length ExponentialColumnUp(Length h, Number mu, Length H, Length top, Length R) {
  Length a = (R + h) * mu;
  Length b = max((top - h) * (Number(2.0) * R + top + h), Length(0.0));
  Number mu_top = sqrt(a * a + b) / (R + top);
  Length beyond = ExponentialColumnToInfinity(top, min(mu_top, Number(1.0)), H, R);
  return max(ExponentialColumnToInfinity(h, mu, H, R) - beyond, Length(0.0));
}

// Returns the density of the molecules relative to altitude 0, an exponential with a deficit near
// the ground: (1 + d) exp(-h / H) - d exp(-h / H_D).
SHARED Number MoleculeDensity(Length h, Length H, Number d, Length H_D) {
  return (Number(1.0) + d) * exp(-h / H) - d * exp(-h / H_D);
}

// Returns the reduction of the column from altitude h along mu >= 0 to the top by the deficit,
// which is negligible above the top.
SHARED Length DeficitColumnUp(Length h, Number mu, Number d, Length H_D, Length R) {
  return d * ExponentialColumnToInfinity(h, mu, H_D, R);
}

// Returns the relative density of the ozone tent: 0 at the bottom, 1 at the peak, 0 at the top.
SHARED Number TentDensity(Length h, Length bottom, Length peak, Length top) {
  Number rising = (h - bottom) / (peak - bottom);
  Number falling = (top - h) / (top - peak);
  return max(min(rising, falling), Number(0.0));
}

// Returns the column of the tent between distances d0 <= d1 of a ray that stays in one linear part
// of it: Gauss-Legendre with 3 nodes in the distance, in which the altitude is nearly a parabola.
SHARED Length TentPieceColumn(Length h, Number mu, Length d0, Length d1, Length bottom, Length peak,
                              Length top, Length R) {
  Length centre = Number(0.5) * (d0 + d1);
  Length half_length = Number(0.5) * (d1 - d0);
  Length offset = half_length * Number(0.7745966692414834);
  Number low = TentDensity(AltitudeAlongRay(h, mu, centre - offset, R), bottom, peak, top);
  Number middle = TentDensity(AltitudeAlongRay(h, mu, centre, R), bottom, peak, top);
  Number high = TentDensity(AltitudeAlongRay(h, mu, centre + offset, R), bottom, peak, top);
  return half_length * (Number(5.0) * (low + high) + Number(8.0) * middle) / Number(9.0);
}

// Returns the column of the tent from altitude h along mu >= 0 to space.
SHARED Length TentColumnUp(Length h, Number mu, Length bottom, Length peak, Length top, Length R) {
  Length d_bottom = select(h < bottom, DistanceUpTo(h, mu, max(h, bottom), R), Length(0.0));
  Length d_peak = select(h < peak, DistanceUpTo(h, mu, max(h, peak), R), Length(0.0));
  Length d_top = select(h < top, DistanceUpTo(h, mu, max(h, top), R), Length(0.0));
  return TentPieceColumn(h, mu, d_bottom, d_peak, bottom, peak, top, R) +
         TentPieceColumn(h, mu, d_peak, d_top, bottom, peak, top, R);
}

// Returns the relative density of the smooth layer of ozone, (27/4 y (1 - y)^2)^4 with y = h / top:
// 1 at top / 3, 0 at the ground and from the top on.
SHARED Number SmoothOzoneAt(Number y) {
  Number rest = max(Number(1.0) - y, Number(0.0));
  Number root = Number(6.75) * y * rest * rest;
  Number square = root * root;
  return square * square;
}

SHARED Number SmoothOzoneDensity(Length h, Length top) { return SmoothOzoneAt(h / top); }

// Returns (sqrt(1 + 2 x) - 1) / x as a series: a square root and a division at every node would
// cost more than all other operations. Relative error 7/8 x^4; x < 0.011 on Earth below 70 km.
SHARED Number ClimbSeries(Number x) {
  return Number(1.0) - x * (Number(0.5) - x * (Number(0.5) - Number(0.625) * x));
}

// Returns the altitude at distance d along a ray that climbs and falls by less than a hundredth of
// the radius, without a square root. Relative error of the climb: 1e-8.
SHARED Length AltitudeNearby(Length h, Number mu, Length d, Length R) {
  Length r = R + h;
  Number inverse = Number(1.0) / r;
  Number x = d * (d + Number(2.0) * r * mu) * Number(0.5) * inverse * inverse;
  return h + r * x * ClimbSeries(x);
}

// Returns twice the mean of the smooth density at distances `middle - offset` and `middle + offset`
// of a ray, where the altitude is h + r (sqrt(1 + 2 x) - 1), x = d (d + 2 r mu) / 2 r^2.
SHARED Number SmoothOzonePair(Length h, Number mu, Length middle, Length offset, Length top,
                              Length R) {
  Length r = R + h;
  Length a = Number(2.0) * r * mu;
  Number inverse = Number(1.0) / r;
  Number scale = Number(0.5) * inverse * inverse;
  Number per_top = Number(1.0) / top;
  Number y = h * per_top;
  Number rise = r * per_top;
  Length near = middle - offset;
  Length far = middle + offset;
  Number x_near = near * (near + a) * scale;
  Number x_far = far * (far + a) * scale;
  return SmoothOzoneAt(y + rise * x_near * ClimbSeries(x_near)) +
         SmoothOzoneAt(y + rise * x_far * ClimbSeries(x_far));
}

// Returns the column of the smooth layer from altitude h along mu >= 0 to space: Gauss-Legendre
// with 10 nodes in the distance, in which the density is a polynomial of degree 24 except for the
// curvature of order 4. Relative error 3e-6, largest on the horizontal ray from the ground.
SHARED Length SmoothOzoneColumnUp(Length h, Number mu, Length top, Length R) {
  Length d = select(h < top, DistanceUpTo(h, mu, max(h, top), R), Length(0.0));
  Length m = Number(0.5) * d;
  Number sum = Number(0.29552422471475287) *
               SmoothOzonePair(h, mu, m, m * Number(0.14887433898163122), top, R);
  sum = sum + Number(0.26926671930999635) *
                  SmoothOzonePair(h, mu, m, m * Number(0.43339539412924719), top, R);
  sum = sum + Number(0.21908636251598204) *
                  SmoothOzonePair(h, mu, m, m * Number(0.67940956829902441), top, R);
  sum = sum + Number(0.14945134915058060) *
                  SmoothOzonePair(h, mu, m, m * Number(0.86506336668898451), top, R);
  sum = sum + Number(0.06667134430868814) *
                  SmoothOzonePair(h, mu, m, m * Number(0.97390652851717172), top, R);
  return m * sum;
}

// Combines upward columns into the column from the origin of a ray (upward column c_origin at its
// |mu|) to a point on it (c_point at its |mu|): outward, inward, or through the perigee (upward
// column c_perigee).
SHARED Length ColumnBetween(Number mu_origin, Number mu_point, Length c_origin, Length c_point,
                            Length c_perigee) {
  Length through = Number(2.0) * c_perigee - c_origin - c_point;
  Length inward = c_point - c_origin;
  Length outward = c_origin - c_point;
  Length column =
      select(mu_origin >= Number(0.0), outward, select(mu_point < Number(0.0), inward, through));
  return max(column, Length(0.0));
}

// Returns the column towards a distant sun of zenith cosine mu_s, from the upward column at |mu_s|
// and, below the horizontal, the upward column at the perigee.
SHARED Length ColumnToSun(Number mu_s, Length c_point, Length c_perigee) {
  return select(mu_s >= Number(0.0), c_point, max(Number(2.0) * c_perigee - c_point, Length(0.0)));
}

// ---- Columns of exponential layers with one division, for integration along many rays ----------
//
//   column = H exp(-h/H) sqrt((R + h) / 2H) (1 + H/R) n(S) / (S (S + delta) q(S))
//   S      = 1 + mu sqrt((R + h) / 2H),   delta = 5/8 H/R
//
// n / (S^2 q) is J0 as a rational function (4/3) in 1/S, relative error 2.2e-6. The factor
// (1 + H/R) S / (S + delta) replaces J2 / 2X: it is exact on vertical rays and within (H/R)^2 on
// horizontal ones. The column agrees with ExponentialColumnToInfinity within 1e-4.

// Numerator n of J0.
SHARED Number DirectNumerator(Number S) {
  Number n = Number(2.0497895655188971) + S * Number(0.99998614949691045);
  n = Number(3.216429458334074) + S * n;
  n = Number(3.2022790207455998) + S * n;
  return Number(-0.5743439077893846) + S * n;
}

// Denominator S (S + delta) q(S).
SHARED Number DirectDenominator(Number S, Number delta) {
  Number q = Number(1.0487652582358333) + S;
  q = Number(1.6901272231928772) + S * q;
  q = Number(1.2790996924529718) + S * q;
  return S * (S + delta) * q;
}

// Returns the column divided by H exp(-h/H) (1 + H/R) sqrt((R + h) / 2H), from
// y = mu sqrt((R + h) / 2H), mu >= 0.
SHARED Number DirectColumnShape(Number y, Number delta) {
  Number S = Number(1.0) + y;
  return DirectNumerator(S) / DirectDenominator(S, delta);
}
