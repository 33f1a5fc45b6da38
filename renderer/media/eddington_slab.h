// SPDX-License-Identifier: MIT
// Light inside a plane layer of fog, scattered there any number of times: Eddington's approximation
// with the forward peak taken out of the scattering.
//
//   I(tau, mu) = I0(tau) + I1(tau) mu                     mu > 0 downwards
//   dI1/dtau / 3 = -(1 - w) I0 + w S / 4 pi  e^(-tau / mu0)
//   dI0/dtau     = -(1 - w g) I1 + 3 w g mu0 S / 4 pi  e^(-tau / mu0)
//
// with no diffuse light from above, and the ground's reflection from below; after
//
//   tau' = (1 - w f) tau,   w' = w (1 - f) / (1 - w f),   g' = (g - f) / (1 - f),   f = chi_2:
//
// Joseph, Wiscombe, Weinman (1976), "The delta-Eddington approximation
// for radiative flux transfer", J. Atmos. Sci. 33, 2452. Shettle and
// Weinman (1970), J. Atmos. Sci. 27, 1048, for the layer.
//
// Radiances from it: the first order is exact but for light that the forward peak has taken
// along, which is scattered as by a lobe of the same mean cosine; the orders beyond it are w
// (I0 + chi_1 I1 mu). Against a path tracer, over layers of optical depth 0.5 to 8, g = 0.8,
// the sun at 9 and 37 degrees, looking from outside: off by 0.35 of the value root mean square,
// between 0.4 and 2.5 of it at worst (tests/renderer/media/eddington_slab_test.cpp). It is an
// approximation of what single scattering leaves out, where that is most of the light.
#pragma once

namespace alpenglow::renderer {

/// What a layer scatters with.
struct SlabScattering {
  double albedo = 1.0;  // w, [0, 1]
  double chi_1 = 0.0;   // mean cosine of the phase function
  double chi_2 = 0.0;   // its second Legendre coefficient, < 1: the share of the forward peak
};

/// The diffuse field at a depth.
struct SlabField {
  double mean = 0.0;   // I0: of the radiance over all directions
  double slope = 0.0;  // I1: of the radiance in mu

  [[nodiscard]] double DownwardFlux() const;
  [[nodiscard]] double UpwardFlux() const;
};

/// Lit by a beam of unit irradiance across itself. Immutable.
class EddingtonSlab {
 public:
  /// @param depth  vertical optical depth of the layer, >= 0.
  /// @param ground_albedo  in [0, 1].
  /// @param mu0  cosine between the beam and the vertical, in (0, 1].
  EddingtonSlab(const SlabScattering& scattering, double depth, double ground_albedo, double mu0);

  /// @param depth  below the top of the layer, clamped to it. Fluxes of layers lit from above are
  ///     right to 0.06 of what falls in, from a path tracer
  ///     (tests/renderer/media/eddington_slab_test.cpp).
  [[nodiscard]] SlabField At(double depth) const;

  /// What is left of the beam after a slant depth, with what the forward peak has taken along.
  [[nodiscard]] double BeamLeft(double slant_depth) const;

 private:
  double depth_;                       // scaled, as all below
  double scale_, mu0_;                 // of depths
  double k_ = 0.0, slope_of_k_ = 0.0;  // I1 of e^(-k tau), relative to I0
  double particular_ = 0.0, particular_slope_ = 0.0;
  double falling_ = 0.0, rising_ = 0.0;  // of e^(-k tau) and e^(-k (depth - tau))
};

}  // namespace alpenglow::renderer
