// SPDX-License-Identifier: MIT
// The medium of light that clouds have scattered several times: the same light with fewer collisions.
//
// Such light no longer shows details of the phase function p. With the albedo w and the Legendre
// coefficients chi_l of p, the fraction f = chi_2 of the scattered light is taken to go straight on
// (delta-Eddington: Joseph, Wiscombe and Weinman 1976, J. Atmos. Sci. 33, 2452), and the rest is a lobe
// of Henyey and Greenstein:
//
//   sigma' = (1 - f w) sigma,   w' = (1 - f) w / (1 - f w),   g' = (chi_1 - f) / (1 - f)
//
// At the last collision in the true medium, paths collect the beam of the sun that the peak has
// broadened (B of forward_peak.h). With p there, light of small angles would be lost: 6 % of all light
// after 8 collisions.
#pragma once

#include "atmosphere/medium/phase.h"
#include "renderer/cloud_light/cloud_path_tracer.h"
#include "renderer/cloud_phase/forward_peak.h"
#include "renderer/clouds/cloud_field.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Immutable; safe to use from many threads.
class CloudSimilarity {
 public:
  /// Takes the mean phase function of the field. Throws InputError for one without a forward peak.
  CloudSimilarity(const CloudField& field, const CloudScatterers& scatterers);

  /// Returns sigma' / sigma, in (0, 1].
  [[nodiscard]] double extinction_scale() const { return scale_; }
  /// Returns w'.
  [[nodiscard]] double albedo() const { return albedo_; }
  [[nodiscard]] const PhaseFunction& phase() const { return phase_; }

  /// Returns the light of a beam that the last true collision scatters, per unit of irradiance and of
  /// the albedo w [1/sr].
  /// @param to_sun  true optical depth from the collision to the sun.
  [[nodiscard]] double LastTrueSource(double cos_scattering, double to_sun) const;

 private:
  CloudSimilarity(const PhaseFunction& phase, double albedo);

  PhaseFunction phase_;
  ForwardPeak peak_;
  double scale_, albedo_;
};

}  // namespace alpenglow::renderer
