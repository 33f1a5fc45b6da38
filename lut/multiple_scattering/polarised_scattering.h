// SPDX-License-Identifier: MIT
// This header provides the polarised light that molecules scatter, with the tensor that is its
// source.
//
// Light along n is a real symmetric tensor C(n), C n = 0: radiance I = tr C; with l = (up, tilted
// into the plane across n) and h level, Q = l.C.l - h.C.h and U = 2 l.C.h. With J = integral of C
// over all directions, P = 1 - n n^T and D = RoundShare(d), molecules of depolarisation d scatter
//
//   dC/ds = sigma [D 3/(8 pi) P J P + (1 - D) tr J/(4 pi) P/2]
//
// (Chandrasekhar 1960, Radiative Transfer, ch. 1.16, written without planes of reference; aerosol
// and ground depolarise: C = I P/2). J has four independent components because the vertical plane
// of the sun is a plane of symmetry. Its trace is the moment 00 of I. The other three are stored as
// the moments of degree 2 that unpolarised light would need for the same scattered radiance,
//
//   T20 = -5 / (2 pi N20) (Jzz - (Jxx + Jyy) / 2)   T21 = -5 / (2 pi N21) Jxz
//   T22 = -5 / (8 pi N22) (Jxx - Jyy)               (x towards the sun's azimuth, z up),
//
// with N the norms of spherical_harmonics.h without the factors 3 of P_2^m. Radiance then follows
// from the formula of scalar light, sigma [00 Y00 + D/10 sum of T2m Y2m]. With zenith cosine mu and
// sine s of the ray and its azimuth phi from the sun,
//
//   Q = sigma D/10 [-3/2 N20 s^2 T20 + 3 N21 mu s cos(phi) T21 - 3 N22 (1 + mu^2) cos(2 phi) T22]
//   U = sigma D/10 [-3 N21 s sin(phi) T21 + 6 N22 mu sin(2 phi) T22]
//
// with l = (mu cos(phi), mu sin(phi), -s) and h = (-sin(phi), cos(phi), 0). l and h are constant
// along a straight ray, so Q and U are simply summed.
//
// Near a sun in the zenith moments of order m fall as the m-th power of the sun's zenith sine. All
// moments of polarised tables are divided by it (by the square for m > 2) before they are
// interpolated between suns. The last sun lies close to the zenith, where the quotient is still
// accurate.
//
// The header also provides the polarisation of light along a ray, for unit solar irradiance.
#pragma once

#include <cstddef>

#include "atmosphere/medium/medium.h"
#include "atmosphere/ray/ray.h"
#include "lut/layer.h"

namespace alpenglow::lut {

/// Zenith cosine of the last sun of polarised tables.
inline constexpr double kHighestPolarisedSun = 0.9999;
/// Number of tensor components in addition to moment 00.
inline constexpr std::size_t kTensorMoments = 3;

/// N20, N21, N22.
inline constexpr float kTensorNorm[kTensorMoments] = {0.630783131F, 0.36418281F, 0.182091405F};

/// Factors of Q and U of a ray: those of D/10 T2m cos(m phi) and D/10 T2m sin(m phi).
template <typename Number>
struct TensorStokes {
  Number q20, q21, q22, u21, u22;
};

template <typename Number>
[[nodiscard, gnu::always_inline]] inline TensorStokes<Number> TensorStokesAlong(
    const Number& mu, const Number& sine) {
  const Number n20(kTensorNorm[0]), n21(kTensorNorm[1]), n22(kTensorNorm[2]);
  return {Number(-1.5F) * n20 * sine * sine, Number(3.0F) * n21 * mu * sine,
          Number(-3.0F) * n22 * (Number(1.0F) + mu * mu), Number(-3.0F) * n21 * sine,
          Number(6.0F) * n22 * mu};
}

/// Returns the divisor of moments of order m between suns, for suns of this zenith sine.
[[nodiscard]] constexpr float SinePower(std::size_t m, float sine) {
  return m == 0 ? 1.0F : m == 1 ? sine : sine * sine;
}

/// Stokes parameters of light along a ray [1/sr]. Light with Q > 0 vibrates in the vertical plane
/// of the view. Light with U > 0 vibrates from the upper right to the lower left as seen by the
/// eye, if the sun is to the left of the view (if it is to the right, U has the opposite sign). A
/// vertical view counts as tilted towards the sun's azimuth.
struct PolarisedLight {
  Spectrum q, u;
};

/// Returns the polarisation of sunlight that molecules scatter once into the ray: 3/(16 pi) D sin^2
/// of the scattering angle, perpendicular to the plane through the sun. Aerosol and ground
/// depolarise.
[[nodiscard]] PolarisedLight PolarisedOnce(const Medium& medium, const ScatteredOnce<float>& once,
                                           const ViewRay& ray);

/// Returns the cosine of the azimuth between a direction and the sun; 1 if one of them is vertical.
[[nodiscard]] double AzimuthCosineOrAhead(double mu, double mu_s, double nu);

}  // namespace alpenglow::lut
