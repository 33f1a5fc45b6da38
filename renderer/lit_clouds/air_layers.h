// SPDX-License-Identifier: MIT
// Clear air as plane layers for discrete ordinates (layers/layer_stack.h).
//
// Ozone counts as absorbing nothing: it is above nearly all of the air that scatters light.
#pragma once

#include <cstddef>
#include <vector>

#include "atmosphere/medium/medium.h"
#include "renderer/layer.h"
#include "renderer/layers/layer_optics.h"
#include "renderer/lit_clouds/cloud_chords.h"

namespace alpenglow::renderer {

/// Air of a medium by altitude. Immutable; safe to use from many threads. Refers to the medium.
class AirLayers {
 public:
  /// @param streams  in which the layers will be solved.
  AirLayers(const Medium& medium, int streams);

  [[nodiscard]] const Medium& medium() const { return medium_; }
  [[nodiscard]] std::size_t bands() const { return medium_.rayleigh_scattering_per_m.size(); }

  /// Returns molecules and aerosol between two altitudes in one band, as one layer of their mixture.
  /// @param range_m  from at least 0; the upper altitude may be infinite.
  [[nodiscard]] LayerOptics Between(const AltitudeRange& range_m, std::size_t band) const;

  /// Returns altitudes at which to cut the air so that the mixture changes little within a layer: from
  /// 0 to the top of the air, in order.
  [[nodiscard]] std::vector<double> Cuts_m() const;

 private:
  /// Returns the column of the aerosol above an altitude, divided by its density at altitude 0 [m].
  [[nodiscard]] double AerosolColumn_m(double altitude_m) const;

  const Medium& medium_;
  std::vector<double> aerosol_chi_;  // Legendre coefficients: [degree * bands + band]
  std::size_t degrees_;
};

/// Returns, for each band, the fraction in [0, 1] of diffuse light from below that the air above an
/// altitude sends back, to all orders. For molecules without depolarisation it is within 0.005 of the
/// spherical albedo of Vermote and others (1997, IEEE Trans. Geosci. Remote Sens. 35, 675).
/// @param altitude_m  at least 0.
[[nodiscard]] std::vector<double> ReflectionOfAirAbove(const Medium& medium, double altitude_m);

}  // namespace alpenglow::renderer
