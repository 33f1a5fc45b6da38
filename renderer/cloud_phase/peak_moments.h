// SPDX-License-Identifier: MIT
// Legendre coefficients of a phase function of clouds, and its value near the forward peak, for the
// series of forward_peak.h.
//
// The diffraction by crystals is so narrow that its series does not end at kPeakSeriesDegree, and would
// ring over all angles without a window exp(-(l / 400)^2). The window rounds off angles below 0.2
// degrees. The series of a lobe that ends before this degree needs no window.
#pragma once

#include <vector>

#include "atmosphere/medium/phase.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

inline constexpr int kPeakSeriesDegree = 1500;

/// Legendre coefficients of a phase function, and a window over their degrees.
struct PeakMoments {
  std::vector<double> chi, window;  // of the degrees 0 to kPeakSeriesDegree

  explicit PeakMoments(const PhaseFunction& phase);

  /// Returns f, the fraction of the light in the peak beyond a degree. Throws InputError unless the
  /// degree lies in [0, 16] and f in (0, 1).
  [[nodiscard]] double PeakFraction(int degree) const;
};

/// Returns the phase function [1/sr], round near the forward direction.
/// @param angle_rad  in [0, pi]. @param series  (2 l + 1) / (4 pi) P_l at the angle.
[[nodiscard]] double RoundPhase(const PhaseFunction& phase, double angle_rad,
                                const PeakMoments& moments, const std::vector<double>& series);

/// Returns the factor of w_l P_l in f p_eff that a moment of the peak has in all orders:
///
///   (e^(-x (1 - a)) - e^(-x)) / x = e^(-x (1 - a)) (1 - e^(-x a)) / x
///
/// @param a  moment of the peak, in [0, 1]. @param depth  x >= 0.
[[nodiscard]] double AllOrdersOfPeak(double a, double depth);

}  // namespace alpenglow::renderer
