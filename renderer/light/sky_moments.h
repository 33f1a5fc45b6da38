// SPDX-License-Identifier: MIT
// Diffuse light at a place as the moments of DiffuseLight, ready to be scattered by any phase
// function:
//
//   J(look) = sum over l, m of  chi_l L_lm Y_lm(look)
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "lut/diffuse/multiple_scattering.h"
#include "renderer/ground/band_light.h"

namespace alpenglow::renderer {

/// Around one vertical, under one sun, at several altitudes. Per unit solar irradiance. Immutable.
class SkyMoments {
 public:
  /// @param up, to_sun  unit vectors. @param altitudes_m  ascending.
  SkyMoments(const DiffuseLight& diffuse, const glm::dvec3& up, const glm::dvec3& to_sun,
             std::vector<double> altitudes_m);

  [[nodiscard]] double mu_s() const { return mu_s_; }

  /// The same without light that comes evenly from below, `radiance` at all altitudes.
  [[nodiscard]] SkyMoments WithoutGround(const BandLight& radiance) const;

  /// What a phase function of these Legendre coefficients scatters into an eye that looks along
  /// `look`, at each of the altitudes [1/sr]. With all coefficients 1: the radiance from there.
  [[nodiscard]] std::vector<BandLight> Towards(const glm::dvec3& look,
                                               const std::vector<double>& chi) const;

  /// Linear between the altitudes, the end's beyond them.
  [[nodiscard]] BandLight At(const std::vector<BandLight>& of_altitudes, double altitude_m) const;

 private:
  glm::dvec3 up_, to_sun_;
  double mu_s_;
  int degree_;
  std::size_t bands_;
  std::vector<double> altitudes_m_;
  std::vector<std::vector<float>> values_;  // [altitude][moment * bands + band]
};

}  // namespace alpenglow::renderer
