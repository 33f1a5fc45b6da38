// SPDX-License-Identifier: MIT
// The light of higher orders in one grey plane-parallel layer, as a source for rays that are
// attenuated by the whole optical depth.
//
// LayerField solves the layer after delta-M: light in the forward peak of fraction f counts as not
// scattered, and depths are smaller by s = 1 - w f. A ray through the true layer loses that light, and
// gets it back as what the peak scatters from its own direction. With the source function J' of
// delta-M and its radiance I' in the same direction, both without the first order of sunlight,
//
//   dI'/dtau = s (I' - J') = I' - J,   J = s J' + w f I'
//
// so that a ray with the source J has the radiance I'. The first order has a source of its own, with
// the narrow peak around the sun (layer_beam.h). All else is smooth.
//
// Values are kept at depths (GlowNodes) that are dense at both ends of the layer.
#pragma once

#include <cstddef>
#include <vector>

#include "renderer/layer.h"
#include "renderer/layers/layer_field.h"

namespace alpenglow::renderer {

inline constexpr std::size_t kGlowNodes = 65;

/// Optical depths at which the light of a layer is kept:
///
///   tau(u) = t (e^(L w) - 1),   w = sin^2(pi u / 2),   L = log(1 + D / t),   t = 0.05
///
/// A low sun lights the first hundredths, and sources have steep slopes at the ground. Fog in a valley
/// can be a million deep below the mountains; deeper than D = 100, light is linear down to the ground.
class GlowNodes {
 public:
  /// @param depth  of the layer.
  explicit GlowNodes(double depth);

  [[nodiscard]] double Depth(std::size_t node) const;
  /// Returns the number of the node at a depth, with the share of the next one.
  [[nodiscard]] double NodeAt(double depth) const;

 private:
  double depth_, dense_depth_, log_;
  double last_;  // number of the node at dense_depth_
};

/// Values of one direction that the solutions of all bands and sources share.
class GlowDirection {
 public:
  /// @param stack  of one layer. @param way  in which the light travels; it counts as 1e-6 above the
  ///   horizontal if it is closer than that.
  GlowDirection(const LayerStack& stack, const LightWay& way);

 private:
  friend class LayerGlow;
  /// Factors of I' at one end of an interval, and of J' at both, in I' at the other end.
  struct Interval {
    double light, from, to;
  };
  LightWay way_;
  std::vector<double> harmonics_;    // Lambda_l^m cos(m azimuth), as SourceOfHigherOrders
  std::vector<Interval> intervals_;  // from the end at which light enters
};

/// The light of one source in a layer of one band. Immutable.
class LayerGlow {
 public:
  /// @param stack  of one layer. @param mu_s  of the sun; 0 if the source is the sky.
  LayerGlow(const LayerStack& stack, const LayerField& field, double mu_s);

  /// Returns J / w, per unit of scattering, at all depths.
  /// @param from_above  radiance of the sky in this direction; only used for light downwards.
  [[nodiscard]] std::vector<double> Towards(const GlowDirection& direction,
                                            double from_above) const;

  /// Returns the irradiances of diffuse light at all depths. The direct light is that after delta-M.
  [[nodiscard]] const std::vector<LayerFluxes>& fluxes() const { return fluxes_; }

 private:
  ScaledLayer layer_;
  double albedo_, of_ground_;                // of_ground: radiance
  std::vector<std::vector<double>> source_;  // [depth], J' by degree
  std::vector<LayerFluxes> fluxes_;
};

}  // namespace alpenglow::renderer
