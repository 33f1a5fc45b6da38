// SPDX-License-Identifier: MIT
// This header computes the light that fog scatters, to all orders, under sun and sky. Fog is a
// level layer over the lowest ground.
//
// EddingtonSlab computes multiple scattering in a plane layer: Eddington's approximation, with the
// forward peak removed from the scattering.
//
//   I(tau, mu) = I0(tau) + I1(tau) mu                     mu > 0 downwards
//   dI1/dtau / 3 = -(1 - w) I0 + w S / 4 pi  e^(-tau / mu0)
//   dI0/dtau     = -(1 - w g) I1 + 3 w g mu0 S / 4 pi  e^(-tau / mu0)
//
// The boundary conditions are no diffuse light from above, and the ground's reflection from below.
// The forward peak is removed by
//
//   tau' = (1 - w f) tau,   w' = w (1 - f) / (1 - w f),   g' = (g - f) / (1 - f),   f = chi_2:
//
// Joseph, Wiscombe, Weinman (1976), "The delta-Eddington approximation for radiative flux
// transfer", J. Atmos. Sci. 33, 2452. For the layer, see Shettle and Weinman (1970), J. Atmos. Sci.
// 27, 1048.
//
// Radiances follow from this solution. The first order is exact, except for light in the forward
// peak, which is scattered by a lobe with the same mean cosine; higher orders are w (I0 + chi_1 I1
// mu). Compared with a path tracer, over layers of optical depth 0.5 to 8 with g = 0.8, the sun at
// 9 and 37 degrees and a view from outside, the relative error is 0.35 root mean square; the result
// is 0.4 to 2.5 of the value at worst (tests/renderer/media/eddington_slab_test.cpp). It
// approximates the light that single scattering omits where that is most of the light.
//
// FogLight evaluates
//
//   J = w [ p(cos) S e^-tau_s                      sun: first order
//         + p'(cos) S (e^-tau_s' - e^-tau_s)       sun: light in the forward peak
//         + sum chi_l L_lm Y_lm  e^(-tau' / 0.6)   sky: first order
//         + I0 + chi_1 I1 mu ]                     all higher orders (EddingtonSlab)
//
// with the optical depth tau_s towards the sun, tau' without the forward peak, and a lobe p' with
// the same mean cosine as p. Light that the ground reflects under a clear sky is removed from the
// moments L_lm, because the layer has its own ground.
#pragma once

#include <vector>

#include "renderer/illumination/occluded_sky.h"
#include "renderer/media/local_media.h"

namespace alpenglow::renderer {

/// Scattering properties of a layer.
struct SlabScattering {
  double albedo = 1.0;  // w, [0, 1]
  double chi_1 = 0.0;   // mean cosine of the phase function
  double chi_2 = 0.0;   // its second Legendre coefficient, < 1: fraction in the forward peak
};

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

/// The sun above fog; directions are those of DistantLight (lighting.h).
struct FogSun {
  glm::dvec3 to_light, to_light_for_air;  // unit
  BandLight in_air;  // transmittance of the air at the fog for sunlight above the horizon
};

/// Light scattered by fog for one position of the sun, per unit solar irradiance. Immutable. Refers
/// to the fog.
class FogLight {
 public:
  /// @param fog  a LocalMedium that is fog.
  /// @param bottom_m  altitude of the ground below it.
  FogLight(const LocalMedium& fog, const MultipleScattering& diffuse, const FogSun& sun,
           double bottom_m);

  /// Precomputed values of a ray through the fog.
  struct Look {
    double phase, broad_phase;   // p and p' towards the sun [1/sr]
    double down;                 // downward cosine of the arriving light: the look's zenith cosine
    std::vector<BandLight> sky;  // SkyMoments::Towards
  };
  [[nodiscard]] Look LookAlong(const glm::dvec3& look) const;

  /// Returns the light scattered per unit of scattering [1/sr]: from the sun with its glow in the
  /// fog, and from the sky.
  /// @param sun  transmittance of air, terrain and volumes for sunlight.
  /// @param lit  the same without the air, in [0, 1].
  /// @param slant_depth  of the fog towards the sun.
  struct Scattered {
    BandLight of_sun, of_sky;
  };
  [[nodiscard]] Scattered At(const Look& look, double altitude_m, const BandLight& sun,
                             const BandLight& lit, double slant_depth) const;

  /// Return the transmittance of skylight from above to an altitude, and of a beam over a slant
  /// depth; both include the light in the forward peak.
  [[nodiscard]] float SkyLeft(double altitude_m) const;
  [[nodiscard]] float BeamLeft(double slant_depth) const;

  /// Returns the irradiance of a surface by the fog's own light [1].
  /// @param cos_up  of its normal's zenith angle.
  [[nodiscard]] BandLight OnSurface(double altitude_m, double cos_up) const;

 private:
  struct Glow {
    std::vector<BandLight> mean, slope;  // at depth (i / last)^4 of the layer's [1/sr]
  };
  struct Place {
    std::size_t low;
    float share;
  };
  [[nodiscard]] double DepthAbove(double altitude_m) const;
  [[nodiscard]] Place PlaceOf(double altitude_m) const;
  [[nodiscard]] static BandLight At(const std::vector<BandLight>& nodes, const Place& place);
  void Solve(double albedo, double mu0, const BandLight& sun, const BandLight& sky,
             const std::vector<double>& ground_albedo);

  const LocalMedium& fog_;
  glm::dvec3 to_sun_;
  std::vector<double> chi_;
  PhaseFunction broad_;
  double extinction_per_m_, depth_;
  double peak_scale_;  // scales optical depths to exclude the forward peak
  SkyMoments sky_;     // without the ground
  BandLight ground_;   // radiance of the ground under a clear sky
  Glow of_sun_, of_sky_;
};

}  // namespace alpenglow::renderer
