// Columns of exponential layers with one division, for integration along many rays. Lengths in km.
//
//   column = H exp(-h/H) sqrt((R + h) / 2H) (1 + H/R) n(S) / (S (S + delta) q(S))
//   S      = 1 + mu sqrt((R + h) / 2H),   delta = 5/8 H/R
//
// n / (S^2 q) is the function J0 of optical_depth.glsl as a rational function (4/3) in 1/S,
// relative error 2.2e-6. The factor (1 + H/R) S / (S + delta) replaces J2 / 2X: it is exact on
// vertical rays and within (H/R)^2 on horizontal ones. The column agrees with
// ExponentialColumnToInfinity within 1e-4.

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

// Returns the distance from the low end of a panel at v in [0, 1], divided by the length of the
// panel. A slope s = 1 gives v itself; smaller slopes move the nodes towards the low end. No
// exponential is needed.
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
