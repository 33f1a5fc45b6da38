// SPDX-License-Identifier: MIT
// The light of higher orders in one grey plane-parallel layer, as a source for rays that are
// attenuated by the whole optical depth.
//
// LayerField solves the layer after delta-M: light in the forward peak of fraction f counts as not
// scattered, and depths are smaller by 1 - w f. A ray through the true layer loses that light, and
// gets it back as what the peak scatters from its own direction. With the source function J' of
// delta-M and the diffuse radiance I' of the same direction,
//
//   J = (1 - w f) J' + w f I',   dI'/dtau = (1 - w f) (I' - J')
//
// so that a ray with the source J has the radiance I'. In I', light that is scattered once out of
// the beam has the truncated phase function of delta-M, where that is positive.
//
// Values are kept at depths (i / last)^4 of the layer's.
#pragma once

#include <cstddef>
#include <vector>

#include "renderer/layer.h"
#include "renderer/layers/layer_field.h"

namespace alpenglow::renderer {

inline constexpr std::size_t kGlowNodes = 65;

/// What the solutions of all bands and sources share in one direction.
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
  [[nodiscard]] double TruncatedPhase(const LightWay& way) const;

  ScaledLayer layer_;
  double mu_s_, albedo_, of_ground_;         // of_ground: radiance
  std::vector<double> beam_;                 // after delta-M; empty for the sky
  std::vector<std::vector<double>> source_;  // [depth], of higher orders
  std::vector<LayerFluxes> fluxes_;
};

}  // namespace alpenglow::renderer
