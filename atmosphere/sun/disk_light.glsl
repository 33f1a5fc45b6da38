// How bright the disks of sun and moon are from place to place.

// Of the sun, relative to the mean of its disk, at rho radii from the centre, rho >= 0; beyond 1 as
// at 1. Linear limb darkening of the visible, u = 0.6: Cox (2000), Allen's Astrophysical Quantities,
// 14.7.
SHARED Number SunLimbDarkening(Number rho) {
  Number mu = sqrt(max(Number(1.0) - rho * rho, Number(0.0)));
  return (Number(1.0) - Number(0.6) * (Number(1.0) - mu)) / Number(0.8);
}

// Of dark, rough ground such as the moon's, by the cosines of the angles at which it is lit and
// seen: the law of Lommel and Seeliger, 1/2 where both are one. 0 on the dark side.
SHARED Number LommelSeeliger(Number mu_lit, Number mu_seen) {
  Number lit = max(mu_lit, Number(0.0));
  return lit / max(lit + max(mu_seen, Number(0.0)), Number(1e-6));
}
