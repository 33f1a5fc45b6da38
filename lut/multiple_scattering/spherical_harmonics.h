// SPDX-License-Identifier: MIT
// This header provides real spherical harmonics around the vertical, even in azimuth, and Legendre
// series of phase functions.
//
//   Y_lm(mu, phi) = norm_lm P_l^m(mu) cos(m phi),   0 <= m <= l
//
// They are orthonormal over the sphere, without the Condon-Shortley phase (it cancels between
// projection and evaluation). Moments are stored l major: 00, 10, 11, 20, 21, 22, ...
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "atmosphere/math/constants.h"
#include "atmosphere/medium/medium.h"
#include "atmosphere/medium/phase.h"
#include "lut/layer.h"

namespace alpenglow::lut {

inline constexpr int kMaxDegree = 12;
/// Supported degrees of multiply scattered light. Every kernel of multiply scattered light is
/// compiled for each of them.
inline constexpr std::array kDegrees{2, 4, 6, 8, kMaxDegree};
/// Throws InputError, which lists the supported degrees, if `degree` is none of them.
void RequireDegree(int degree);

[[nodiscard]] constexpr std::size_t MomentCount(int degree) {
  return static_cast<std::size_t>((degree + 1) * (degree + 2) / 2);
}
[[nodiscard]] constexpr std::size_t MomentIndex(int l, int m) {
  return static_cast<std::size_t>(l * (l + 1) / 2 + m);
}
inline constexpr std::size_t kMaxMoments = MomentCount(kMaxDegree);

using Moments = std::array<float, kMaxMoments>;

struct HarmonicNorms {
  float of[kMaxMoments];  // norm_lm by MomentIndex
};
[[nodiscard]] constexpr HarmonicNorms FindHarmonicNorms() {
  HarmonicNorms norms{};
  for (int l = 0; l <= kMaxDegree; ++l) {
    for (int m = 0; m <= l; ++m) {
      double square = (m == 0 ? 1.0 : 2.0) * (2 * l + 1) / (4.0 * kPi);
      for (int k = l - m + 1; k <= l + m; ++k) square /= k;
      double root = square < 1.0 ? 1.0 : square;
      for (double next = 0.5 * (root + square / root); next < root;
           next = 0.5 * (root + square / root))
        root = next;
      norms.of[MomentIndex(l, m)] = static_cast<float>(root);
    }
  }
  return norms;
}
// The constant is not inline, so that kernels define no symbol for it.
constexpr HarmonicNorms kHarmonicNorm = FindHarmonicNorms();

/// Returns norm_lm P_l^m(mu) for l <= degree. @param mu in [-1, 1].
[[nodiscard]] Moments LegendreTerms(int degree, float mu);

/// Returns Y_lm for l <= degree. @param cos_azimuth cos(phi).
[[nodiscard]] Moments SphericalHarmonics(int degree, float mu, float cos_azimuth);

/// Returns the cosine of the azimuth between two directions of zenith cosines mu and mu_s with
/// cosine nu between them; an arbitrary value in [-1, 1] if one of them is vertical.
[[nodiscard]] float AzimuthCosine(float mu, float mu_s, float nu);

/// Returns (2 l + 1) / (4 pi) P_l(nu) for l = 0 ... degree: the factors of the coefficients below.
[[nodiscard]] std::vector<double> LegendreSeries(int degree, double nu);

/// Returns the Legendre coefficients chi_l = 2 pi integral of p(x) P_l(x) dx, l = 0 ... degree;
/// chi_0 = 1. The error is below 1e-6 up to degree 170 and, for lobes of Henyey and Greenstein, up
/// to degree 8192; for tables it is below 2e-6 up to degree 600 (asserted by
/// multiple_scattering_test).
[[nodiscard]] std::vector<double> LegendreCoefficients(const PhaseFunction& phase, int degree);

/// Returns the Legendre coefficients of the medium's aerosol at every wavelength: chi_l of a band
/// at [l * bands + band].
[[nodiscard]] std::vector<double> MieLegendreCoefficients(const Medium& medium, int degree);

}  // namespace alpenglow::lut
