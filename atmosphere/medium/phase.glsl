// SPDX-License-Identifier: MIT
// Phase functions [1/sr] of the cosine between the directions of propagation before and after
// scattering (forward is +1). Each integrates to 1 over the sphere.
//
//   Rayleigh           3/(16 pi) (1 + c^2)
//   molecules          D Rayleigh + (1 - D)/(4 pi), D = (1 - d)/(1 + d/2) of depolarisation d;
//                      Hansen, Travis (1974)
//   Henyey-Greenstein  1/(4 pi) (1 - g^2) / (1 + g^2 - 2 g c)^(3/2)       Henyey, Greenstein (1941)
//   Cornette-Shanks    3/(8 pi) (1 - g^2)/(2 + g^2) (1 + c^2) / (1 + g^2 - 2 g c)^(3/2)
//                                                                          Cornette, Shanks (1992)
//   Schlick            1/(4 pi) (1 - k^2) / (1 - k c)^2, k = 1.55 g - 0.55 g^3
//                                                       Blasi, Le Saec, Schlick (1993); |g| < 0.938
//   Draine             Henyey-Greenstein times (1 + a c^2) / (1 + a (1 + 2 g^2)/3);
//                      Draine (2003)
//   Droplets           Henyey-Greenstein and Draine, mixed; parameters from the droplets' diameter:
//                      Jendersie, d'Eon (2023), "An Approximate Mie Scattering Function for Fog and
//                      Cloud Rendering", SIGGRAPH talks
//
// A backward lobe is the mirror image of the forward lobe, and the denominators are written as a
// sum of two terms that are never negative, 1 + g^2 - 2 g c = (1 - |g|)^2 + 2 |g| (1 - |c|_g) with
// |c|_g = c sign(g). There is no cancellation in float, even for a sharp lobe near its axis.

SHARED Number PhaseClampedCosine(Number cos_scattering) {
  return max(Number(-1.0), min(Number(1.0), cos_scattering));
}

// Returns the difference between 1 and the cosine to the axis of the lobe, in [0, 2].
SHARED Number PhaseOffAxis(Number cos_scattering, Number g) {
  Number c = PhaseClampedCosine(cos_scattering);
  return select(g < Number(0.0), Number(1.0) + c, Number(1.0) - c);
}

// (1 - g^2) / (1 + g^2 - 2 g c)^(3/2)
SHARED Number PhaseLobe(Number cos_scattering, Number g) {
  Number a = abs(g);
  Number d =
      (Number(1.0) - a) * (Number(1.0) - a) + Number(2.0) * a * PhaseOffAxis(cos_scattering, g);
  return (Number(1.0) - a) * (Number(1.0) + a) / (d * sqrt(d));
}

SHARED Number PhaseRayleigh(Number cos_scattering) {
  Number c = PhaseClampedCosine(cos_scattering);
  return Number(0.0596831036594607509) * (Number(1.0) + c * c);
}

// Returns D, the fraction of molecular scattering that has the Rayleigh phase function.
SHARED Number RoundShare(Number depolarisation) {
  return (Number(1.0) - depolarisation) / (Number(1.0) + Number(0.5) * depolarisation);
}

SHARED Number PhaseMolecules(Number cos_scattering, Number depolarisation) {
  Number share = RoundShare(depolarisation);
  return share * PhaseRayleigh(cos_scattering) +
         (Number(1.0) - share) * Number(0.0795774715459476679);
}

SHARED Number PhaseHenyeyGreenstein(Number cos_scattering, Number g) {
  return Number(0.0795774715459476679) * PhaseLobe(cos_scattering, g);
}

SHARED Number PhaseDoubleHenyeyGreenstein(Number cos_scattering, Number g, Number g_back,
                                          Number back_weight) {
  return (Number(1.0) - back_weight) * PhaseHenyeyGreenstein(cos_scattering, g) +
         back_weight * PhaseHenyeyGreenstein(cos_scattering, g_back);
}

SHARED Number PhaseDraine(Number cos_scattering, Number g, Number alpha) {
  Number c = PhaseClampedCosine(cos_scattering);
  return Number(0.238732414637843004) * PhaseLobe(cos_scattering, g) *
         (Number(1.0) + alpha * c * c) /
         (Number(3.0) + alpha * (Number(1.0) + Number(2.0) * g * g));
}

SHARED Number PhaseCornetteShanks(Number cos_scattering, Number g) {
  Number c = PhaseClampedCosine(cos_scattering);
  return Number(0.119366207318921502) * PhaseLobe(cos_scattering, g) * (Number(1.0) + c * c) /
         (Number(2.0) + g * g);
}

SHARED Number PhaseSchlick(Number cos_scattering, Number g) {
  Number a = abs(g);
  Number k = a * (Number(1.55) - Number(0.55) * a * a);
  Number below_one = (Number(1.0) - a) * (Number(1.0) - Number(0.55) * a * (Number(1.0) + a));
  Number d = below_one + k * PhaseOffAxis(cos_scattering, g);
  return Number(0.0795774715459476679) * below_one * (Number(1.0) + k) / (d * d);
}

SHARED Number PhaseHenyeyGreensteinDraine(Number cos_scattering, Number g, Number g_draine,
                                          Number draine_weight, Number alpha) {
  return (Number(1.0) - draine_weight) * PhaseHenyeyGreenstein(cos_scattering, g) +
         draine_weight * PhaseDraine(cos_scattering, g_draine, alpha);
}

// Fits of Jendersie and d'Eon to Lorenz-Mie theory for droplets of 1.5 to 5 and of 5 to 50
// micrometres. @param d  diameter of the droplets [um].
SHARED Number DropletForwardG(Number d) {
  return select(d < Number(5.0), Number(0.0604931) * log(log(d)) + Number(0.940256),
                exp(Number(-0.0990567) / (d - Number(1.67154))));
}

SHARED Number DropletDraineG(Number d) {
  Number l = log(d);
  return select(d < Number(5.0),
                Number(0.500411) - Number(0.081287) / (tan(l) - Number(2.0) * l + Number(1.27551)),
                exp(Number(-2.20679) / (d + Number(3.91029)) - Number(0.428934)));
}

SHARED Number DropletDraineAlpha(Number d) {
  return select(d < Number(5.0), Number(7.30354) * log(d) + Number(6.31675),
                exp(Number(3.62489) - Number(8.29288) / (d + Number(5.52825))));
}

SHARED Number DropletDraineWeight(Number d) {
  Number l = log(d);
  Number wave = cos(Number(5.68947) * (log(l) - Number(0.0292149)));
  return select(d < Number(5.0), Number(0.026914) * (l - wave) + Number(0.376475),
                exp(Number(-0.599085) / (d - Number(0.641583)) - Number(0.665888)));
}

// Maps the scattering angle to the coordinate of a tabulated phase function, in [0, 1] from forward
// to backward. The nodes are uniform in this coordinate: dense about the forward direction, and
// computed without an inverse cosine. The input is the squared sine of half the scattering angle;
// PhaseHalfSine is the inverse and returns that sine.
SHARED Number PhaseNode(Number half_sine_squared) { return sqrt(sqrt(half_sine_squared)); }
SHARED Number PhaseHalfSine(Number node) { return node * node; }
