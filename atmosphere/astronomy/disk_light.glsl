// Brightness distributions over the disks of sun and moon, and the light of a part of the sun's
// disk.

// Returns the radiance of the sun relative to the mean of its disk, at rho radii from the centre,
// rho >= 0; constant beyond 1. Linear limb darkening of the visible, u = 0.6: Cox (2000), Allen's
// Astrophysical Quantities, 14.7.
SHARED Number SunLimbDarkening(Number rho) {
  Number mu = sqrt(max(Number(1.0) - rho * rho, Number(0.0)));
  return (Number(1.0) - Number(0.6) * (Number(1.0) - mu)) / Number(0.8);
}

// Returns the fraction of sunlight that passes a straight edge across the sun's disk, the integral
// over the circular segment of a disk with limb darkening w = 0.6, where x is the height of the
// disk's centre over the edge in radii:
//
//   ((1 - w) (pi - acos x + x sqrt(1 - x^2)) + w pi / 2 (x - x^3 / 3 + 2 / 3)) / (pi (1 - w / 3)).
SHARED Number SunlightOverEdge(Number height) {
  Number x = min(max(height, Number(-1.0)), Number(1.0));
  Number chord = sqrt((Number(1.0) - x) * (Number(1.0) + x));
  Number even = atan(chord, -x) + x * chord;
  Number darkened =
      Number(1.5707963267948966) * (x - x * x * x / Number(3.0) + Number(0.6666666666666667));
  Number passed = Number(0.4) * even + Number(0.6) * darkened;
  return min(max(passed / Number(2.513274122871834), Number(0.0)), Number(1.0));
}

// Returns a polynomial of degree 5 in mu, divided by its mean over the disk, which is the integral
// of 2 mu times the polynomial.
SHARED Number LimbPolynomial(Number mu, Number a0, Number a1, Number a2, Number a3, Number a4,
                             Number a5) {
  Number here = a0 + mu * (a1 + mu * (a2 + mu * (a3 + mu * (a4 + mu * a5))));
  Number mean = a0 + a1 * Number(0.6666666666666667) + a2 * Number(0.5) + a3 * Number(0.4) +
                a4 * Number(0.3333333333333333) + a5 * Number(0.2857142857142857);
  return here / mean;
}

// Returns the relative radiance of the sun at one wavelength: the limb is redder than the centre,
// so limb darkening is weaker in the red. Neckel (2005), Solar Physics 229, 13, three ranges from
// 0.3 to 1.1 um, constant beyond their ends; between 0.37298 and 0.385 um, at the jump of Balmer's
// series, linear from one range to the next.
SHARED Number SunLimbDarkeningAt(Number rho, Number wavelength_um) {
  Number mu = sqrt(max(Number(1.0) - rho * rho, Number(0.0)));
  Number u = Number(1.0) / min(max(wavelength_um, Number(0.3)), Number(0.37298));
  Number u5 = u * u * u * u * u;
  Number ultraviolet = LimbPolynomial(
      mu, Number(0.35601) - Number(0.085217) * u,
      Number(1.11529) + Number(0.085217) * u - Number(0.001871) * u5,
      Number(-0.67237) + Number(0.003589) * u5, Number(0.18696) - Number(0.002415) * u5,
      Number(0.00038) + Number(0.000897) * u5, Number(0.01373) - Number(0.000200) * u5);
  Number v = Number(1.0) / min(max(wavelength_um, Number(0.385)), Number(0.42257));
  Number v5 = v * v * v * v * v;
  Number violet = LimbPolynomial(
      mu, Number(0.09900) + Number(0.010643) * v,
      Number(1.96884) - Number(0.010643) * v - Number(0.009166) * v5,
      Number(-2.80511) + Number(0.024873) * v5, Number(3.32780) - Number(0.029317) * v5,
      Number(-2.17878) + Number(0.018273) * v5, Number(0.58825) - Number(0.004663) * v5);
  Number w = Number(1.0) / min(max(wavelength_um, Number(0.42257)), Number(1.1));
  Number w5 = w * w * w * w * w;
  Number visible = LimbPolynomial(
      mu, Number(0.75267) - Number(0.265577) * w,
      Number(0.93874) + Number(0.265577) * w - Number(0.004095) * w5,
      Number(-1.89287) + Number(0.012582) * w5, Number(2.42234) - Number(0.017117) * w5,
      Number(-1.71150) + Number(0.011977) * w5, Number(0.49062) - Number(0.003347) * w5);
  Number past =
      min(max((wavelength_um - Number(0.37298)) / Number(0.01202), Number(0.0)), Number(1.0));
  Number below = ultraviolet + past * (violet - ultraviolet);
  return select(wavelength_um < Number(0.42257), below, visible);
}

// Returns the brightness of dark, rough ground such as the moon's, by the law of Lommel and
// Seeliger, from the cosines of the angles of incidence and of view; 1/2 where both are one, 0 on
// the dark side.
SHARED Number LommelSeeliger(Number mu_lit, Number mu_seen) {
  Number lit = max(mu_lit, Number(0.0));
  return lit / max(lit + max(mu_seen, Number(0.0)), Number(1e-6));
}
