// SPDX-License-Identifier: MIT
// Light of higher orders from its moments over altitude and sun (DiffuseLight of
// multiple_scattering.h). DEGREE, the largest l, is defined before this text.
#define MOMENTS ((DEGREE + 1) * (DEGREE + 2) / 2)

// One layer a moment (l major), then the irradiance from the sky; s: sun, t: altitude.
uniform sampler2DArray diffuse_moments;

// Of moment (l, m): norm of its harmonic, Legendre coefficient of molecules, coefficient of the
// clamped cosine; Legendre coefficients of the aerosol in the bands. MomentBlock of
// uniform_blocks.h.
layout(std140) uniform Moments {
  vec4 moment_factor[MOMENTS];
  vec4 moment_mie[MOMENTS];
  vec4 sun_axis;  // centre and width of the sun's axis, asinh at its ends
};

vec2 MomentsAt(float h, float mu_s) {
  ivec2 size = textureSize(diffuse_moments, 0).xy;
  float v = (asinh((mu_s - sun_axis.x) / sun_axis.y) - sun_axis.z) / (sun_axis.w - sun_axis.z);
  float u = sqrt(clamp(h / TOP, 0.0, 1.0));
  return vec2(TexelFromUnit(clamp(v, 0.0, 1.0), float(size.x)), TexelFromUnit(u, float(size.y)));
}

// Real spherical harmonics Y_lm(mu, phi), l major.
float[MOMENTS] Harmonics(float mu, float cos_azimuth) {
  float y[MOMENTS];
  float sine = sqrt(max((1.0 - mu) * (1.0 + mu), 0.0));
  float diagonal = 1.0;
  float cosine = 1.0;          // cos(m phi)
  float before = cos_azimuth;  // cos((m - 1) phi)
  for (int m = 0; m <= DEGREE; ++m) {
    float lower = 0.0;
    float value = diagonal;
    for (int l = m; l <= DEGREE; ++l) {
      int i = l * (l + 1) / 2 + m;
      y[i] = moment_factor[i].x * value * cosine;
      float next = (float(2 * l + 1) * mu * value - float(l + m) * lower) / float(l + 1 - m);
      lower = value;
      value = next;
    }
    diagonal *= float(2 * m + 1) * sine;
    float following = 2.0 * cos_azimuth * cosine - before;
    before = cosine;
    cosine = following;
  }
  return y;
}

float AzimuthCosine(float mu, float mu_s, float nu) {
  float sines = sqrt(max((1.0 - mu) * (1.0 + mu) * (1.0 - mu_s) * (1.0 + mu_s), 1e-12));
  return clamp((nu - mu * mu_s) / sines, -1.0, 1.0);
}

// Light of orders two and up that a kilometre of air at the point scatters into the ray.
vec4 DiffuseSource(AirPoint point, float nu) {
  float y[MOMENTS] = Harmonics(point.mu, AzimuthCosine(point.mu, point.mu_s, nu));
  vec2 at = MomentsAt(point.h, point.mu_s);
  vec4 rayleigh = vec4(0.0);
  vec4 mie = vec4(0.0);
  for (int i = 0; i < MOMENTS; ++i) {
    vec4 light = y[i] * texture(diffuse_moments, vec3(at, float(i)));
    mie += moment_mie[i] * light;
    rayleigh += moment_factor[i].y * light;
  }
  return rayleigh_scattering * point.rayleigh * max(rayleigh, vec4(0.0)) +
         mie_scattering * point.mie * max(mie, vec4(0.0));
}

// P_l(x), the first even l that the moments lack.
float FirstMissingLegendre(float x) {
  float before = 1.0;
  float now = x;
  for (int l = 1; l < DEGREE / 2 * 2 + 2; ++l) {
    float next = (float(2 * l + 1) * x * now - float(l) * before) / float(l + 1);
    before = now;
    now = next;
  }
  return now;
}

// Diffuse irradiance on a surface, per unit solar irradiance: DiffuseLight::Irradiance.
// @param normal_mu  vertical component of the normal; cos_azimuth from the sun's azimuth to it.
vec4 DiffuseIrradiance(float h, float mu_s, float normal_mu, float cos_azimuth) {
  float y[MOMENTS] = Harmonics(normal_mu, cos_azimuth);
  float upward[MOMENTS] = Harmonics(1.0, 1.0);
  float missing = FirstMissingLegendre(normal_mu);
  vec2 at = MomentsAt(h, mu_s);
  vec4 irradiance = missing * texture(diffuse_moments, vec3(at, float(MOMENTS)));
  for (int i = 0; i < MOMENTS; ++i) {
    irradiance += ((y[i] - missing * upward[i]) * moment_factor[i].z) *
                  texture(diffuse_moments, vec3(at, float(i)));
  }
  return max(irradiance, vec4(0.0));
}
