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
//
// Fog under sun and sky: what it scatters, to all orders, as a level layer over the lowest ground.
//
//   J = w [ p(cos) S e^-tau_s + p'(cos) S (e^-tau_s' - e^-tau_s)             sun: first order, and
//   what
//                                                                           the forward peak took
//                                                                           along
//         + sum chi_l L_lm Y_lm  e^(-tau' / 0.6)                             sky: first order
//         + I0 + chi_1 I1 mu ]                                               all beyond
//         (EddingtonSlab)
//
// tau_s the optical depth towards the sun, tau' without the forward peak, p' a lobe of the same
// mean cosine as p. Light that the ground reflects under a clear sky is taken out of the moments
// L_lm, for the layer has a ground of its own.
#pragma once

#include <vector>

#include "renderer/light/open_sky.h"
#include "renderer/media/local_media.h"

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

/// The sun over fog; directions as those of DistantLight (lighting.h).
struct FogSun {
  glm::dvec3 to_light, to_light_for_air;  // unit
  BandLight in_air;  // what the air leaves of sunlight at the fog, of the disk over the horizon
};

/// For one position of the sun; per unit solar irradiance. Immutable. Refers to the fog.
class FogLight {
 public:
  /// @param fog  a LocalMedium that is fog.
  /// @param bottom_m  altitude of the ground under it.
  FogLight(const LocalMedium& fog, const DiffuseLight& diffuse, const FogSun& sun, double bottom_m);

  /// A ray through the fog.
  struct Look {
    double phase, broad_phase;   // p and p' towards the sun [1/sr]
    double down;                 // of the light that arrives: the look's zenith cosine
    std::vector<BandLight> sky;  // SkyMoments::Towards
  };
  [[nodiscard]] Look LookAlong(const glm::dvec3& look) const;

  /// Scattered per unit of scattering [1/sr]: of the sun
  /// itself and its glow in the fog, and of the sky.
  /// @param sun  what air, terrain and volumes leave of sunlight; lit: without the air, in [0, 1].
  /// @param slant_depth  of the fog towards the sun.
  struct Scattered {
    BandLight of_sun, of_sky;
  };
  [[nodiscard]] Scattered At(const Look& look, double altitude_m, const BandLight& sun,
                             const BandLight& lit, double slant_depth) const;

  /// What is left of light of the sky from above at an altitude, and of a beam after a slant depth,
  /// each with what the forward peak takes along.
  [[nodiscard]] float SkyLeft(double altitude_m) const;
  [[nodiscard]] float BeamLeft(double slant_depth) const;

  /// What the fog's own light brings to a surface [1]. @param cos_up  of its normal's zenith angle.
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
  double peak_scale_;  // of optical depths, without what the peak takes along
  SkyMoments sky_;     // without the ground
  BandLight ground_;   // radiance of the ground under a clear sky
  Glow of_sun_, of_sky_;
};

}  // namespace alpenglow::renderer
