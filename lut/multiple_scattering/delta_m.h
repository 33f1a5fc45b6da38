// SPDX-License-Identifier: MIT
// This header provides the light that aerosol scatters forward, in closed form, in addition to
// moments of low degree.
//
// Delta-M (Wiscombe 1977, J. Atmos. Sci. 34, 1408): of every scattering by aerosol the fraction f =
// chi of degree L + 1 counts as unscattered. Successive orders are solved in the remaining medium,
//
//   extinction' = extinction - f scattering, scattering' = (1 - f) scattering,
//   chi'_l = (chi_l - f) / (1 - f),
//
// whose phase function ends at degree L, so nothing is truncated. The sun's beam in that medium is
// brighter than the true beam by light that is deflected little, T' - T = T (exp(f x) - 1) with x
// the optical depth of scattering by aerosol towards the sun. MultipleScattering::values() include
// it as multiply scattered light from the sun's direction, so that they mean the same with and
// without delta-M.
//
// Radiance along view rays is also gathered in that medium. Light scattered once then has the exact
// phase function and, in closed form, the peak of all orders (Nakajima, Tanaka 1988, J. Quant.
// Spectrosc. Radiat. Transf. 40, 51, in small-angle approximation: Wentzel 1922; van de Hulst 1980,
// Multiple Light Scattering, ch. 14): in a path of n scatterings any of them may be the one with a
// large deflection. Let y be the optical depth of scattering from the sun to the point and on to
// the eye. Degree l of the aerosol's light, for which the first order has chi_l, is then
//
//   (chi_l - f) exp(f y) + (exp(f y) - 1) / y    l <= L
//   (exp(chi_l y) - 1) / y                       l > L
//
// times T sigma_M (2 l + 1)/(4 pi) P_l(nu). The light of molecules has p_R exp(f y) instead of p_R.
// Only the forward half (1 + nu)/2 of the phase function has these coefficients; the backward half
// scatters the sun's beam once, with exp(f y). The series ends where its coefficients are
// negligible, at degree 160 for dust and haze, and at most at 8192. All degrees are summed before
// they are tabulated: at wide angles the low and the high ones cancel.
//
// A narrow backward lobe has no closed form in all orders. The moments hold it blurred: of its
// coefficient b of degree L + 1, degree l loses the part 1 - (1 - (l/(L + 1))^2)^2. The forward
// peak spreads what the moments lack of the lobe, (-1)^l b_l, by the factor exp(chi_l y) instead of
// exp(f y). Light that is sent up by the lobe and down again lies around the sun; it is computed in
// closed form from the column below each sample.
// Light from behind the end of the ray, seen through that medium, is brighter than through the true
// one by T (exp(f y) - 1), with y along the ray.
//
// In thin air nothing is removed from the moments, and degrees l <= L hold all their light. The
// moments lack the second line times T sigma_M, and only near the sun, where y is nearly constant
// along a ray (GlowAboutTheSun).
//
// The header also provides an estimate, for error statements, of the light of orders two and up in
// degrees of the aerosol's phase function that MultipleScattering does not keep (TruncationError).
//
// Light that is deflected little stays near the beam. Along the path from the sun to a point and
// on to the eye its degree l grows by exp(chi_l tau), where tau is the optical depth of scattering
// by aerosol along that path (small-angle approximation: Wentzel 1922; van de Hulst 1980, Multiple
// Light Scattering, ch. 14). Degrees above L therefore hold
//
//   A(nu) = integral of sigma_M T sum over l > L of (2 l + 1) / (4 pi) chi_l (exp(chi_l tau) - 1)
//           P_l(nu) ds
//
// in addition to light scattered once. A alternates in sign with the angle, and real paths blur the
// angles of the sign changes, so the estimate is |A| plus the envelope of its first term. It is 0
// where there is no aerosol.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "atmosphere/medium/medium.h"
#include "atmosphere/ray/ray.h"
#include "atmosphere/ray/ray_kernel.h"
#include "atmosphere/ray/single_scattering.h"
#include "lut/layer.h"

namespace alpenglow::lut {

/// Returns the columns on the path of sunlight that is scattered once at a sample [km].
[[nodiscard]] inline ColumnSet<float> FromSunToEye(const RaySamples<float>& samples,
                                                   std::size_t i) {
  return {samples.view_rayleigh[i] + samples.sun_rayleigh[i],
          samples.view_mie[i] + samples.sun_mie[i], samples.view_ozone[i] + samples.sun_ozone[i]};
}

/// The medium after delta-M scaling.
struct DeltaScaledMedium {
  Medium medium;
  std::vector<double> share;  // f per band, in [0, 1)
  std::vector<double> chi;    // chi'_l at [l * bands + band], l = 0 ... degree + 2; blurred
};

[[nodiscard]] DeltaScaledMedium WithoutPeak(const Medium& medium, int degree);

/// Number of depths of the peak.
inline constexpr std::size_t kPeakShapeDepths = 64;

/// Shape of the peak of one phase function: sums over its degrees at every angle.
struct PeakShape {
  float rate;                       // `high` is scaled by exp(-rate y)
  float depths_a_log;               // nodes of depth per unit of log(1 + y)
  std::vector<float> depth;         // y, from 0
  std::vector<float> high;          // [angle * depths + depth]: light by depth
  std::vector<float> twice_back;    // light of a narrow backward lobe; empty without one
  std::vector<float> blurred_back;  // the same light as the moments keep it; empty without one
};

/// Returns the light of narrow lobes, forward and backward, that thin air scatters twice: the
/// square of the largest coefficient of degrees 49 to 64 of the medium's aerosol, times the optical
/// depth that the aerosol scatters of a vertical beam.
[[nodiscard]] double NarrowLobes(const Medium& medium);

/// Returns the sample that is farthest from the observer. There must be one.
[[nodiscard]] std::size_t LastSample(const RaySamples<float>& samples);

/// Light near the sun that thin air scatters more than once towards the eye, beyond moments of some
/// degree. Immutable.
class GlowAboutTheSun {
 public:
  GlowAboutTheSun(const Medium& medium, int degree);

  /// Returns whether a direction with this cosine to the sun lies within the glow.
  [[nodiscard]] static bool Reaches(double nu);

  /// Returns the factor of light scattered once by aerosol, without its phase function [1/sr].
  /// @param column_km  aerosol column at the density on the ground: from the sun to the point and
  ///   on to the eye.
  [[nodiscard]] Spectrum FactorOf(double nu, float column_km) const;

 private:
  std::vector<float> scattering_per_km_;
  std::vector<PeakShape> shapes_;  // one for all bands, or one per band
};

/// The sun's beam in the medium after delta-M scaling. Immutable.
class ScaledBeam {
 public:
  ScaledBeam(const Medium& medium, int degree);

  /// Returns T' - T from a point to the sun; 0 where the ground hides the sun.
  /// @param height_m  below 0, the beam is that of altitude 0.
  [[nodiscard]] Spectrum At(double height_m, double mu_s) const;

  [[nodiscard]] const SingleScattering<float>& air() const { return air_; }
  [[nodiscard]] const std::vector<float>& share() const { return share_; }

 private:
  SingleScattering<float> air_;
  std::vector<float> share_;  // f per band
};

/// Densities relative to those on the ground, and columns to the sun [km], at a point.
struct SunlitPoint {
  float rayleigh_density, mie_density;
  float sun_rayleigh, sun_mie;
};

[[nodiscard]] inline SunlitPoint SunlitPointOf(const RaySamples<float>& samples, std::size_t i) {
  return {samples.rayleigh_density[i], samples.mie_density[i], samples.sun_rayleigh[i],
          samples.sun_mie[i]};
}

/// Returns the sunlight, relative to that at the point, that a backward delta function would send
/// up to it from the air below it, down to the ground: of what that air takes from a beam on its
/// way down and up, half the aerosol's share.
/// @param share  f.
[[nodiscard]] float UpFromBelow(const AirConstants<float>& air, std::size_t band, float share,
                                const SunlitPoint& point);

/// The formulas above for one band at one angle to the sun, without light scattered once.
class PeakAtAngle {
 public:
  /// @param shape   of the band; the caller keeps it alive.
  /// @param share   f.
  /// @param phase   phase function of the aerosol at this angle.
  PeakAtAngle(const PeakShape& shape, double nu, float share, float phase);

  /// Returns the light per length of a path on which aerosol scatters with optical depth y [1/km].
  /// @param depth  optical depth of the path, >= f y.
  /// @param of_gas, of_aerosol  scattering coefficients at the point [1/km]; that of molecules
  ///   times their phase function.
  [[nodiscard]] float LightOf(float y, float depth, float of_gas, float of_aerosol) const;

  /// Returns PeakShape::twice_back at the angle.
  [[nodiscard]] float twice_back() const { return twice_back_; }
  /// Returns the light of the backward lobe per scattering by aerosol on the path of LightOf.
  /// @param up  UpFromBelow.
  [[nodiscard]] float TwiceBackOf(float up, float y, float depth) const {
    return twice_back_ * up * std::exp(share_ * y - depth);
  }

 private:
  const PeakShape* shape_;
  float share_, back_, twice_back_;
  std::array<float, kPeakShapeDepths> high_;
};

/// The forward peak of all orders, prepared for look-ups. Immutable.
class DeltaM {
 public:
  DeltaM(const Medium& medium, int degree);

  /// Returns f of a band.
  [[nodiscard]] float share(std::size_t band) const { return beam_.share()[band]; }
  /// Returns the formulas at an angle for every band. They refer to this object.
  [[nodiscard]] std::vector<PeakAtAngle> At(double nu) const;

  /// Returns the light of aerosol over light that it scatters once, without its phase function
  /// [1/sr]. Depths over 4 count as 4.
  /// @param column_km  as for GlowAboutTheSun::FactorOf.
  [[nodiscard]] Spectrum FactorOf(double nu, float column_km) const;

  /// Returns ScaledBeam::At.
  [[nodiscard]] Spectrum Beam(double height_m, double mu_s) const {
    return beam_.At(height_m, mu_s);
  }

  /// The path from the observer to the end of samples of the true medium.
  struct Way {
    Spectrum clear;       // T
    Spectrum more;        // T' - T
    Spectrum scattering;  // optical depth of scattering by aerosol
    Spectrum depth;       // optical depth
  };
  [[nodiscard]] Way WayTo(const RaySamples<float>& samples) const;

  /// Returns the sum of the formulas above along samples, without light scattered once [1/sr].
  [[nodiscard]] Spectrum Along(const RaySamples<float>& samples, double nu) const;

  /// Returns the additional radiance that reaches the start of `way` because of the peak from
  /// samples beyond its end: the sum as seen from the start of `way`, minus the sum as seen from
  /// its end.
  [[nodiscard]] Spectrum Behind(const Way& way, const RaySamples<float>& samples, double nu) const;

  /// Returns whether an aerosol has a narrow backward lobe, whose light of more than two
  /// scatterings is blurred.
  [[nodiscard]] bool HasBackwardLobe() const;

  /// Returns an estimate of the light of a narrow backward lobe that Along and the moments of
  /// scaled air lack or misplace [1/sr].
  [[nodiscard]] Spectrum BackwardError(const RaySamples<float>& samples, double nu) const;

  [[nodiscard]] const SingleScattering<float>& air() const { return beam_.air(); }

 private:
  /// Optical depths between the observer and the start of the samples.
  struct PathAhead {
    float depth = 0.0F;
    float scattering = 0.0F;  // by aerosol
  };
  /// Returns the sum of the formulas for y + ahead.scattering along samples, seen through the path
  /// ahead, minus the same sum for y if there is such a path.
  [[nodiscard]] float SumAlong(std::size_t band, const RaySamples<float>& samples, double nu,
                               const PeakAtAngle& peak, const PathAhead& ahead) const;

  ScaledBeam beam_;
  std::vector<PeakShape> shapes_;  // one for all bands, or one per band
};

class TruncationError {
 public:
  /// @param degree  the largest degree that is kept.
  TruncationError(const Medium& medium, int degree);

  /// Returns the estimate for samples taken by SingleScattering(medium) [1/sr], per unit solar
  /// irradiance.
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
