// SPDX-License-Identifier: MIT
// The optics of a field in the medium of its moments, by delta-M of degree 3 (forward_peak.h).
//
// With the fraction f of the forward peak, the albedo w and the moments chi_l of the phase function
//
//   sigma' = (1 - f w) sigma,   w' = (1 - f) w / (1 - f w),   chi'_l = (chi_l - f) / (1 - f)
//
// The phase function is that of the whole field: the mean over its effective radii, weighted by
// extinction. The path tracer draws it by radius.
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>
#include <vector>

#include "atmosphere/medium/phase.h"
#include "renderer/cloud_light/cloud_path_tracer.h"
#include "renderer/cloud_phase/forward_peak.h"
#include "renderer/clouds/cloud_field.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Degree of the moments of light in clouds, and their number.
inline constexpr int kCloudDegree = 3;
inline constexpr std::size_t kCloudMoments = 16;

/// Values for every real spherical harmonic, l major: 00, 1-1, 10, 11, 2-2, ...
using CloudHarmonics = std::array<float, kCloudMoments>;

/// Returns the orthonormal real harmonics of a unit vector: the sum over m of Y_lm(a) Y_lm(b) is
/// (2 l + 1) / (4 pi) P_l(a . b).
[[nodiscard]] CloudHarmonics CloudHarmonicsOf(const glm::dvec3& direction);

/// Returns the mean phase function of a field, weighted by extinction; that for 10 um if the field
/// has no cloud.
[[nodiscard]] PhaseFunction MeanCloudPhase(const CloudField& field, const CloudPhases& phases);
/// Returns the same for several wavelengths.
[[nodiscard]] std::vector<PhaseFunction> MeanCloudPhases(const CloudField& field,
                                                         const std::vector<CloudPhases>& bands);

/// Immutable; safe to use from many threads.
class CloudOptics {
 public:
  /// Throw InputError of ForwardPeak and for an albedo outside [0, 1].
  CloudOptics(const CloudField& field, const CloudScatterers& scatterers);
  CloudOptics(PhaseFunction phase, double albedo);
  /// Takes a phase function whole, without delta-M, but for a peak of a fraction that does not matter.
  /// @param peak  a phase function with such a peak.
  CloudOptics(PhaseFunction phase, const PhaseFunction& peak, double albedo);

  /// Returns the optics with another albedo. Throws InputError outside [0, 1].
  [[nodiscard]] CloudOptics WithAlbedo(double albedo) const;

  [[nodiscard]] const PhaseFunction& phase() const { return phase_; }
  [[nodiscard]] const ForwardPeak& peak() const { return peak_; }
  [[nodiscard]] double albedo() const { return albedo_; }
  /// Returns sigma' / sigma, in (0, 1].
  [[nodiscard]] double extinction_scale() const { return 1.0 - peak_.fraction() * albedo_; }
  /// Returns w'.
  [[nodiscard]] double scaled_albedo() const {
    return (1.0 - peak_.fraction()) * albedo_ / extinction_scale();
  }
  /// Returns the factors w' chi'_l Y_lm of moments of radiance in the source per unit of scaled
  /// extinction, for light scattered into a direction of travel.
  [[nodiscard]] CloudHarmonics SourceFactors(const glm::dvec3& direction) const;

 private:
  void FindFactors();

  PhaseFunction phase_;
  ForwardPeak peak_;
  double albedo_;
  std::array<float, kCloudDegree + 1> factor_{};  // w' chi'_l
};

}  // namespace alpenglow::renderer
