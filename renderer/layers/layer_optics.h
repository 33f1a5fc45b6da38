// SPDX-License-Identifier: MIT
// The optics of a homogeneous plane-parallel layer, and its medium without the forward peak.
//
// Delta-M (Wiscombe 1977, J. Atmos. Sci. 34, 1408): of the scattered light the fraction f = chi_n,
// with n the number of streams, counts as not scattered,
//
//   tau' = (1 - w f) tau,   w' = (1 - f) w / (1 - w f),   chi'_l = (chi_l - f) / (1 - f),  l < n
//
// f is at most the smallest of chi_0 ... chi_n, so that all chi'_l lie in [-1, 1]; it is 0 for a
// lobe that scatters backwards, which has no forward peak.
#pragma once

#include <string>
#include <vector>

#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Optics of one layer in one band.
struct LayerOptics {
  double optical_depth = 0.0;    // vertical, finite, >= 0
  double albedo = 1.0;           // w: scattering divided by extinction, in [0, 1]
  std::vector<double> chi{1.0};  // Legendre coefficients of the phase function: 1, chi_1, ...;
                                 // each in [-1, 1]. Further ones are 0.
};

/// Throws InputError, which has the value and its range, for other optics than those above.
/// @param name  of the layer in the message.
void RequireLayerOptics(const LayerOptics& optics, const std::string& name);

/// A layer after delta-M.
struct ScaledLayer {
  double peak = 0.0;        // f
  double scale = 1.0;       // tau' / tau = 1 - w f
  double depth = 0.0;       // tau'
  double albedo = 1.0;      // w'
  std::vector<double> chi;  // chi'_l for l < streams
};
[[nodiscard]] ScaledLayer DeltaScaled(const LayerOptics& optics, int streams);

/// Returns mixed optics of constituents of one layer: optical depths add, and phase functions are
/// weighted by optical depths of scattering. Throws InputError as above.
[[nodiscard]] LayerOptics MixedLayer(const std::vector<LayerOptics>& constituents);

}  // namespace alpenglow::renderer
