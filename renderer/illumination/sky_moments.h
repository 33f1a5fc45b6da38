// SPDX-License-Identifier: MIT
// SkyMoments keeps the moments of MultipleScattering at a place, from which a phase function with
// coefficients chi_l scatters
//
//   J(look) = sum over l, m of  chi_l L_lm Y_lm(look)
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "lut/multiple_scattering/multiple_scattering.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Moments of skylight around one vertical, for one sun, at several altitudes, per unit solar
/// irradiance. Immutable.
class SkyMoments {
 public:
  /// @param up, to_light  unit vectors. @param altitudes_m  ascending.
  SkyMoments(const MultipleScattering& multiple_scattering, const glm::dvec3& up,
             const glm::dvec3& to_light, std::vector<double> altitudes_m);

  [[nodiscard]] double mu_s() const { return mu_s_; }

  /// Returns these moments without uniform light from below, `radiance` at all altitudes.
  [[nodiscard]] SkyMoments WithoutGround(const Spectrum& radiance) const;

  /// Returns the light that a phase function of these Legendre coefficients scatters into an eye
  /// that looks along `look`, at each of the altitudes [1/sr]. With all coefficients 1, it is the
  /// sky's radiance from this direction.
  [[nodiscard]] std::vector<Spectrum> Towards(const glm::dvec3& look,
                                              const std::vector<double>& chi) const;

  /// Interpolates linearly between the altitudes, and clamps to the first and last.
  [[nodiscard]] Spectrum At(const std::vector<Spectrum>& of_altitudes, double altitude_m) const;

 private:
  glm::dvec3 up_, to_light_;
  double mu_s_;
  int degree_;
  std::size_t bands_;
  std::vector<double> altitudes_m_;
  std::vector<std::vector<float>> values_;  // [altitude][moment * bands + band]
};

}  // namespace alpenglow::renderer
