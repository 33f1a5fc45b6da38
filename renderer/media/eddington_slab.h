// SPDX-License-Identifier: MIT
// Multiple scattering in a plane layer: Eddington's approximation, with the forward peak removed
// from the scattering.
//
//   I(tau, mu) = I0(tau) + I1(tau) mu                     mu > 0 downwards
//   dI1/dtau / 3 = -(1 - w) I0 + w S / 4 pi  e^(-tau / mu0)
//   dI0/dtau     = -(1 - w g) I1 + 3 w g mu0 S / 4 pi  e^(-tau / mu0)
//
// The boundary conditions are no diffuse light from above, and the ground's reflection from below.
// The forward peak is removed by
//
//   tau' = (1 - w f) tau,   w' = w (1 - f) / (1 - w f),   g' = (g - f) / (1 - f),   f = chi_2
//
// at most g, and 0 if g < 0, because a lobe that scatters backwards has no forward peak:
//
// Joseph, Wiscombe, Weinman (1976), "The delta-Eddington approximation for radiative flux
// transfer", J. Atmos. Sci. 33, 2452. For the layer, see Shettle and Weinman (1970), J. Atmos. Sci.
// 27, 1048.
#pragma once

#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Scattering properties of a layer.
struct SlabScattering {
  double albedo = 1.0;  // w, [0, 1]
  double chi_1 = 0.0;   // mean cosine of the phase function
  double chi_2 = 0.0;   // its second Legendre coefficient, < 1
};

/// Returns the fraction of the scattered light that is in the forward peak.
[[nodiscard]] double PeakFraction(const SlabScattering& scattering);

/// The diffuse field at a depth.
struct SlabField {
  double mean = 0.0;   // I0: mean radiance over all directions
  double slope = 0.0;  // I1: slope of the radiance in mu

  [[nodiscard]] double DownwardFlux() const;
  [[nodiscard]] double UpwardFlux() const;
};

/// A plane layer lit by a beam of unit irradiance perpendicular to the beam. Immutable.
class EddingtonSlab {
 public:
  /// @param depth  vertical optical depth of the layer, >= 0.
  /// @param ground_albedo  in [0, 1].
  /// @param mu0  cosine between the beam and the vertical, in (0, 1].
  EddingtonSlab(const SlabScattering& scattering, double depth, double ground_albedo, double mu0);

  /// Returns the diffuse field. Fluxes of layers lit from above are within 0.06 of the incident
  /// flux of a path tracer (tests/renderer/media/eddington_slab_test.cpp).
  /// @param depth  below the top of the layer, clamped to it.
  [[nodiscard]] SlabField At(double depth) const;

  /// Returns the transmittance of the beam over a slant depth, including the light in the forward
  /// peak.
  [[nodiscard]] double BeamLeft(double slant_depth) const;

 private:
  double depth_;                       // scaled, like all members below
  double scale_, mu0_;                 // factor on depths; cosine of the beam
  double k_ = 0.0, slope_of_k_ = 0.0;  // I1 of e^(-k tau), relative to I0
  double particular_ = 0.0, particular_slope_ = 0.0;
  double falling_ = 0.0, rising_ = 0.0;  // factors of e^(-k tau) and e^(-k (depth - tau))
};

}  // namespace alpenglow::renderer
