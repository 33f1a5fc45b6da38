// SPDX-License-Identifier: MIT
// Light that aerosol throws forward, in closed form beside moments of few degrees.
//
// Delta-M (Wiscombe 1977, J. Atmos. Sci. 34, 1408): of every scattering by aerosol the share f =
// chi of degree L + 1 counts as unscattered. Successive orders are solved in the air that is left,
//
//   extinction' = extinction - f scattering, scattering' = (1 - f) scattering,
//   chi'_l = (chi_l - f) / (1 - f),
//
// whose phase function ends at degree L: nothing is truncated. The sun's beam of that air is
// brighter than the true one by light that has turned little, T' - T = T (exp(f x) - 1) with x the
// optical depth of scattering by aerosol towards the sun. DiffuseLight::values() hold it as diffuse
// light from the sun's direction, so that they mean the same with and without this.
//
// Rays are gathered in that air too. Light scattered once then has the exact phase function and, in
// closed form, the peak of all orders (Nakajima, Tanaka 1988, J. Quant. Spectrosc. Radiat. Transf.
// 40, 51, in small-angle approximation: Wentzel 1922; van de Hulst 1980, Multiple Light Scattering,
// ch. 14): a path of n scatterings may have its large turn at any of them. With y the optical depth of scattering from the sun to the point and on to the eye degree l
// of the aerosol's light is, where the first order has chi_l,
//
//   (chi_l - f) exp(f y) + (exp(f y) - 1) / y    l <= L
//   (exp(chi_l y) - 1) / y                       l > L
//
// times T sigma_M (2 l + 1)/(4 pi) P_l(nu), and that of molecules p_R exp(f y) instead of p_R. What is behind the end of the ray, seen through
// that air, is brighter than through the true by T (exp(f y) - 1), y along the ray.
//
// In thin air nothing is taken out of the moments, and degrees l <= L hold all light. What they
// lack is the second line with T sigma_M before it, and only near the sun, where y is nearly the
// same from end to end of a ray (GlowAboutTheSun).
//
// How much light of orders two and up lies in degrees of the aerosol's phase function that
// DiffuseLight does not keep: an estimate, for those who state an error.
//
// Light that is deflected little stays near the beam, and along the way from the sun to a point and
// on to the eye its degree l grows by exp(chi_l tau), tau being the optical depth of scattering by
// aerosol along that way (small-angle approximation: Wentzel 1922; van de Hulst 1980, Multiple
// Light Scattering, ch. 14). Degrees above L therefore hold
//
//   A(nu) = integral of sigma_M T sum over l > L of (2 l + 1) / (4 pi) chi_l (exp(chi_l tau) - 1)
//           P_l(nu) ds
//
// beside what is scattered once. A alternates in sign with the angle, and real paths blur where:
// the estimate is |A| plus the envelope of its first term. 0 where no aerosol is.
#pragma once

#include <vector>

#include "atmosphere/air/medium.h"
#include "atmosphere/ray/ray.h"
#include "atmosphere/ray/ray_kernel.h"
#include "atmosphere/ray/single_scattering.h"
#include "lut/layer.h"

namespace alpenglow::lut {

/// The air that delta-M leaves.
struct AirWithoutPeak {
  Medium medium;
  std::vector<double> share;  // f of a band, in [0, 1)
  std::vector<double> chi;    // chi'_l at [l * bands + band], l = 0 ... degree
};

[[nodiscard]] AirWithoutPeak WithoutPeak(const Medium& medium, int degree);

/// One phase function: its degrees up to L, and light of higher degrees by depth.
struct PeakShape {
  std::vector<float> low;   // [angle]: of the phase function
  std::vector<float> high;  // [angle * depths + depth], times exp(-y)
};

/// Light that thin air scatters more than once towards an eye that looks near the sun, beyond moments of
/// some degree. Immutable.
class GlowAboutTheSun {
 public:
  GlowAboutTheSun(const Medium& medium, int degree);

  /// Returns whether a direction of this cosine to the sun lies where there is any.
  [[nodiscard]] static bool Reaches(double nu);

  /// By what light scattered once by aerosol, without its phase function, is to be multiplied [1/sr].
  /// @param column_km  of aerosol at its density on the ground: from the sun to the point and on to
  ///   the eye.
  [[nodiscard]] Bands<float> FactorOf(double nu, float column_km) const;

 private:
  std::vector<float> scattering_per_km_;
  std::vector<PeakShape> shapes_;  // one, or one a band
};

/// Ready for look-ups. Immutable.
class ForwardPeak {
 public:
  ForwardPeak(const Medium& medium, int degree);

  /// T' - T from a point to the sun; 0 where the ground hides it.
  [[nodiscard]] Bands<float> Beam(double altitude_m, double mu_s) const;

  /// From the observer to the end of samples of the true air.
  struct Way {
    Bands<float> clear;       // T
    Bands<float> more;        // T' - T
    Bands<float> scattering;  // optical depth of scattering by aerosol
  };
  [[nodiscard]] Way WayTo(const RaySamples<float>& samples) const;

  /// The sum of the formulas above along samples less what is scattered once [1/sr].
  [[nodiscard]] Bands<float> Along(const RaySamples<float>& samples, double nu) const;

  /// The same of samples behind the end of a way, seen from its beginning, less the sum as seen
  /// from its end: what the peak brings from there.
  [[nodiscard]] Bands<float> Behind(const Way& way, const RaySamples<float>& samples,
                                    double nu) const;

  [[nodiscard]] const AirIntegrator<float>& air() const { return air_; }

 private:
  /// Sum of formula(y + ahead) - formula(base y) along samples.
  [[nodiscard]] float SumAlong(std::size_t band, const RaySamples<float>& samples, double nu,
                               float ahead, float base) const;

  AirIntegrator<float> air_;
  int degree_;
  std::vector<float> share_;       // f of a band
  std::vector<PeakShape> shapes_;  // one, or one a band
};

class MissingDegrees {
 public:
  /// @param degree  the largest that is kept.
  MissingDegrees(const Medium& medium, int degree);

  /// Of samples that AirIntegrator(medium) took [1/sr], per unit solar irradiance.
  [[nodiscard]] std::vector<double> Along(const AirConstants<float>& air,
                                          const RaySamples<float>& samples, double nu) const;

 private:
  [[nodiscard]] double AlongBand(const AirConstants<float>& air, std::size_t band,
                                 const RaySamples<float>& samples,
                                 const std::vector<double>& legendre) const;

  std::size_t bands_;
  int degree_;
  std::vector<double> chi_;  // [l * bands + band]
};

}  // namespace alpenglow::lut
