// SPDX-License-Identifier: MIT
#include "atmosphere/medium/lorenz_mie.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"

namespace alpenglow::atmosphere {
namespace {

using Complex = std::complex<double>;

struct Coefficients {
  std::vector<Complex> a, b;  // orders n = 1, 2, ..., at index n - 1
};

// Returns the logarithmic derivative of psi at m x, for n = 0 ... count.
std::vector<Complex> LogarithmicDerivatives(Complex mx, std::size_t count) {
  const std::size_t start = std::max(count, static_cast<std::size_t>(std::ceil(std::abs(mx)))) + 16;
  std::vector<Complex> d(start + 1, Complex(0.0));
  for (std::size_t n = start; n > 0; --n) {
    const Complex ratio = static_cast<double>(n) / mx;
    d[n - 1] = ratio - 1.0 / (d[n] + ratio);
  }
  return d;
}

Coefficients CoefficientsOf(Complex index, double x) {
  // Number of significant terms: Wiscombe (1980), Appl. Opt. 19, 1505.
  const auto count = static_cast<std::size_t>(x + 4.05 * std::cbrt(x) + 2.0);
  const std::vector<Complex> d = LogarithmicDerivatives(index * x, count);
  double psi_before = std::cos(x), psi = std::sin(x);
  double chi_before = -std::sin(x), chi = std::cos(x);
  Coefficients coefficients;
  for (std::size_t k = 1; k <= count; ++k) {
    const double n = static_cast<double>(k);
    const double psi_next = (2.0 * n - 1.0) / x * psi - psi_before;
    const double chi_next = (2.0 * n - 1.0) / x * chi - chi_before;
    const Complex xi(psi, -chi), xi_next(psi_next, -chi_next);
    const Complex electric = d[k] / index + n / x;
    const Complex magnetic = index * d[k] + n / x;
    coefficients.a.push_back((electric * psi_next - psi) / (electric * xi_next - xi));
    coefficients.b.push_back((magnetic * psi_next - psi) / (magnetic * xi_next - xi));
    psi_before = psi;
    psi = psi_next;
    chi_before = chi;
    chi = chi_next;
  }
  return coefficients;
}

/// Amplitudes of the field perpendicular (s1) and parallel (s2) to the scattering plane.
struct Amplitudes {
  Complex s1{0.0}, s2{0.0};
};

Amplitudes AmplitudesAt(const Coefficients& c, double cosine) {
  double pi_before = 0.0, pi = 1.0;
  Amplitudes sum;
  for (std::size_t k = 0; k < c.a.size(); ++k) {
    const double n = static_cast<double>(k + 1);
    const double tau = n * cosine * pi - (n + 1.0) * pi_before;
    const double weight = (2.0 * n + 1.0) / (n * (n + 1.0));
    sum.s1 += weight * (c.a[k] * pi + c.b[k] * tau);
    sum.s2 += weight * (c.a[k] * tau + c.b[k] * pi);
    const double pi_next = ((2.0 * n + 1.0) * cosine * pi - (n + 1.0) * pi_before) / n;
    pi_before = pi;
    pi = pi_next;
  }
  return sum;
}

// Returns the sum over n whose product with 4/x^2 is mean_cosine * scattering_efficiency.
double ForwardSum(const Coefficients& c) {
  double sum = 0.0;
  for (std::size_t k = 0; k < c.a.size(); ++k) {
    const double n = static_cast<double>(k + 1);
    if (k + 1 < c.a.size()) {
      sum += n * (n + 2.0) / (n + 1.0) *
             std::real(c.a[k] * std::conj(c.a[k + 1]) + c.b[k] * std::conj(c.b[k + 1]));
    }
    sum += (2.0 * n + 1.0) / (n * (n + 1.0)) * std::real(c.a[k] * std::conj(c.b[k]));
  }
  return sum;
}

}  // namespace

SphereScattering ScatterBySphere(std::complex<double> index, double size_parameter,
                                 const std::vector<double>& angle_rad) {
  RequireInRange(size_parameter, 1e-3, 1e4, "size_parameter");
  RequireInRange(index.real(), 1e-3, 100.0, "real part of the refractive index");
  RequireInRange(index.imag(), 0.0, 100.0, "imaginary part of the refractive index");
  const Coefficients c = CoefficientsOf(index, size_parameter);
  const double x2 = size_parameter * size_parameter;
  SphereScattering sphere;
  for (std::size_t k = 0; k < c.a.size(); ++k) {
    const double weight = 2.0 / x2 * (2.0 * static_cast<double>(k + 1) + 1.0);
    sphere.extinction_efficiency += weight * std::real(c.a[k] + c.b[k]);
    sphere.scattering_efficiency += weight * (std::norm(c.a[k]) + std::norm(c.b[k]));
  }
  sphere.mean_cosine = 4.0 / x2 * ForwardSum(c) / sphere.scattering_efficiency;
  for (const double angle : angle_rad) {
    const auto [s1, s2] = AmplitudesAt(c, std::cos(angle));
    const double intensity = 0.5 * (std::norm(s1) + std::norm(s2));
    const Complex both = s2 * std::conj(s1);
    sphere.per_sr.push_back(intensity / (kPi * x2 * sphere.scattering_efficiency));
    sphere.polarised.a3.push_back(both.real() / intensity);
    sphere.polarised.b1.push_back(0.5 * (std::norm(s2) - std::norm(s1)) / intensity);
    sphere.polarised.b2.push_back(both.imag() / intensity);
  }
  return sphere;
}

namespace {

using Ratio = std::vector<double> SphereRatios::*;
constexpr std::array<Ratio, 3> kRatios{&SphereRatios::a3, &SphereRatios::b1, &SphereRatios::b2};

}  // namespace

SphereScattering ScatterBySpheres(std::complex<double> index, const SizeDistribution& sizes,
                                  double wavelength_nm, const std::vector<double>& angle_rad) {
  constexpr int kRadii = 400;
  const double a = sizes.effective_radius_um;
  const double v = sizes.effective_variance;
  RequireInRange(v, 1e-4, 0.499, "effective_variance");
  const double spread = std::min(12.0, 1.0 + 12.0 * std::sqrt(v));
  const double smallest = std::max(1.0 - 12.0 * std::sqrt(v), 1.0 / 200.0);
  SphereScattering all;
  all.per_sr.assign(angle_rad.size(), 0.0);
  for (const Ratio ratio : kRatios) (all.polarised.*ratio).assign(angle_rad.size(), 0.0);
  double area = 0.0;
  // The radii are uniform in log r: n(r) r^2 dr = n(r) r^3 d(log r).
  for (int i = 0; i < kRadii; ++i) {
    const double radius = a * smallest * std::pow(spread / smallest, (i + 0.5) / kRadii);
    const double shadow =
        std::exp((1.0 / v - 3.0) * std::log(radius / a) - (radius / a - 1.0) / v) *
        std::pow(radius / a, 3);
    const SphereScattering one =
        ScatterBySphere(index, 2.0 * kPi * radius * 1000.0 / wavelength_nm, angle_rad);
    const double scattered = shadow * one.scattering_efficiency;
    area += shadow;
    all.extinction_efficiency += shadow * one.extinction_efficiency;
    all.scattering_efficiency += scattered;
    all.mean_cosine += scattered * one.mean_cosine;
    for (std::size_t k = 0; k < angle_rad.size(); ++k) {
      const double light = scattered * one.per_sr[k];
      all.per_sr[k] += light;
      for (const Ratio ratio : kRatios)
        (all.polarised.*ratio)[k] += light * (one.polarised.*ratio)[k];
    }
  }
  all.mean_cosine /= all.scattering_efficiency;
  for (std::size_t k = 0; k < angle_rad.size(); ++k) {
    for (const Ratio ratio : kRatios) (all.polarised.*ratio)[k] /= all.per_sr[k];
    all.per_sr[k] /= all.scattering_efficiency;
  }
  all.extinction_efficiency /= area;
  all.scattering_efficiency /= area;
  return all;
}

}  // namespace alpenglow::atmosphere
