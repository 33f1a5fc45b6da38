// SPDX-License-Identifier: MIT
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

#include "renderer/light/sky_moments.h"
#include "renderer/media/local_media.h"

namespace alpenglow::renderer {

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
