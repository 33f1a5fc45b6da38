// Factors of the reflectance distributions of surfaces (reflectance.h). mu_light and mu_eye are the
// cosines of the normal with light and eye, cos_between is that between light and eye; no quantity
// is a length.

SHARED Number FifthPower(Number x) {
  Number x2 = x * x;
  return x2 * x2 * x;
}

// Cosine of the angle of refraction (Snell).
SHARED Number RefractedCosine(Number cosine, Number index) {
  Number sine2 = (Number(1.0) - cosine * cosine) / (index * index);
  return sqrt(max(Number(1.0) - sine2, Number(0.0)));
}

// Reflectance of light polarised perpendicular to the plane of incidence (Fresnel).
SHARED Number FresnelAcross(Number cosine, Number index) {
  Number inside = RefractedCosine(cosine, index);
  Number across = (cosine - index * inside) / (cosine + index * inside);
  return across * across;
}

// Reflectance of light polarised in the plane of incidence.
SHARED Number FresnelAlong(Number cosine, Number index) {
  Number inside = RefractedCosine(cosine, index);
  Number along = (index * cosine - inside) / (index * cosine + inside);
  return along * along;
}

// Reflectance of unpolarised light.
SHARED Number FresnelReflectance(Number cosine, Number index) {
  return Number(0.5) * (FresnelAcross(cosine, index) + FresnelAlong(cosine, index));
}

// Degree of polarisation of unpolarised light after reflection, perpendicular to the plane of
// incidence.
SHARED Number FresnelPolarisation(Number cosine, Number index) {
  Number across = FresnelAcross(cosine, index);
  Number along = FresnelAlong(cosine, index);
  return (across - along) / (across + along);
}

SHARED Number SchlickReflectance(Number cosine, Number f0) {
  return f0 +
         (Number(1.0) - f0) * FifthPower(Number(1.0) - min(max(cosine, Number(0.0)), Number(1.0)));
}

// Cosines of the half vector of light and eye: with the light, and with the normal.
SHARED Number HalfCosLight(Number cos_between) {
  return Number(0.5) * sqrt(max(Number(2.0) + Number(2.0) * cos_between, Number(1e-12)));
}

SHARED Number HalfMu(Number mu_light, Number mu_eye, Number cos_light) {
  return min((mu_light + mu_eye) / (Number(2.0) * cos_light), Number(1.0));
}

// RoughDiffuse; `scale` and `mean` belong to a roughness. The fraction of light that facets without
// absorption retain after one reflection is RoughKept times the roughness and the scale.
SHARED Number RoughKept(Number mu) {
  Number cosine = min(mu, Number(1.0));
  Number sine = sqrt(max(Number(1.0) - cosine * cosine, Number(0.0)));
  // This is sin / mu (1 - sin^3), written without the division by 0 at the horizontal.
  Number far = sine * cosine * (Number(1.0) + sine + sine * sine) / (Number(1.0) + sine);
  Number g =
      sine * (atan(sine, cosine) - sine * cosine) + Number(0.6666666666666667) * (far - sine);
  return Number(0.2877934092108062) - g * Number(0.3183098861837907);
}

// Albedo of light reflected once between facets without absorption.
SHARED Number RoughSingle(Number mu, Number roughness, Number scale) {
  return Number(1.0) - scale * roughness * RoughKept(mu);
}

// BRDF of multiple reflections between facets without absorption [1/sr]. The divisor is pi times
// the mean of RoughKept over a uniform sky.
SHARED Number RoughTwice(Number mu_light, Number mu_eye, Number roughness, Number scale) {
  return scale * roughness * RoughKept(mu_light) * RoughKept(mu_eye) / Number(0.6764012244017015);
}

// BRDF of a single reflection from facets without absorption [1/sr].
SHARED Number RoughOnce(Number mu_light, Number mu_eye, Number cos_between, Number roughness,
                        Number scale) {
  Number s = cos_between - mu_light * mu_eye;
  Number ratio = select(s > Number(0.0), s / max(mu_light, mu_eye), s);
  return scale * (Number(1.0) + roughness * ratio) * Number(0.3183098861837907);
}

// Factor on the multiply reflected light for facets with an albedo.
SHARED Number RoughAgain(Number albedo, Number mean) {
  return albedo * albedo * mean / (Number(1.0) - albedo * (Number(1.0) - mean));
}

// Glossy. Fraction of light that the coat transmits to the body; it is the same inwards and
// outwards. The factor 1 - f0 is applied elsewhere.
SHARED Number CoatPassed(Number mu) {
  return Number(1.0) - FifthPower(Number(1.0) - Number(0.5) * mu);
}

SHARED Number CoatLobe(Number half_mu, Number cos_light, Number f0, Number exponent,
                       Number normalisation) {
  return SchlickReflectance(cos_light, f0) * normalisation * pow(half_mu, exponent);
}

// BRDF of the body under the coat, divided by its albedo [1/sr].
SHARED Number BodyUnderCoat(Number mu_light, Number mu_eye, Number f0) {
  return Number(0.38750768752787574) * (Number(1.0) - f0) * CoatPassed(mu_light) *
         CoatPassed(mu_eye);  // 28 / (23 pi)
}

// Water. Ratio of the surface area that waves hide from a direction to the area that is visible:
// (exp(-a^2) / (a sqrt(pi)) - erfc(a)) / 2 with erfc of Abramowitz and Stegun 7.1.26, to 2e-7.
SHARED Number SmithLambda(Number mu, Number variance) {
  Number sine = sqrt(max(Number(1.0) - mu * mu, Number(1e-12)));
  Number a = mu / (sine * sqrt(variance));
  Number t = Number(1.0) / (Number(1.0) + Number(0.3275911) * a);
  Number series =
      t * (Number(0.254829592) +
           t * (Number(-0.284496736) +
                t * (Number(1.421413741) + t * (Number(-1.453152027) + t * Number(1.061405429)))));
  Number b = min(a, Number(5.0));
  Number hidden =
      Number(0.5) * exp(-b * b) * (Number(0.5641895835477563) / max(a, Number(1e-9)) - series);
  return select(a > Number(4.0), Number(0.0), max(hidden, Number(0.0)));
}

// BRDF of the glitter of waves with a slope variance [1/sr].
SHARED Number WaveGlitter(Number mu_light, Number mu_eye, Number cos_between, Number variance,
                          Number index) {
  Number cos_light = HalfCosLight(cos_between);
  Number mu = HalfMu(mu_light, mu_eye, cos_light);
  Number mu2 = mu * mu;
  Number slopes =
      exp(-(Number(1.0) - mu2) / (mu2 * variance)) * Number(0.3183098861837907) / variance;
  Number visible =
      Number(1.0) / (Number(1.0) + SmithLambda(mu_light, variance) + SmithLambda(mu_eye, variance));
  return FresnelReflectance(cos_light, index) * slopes * visible /
         (Number(4.0) * mu_light * mu_eye * mu2 * mu2);
}

// Transmittance through a flat surface, relative to that at the zenith, 1 - (0.34 / 2.34)^2.
SHARED Number WaterTransmitted(Number mu, Number index) {
  return (Number(1.0) - FresnelReflectance(mu, index)) / Number(0.9789);
}

// Fraction of a uniform sky that returns from below the surface, relative to the reflectance below
// it: a flat surface of index 1.34 transmits 0.934 of the sky's light.
SHARED Number WaterLetsIn(Number index, Number mu_eye) {
  return Number(0.934) / Number(0.9789) * WaterTransmitted(mu_eye, index);
}

// Albedo of a wet rough surface: Lekner, Dorf (1988), Appl. Opt. 27, 1278. A film of water over
// facets that absorb a fraction `a` of light returns 0.472 of the light that they reflect back to
// them: 1 - (1 - r) / n^2, with r = 0.0659 the reflectance of water for diffuse light and n = 1.33.
// Facets of index 1.5 absorb more under water by (1 - 0.0308) / (1 - 0.0918); the darker they are,
// the smaller this increase is. The sheen of the film is not included.
// @param wetness  fraction of the surface that is wet.
SHARED Number WetAlbedo(Number dry, Number wetness) {
  Number absorbed = (Number(1.0) - dry) * (Number(1.0) + Number(0.06711) * dry);
  Number sent = Number(1.0) - absorbed;
  Number wet = Number(0.93407) * Number(0.52805) * sent / (Number(1.0) - Number(0.47195) * sent);
  return dry + wetness * (wet - dry);
}

// Escape function K of snow.
SHARED Number SnowEscape(Number mu) {
  return Number(0.42857142857142855) * (Number(1.0) + Number(2.0) * mu);
}

// Reflection R0 of snow without absorption: Kokhanovsky (2005), equations 13 and 14. The scattering
// angle is computed from its cosine, -cos_between.
SHARED Number SnowWithoutAbsorption(Number mu_light, Number mu_eye, Number cos_between) {
  Number sine = sqrt(max((Number(1.0) - cos_between) * (Number(1.0) + cos_between), Number(0.0)));
  Number scattering = atan(sine, -cos_between) * Number(57.29577951308232);
  Number phase = Number(11.1) * exp(Number(-0.087) * scattering) +
                 Number(1.1) * exp(Number(-0.014) * scattering);
  Number sum = mu_light + mu_eye;
  return (Number(1.247) + Number(1.186) * sum + Number(5.157) * mu_light * mu_eye + phase) /
         (Number(4.0) * sum);
}
