// SPDX-License-Identifier: MIT
// How much light of orders two and up lies in degrees of the aerosol's phase function that
// DiffuseLight does not keep: an estimate, for those who state an error.
//
// Light that is deflected little stays near the beam, and along the way from the sun to a point and
// on to the eye its degree l grows by exp(chi_l tau), tau being the optical depth of scattering by
// aerosol along that way (small-angle approximation: Wentzel 1922; van de Hulst 1980, Multiple
// Light Scattering, ch. 14). Degrees above L therefore hold
//
//   A(nu) = integral of sigma_M T sum over l > L of (2 l + 1) / (4 pi) chi_l (exp(chi_l tau) - 1)
//           P_l(nu) ds
//
// beside what is scattered once. A alternates in sign with the angle, and real paths blur where:
// the estimate is |A| plus the envelope of its first term. 0 where no aerosol is.
#pragma once

#include <vector>

#include "atmosphere/air/medium.h"
#include "atmosphere/ray/ray_kernel.h"
#include "atmosphere/ray/ray_samples.h"
#include "lut/layer.h"

namespace alpenglow::lut {

class MissingDegrees {
 public:
  /// @param degree  the largest that is kept.
  MissingDegrees(const Medium& medium, int degree);

  /// Of samples that AirIntegrator(medium) took [1/sr], per unit solar irradiance.
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
