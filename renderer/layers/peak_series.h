// SPDX-License-Identifier: MIT
// Light that layers scatter once out of the sun's beam, with their forward peaks of all orders.
//
// Delta-M counts scattering by the peak as no scattering. Light of the peak stays near its way, so
// that n scatterings by it multiply degree l by a_l^n, with a_l = 1 for l < streams and chi_l / f
// above. Their number along the way from the sun to a point and on to the eye follows Poisson's law
// with the mean X = sum of w f tau over the layers of the way. With B_l = sum of w f tau a_l, light
// scattered at a point of the way looks as if it were scattered once by
//
//   p_eff(nu) = sum over l of (2 l + 1) / (4 pi) P_l(nu)
//               [ (chi_l - f a_l) e^(B_l - X) + f a_l (e^(B_l) - 1) / B_l e^-X ]
//
// with chi_l, f and a_l of the layer of the point: of the n scatterings of a path any one may be
// the large one, which is counted once. Without peaks, p_eff is the phase function.
#pragma once

#include <cstddef>
#include <vector>

#include "renderer/layer.h"
#include "renderer/layers/layer_stack.h"

namespace alpenglow::renderer {

/// The formula at one scattering angle. Immutable. Refers to the stack.
class PeakSeries {
 public:
  /// @param nu  cosine of the scattering angle; forward is 1.
  PeakSeries(const LayerStack& stack, double nu);

  [[nodiscard]] bool HasPeaks() const { return has_peaks_; }
  /// Returns p_eff in a layer [1/sr].
  /// @param peak_depths  w f tau along the way, for each layer.
  [[nodiscard]] double At(std::size_t layer, const std::vector<double>& peak_depths) const;

 private:
  [[nodiscard]] double InPeak(std::size_t layer, std::size_t l) const;

  const LayerStack& stack_;
  bool has_peaks_ = false;
  std::vector<double> legendre_;  // (2 l + 1) / (4 pi) P_l(nu)
};

}  // namespace alpenglow::renderer
