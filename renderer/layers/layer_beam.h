// SPDX-License-Identifier: MIT
// Sunlight that a grey layer scatters once, with its forward peak of all orders, as a source for
// rays that are attenuated by the whole optical depth.
//
// With the fraction f of the scattered light in the peak, the optical depths tau_s to the sun and
// tau_e to the eye, and p_eff of forward_peak.h, the light along a ray is
//
//   L = integral of  w (1 - f) p_eff(nu, x) e^(-s (tau_s + tau_e)) dtau_e
//   s = 1 - w f,   x = w f (tau_s + tau_e)
//
// in the medium of delta-M (layers/layer_optics.h). A ray through the true medium loses light at the
// rate 1 instead of s, so that it needs the source
//
//   J = w (1 - f) p_eff(nu, x) e^(-s tau_s) e^((1 - s) tau_e)
//
// The last factor gives back what the peak turns by a small angle between the point and the eye. That
// light has passed the point, and whatever shades the point shades it, too. The unscattered beam is
// e^(-tau_s); p_eff has all that the peak turned, each path once.
#pragma once

#include <optional>

#include "atmosphere/medium/phase.h"
#include "renderer/cloud_phase/forward_peak.h"
#include "renderer/layer.h"
#include "renderer/layers/layer_optics.h"

namespace alpenglow::renderer {

/// Number of streams in which the light of higher orders in a layer is solved. The forward peak has
/// the Legendre coefficients from this degree on.
inline constexpr int kLayerStreams = 12;

/// Returns the optics of a layer for LayerStack.
/// @param depth  its vertical optical depth. @param albedo  in [0, 1].
[[nodiscard]] LayerOptics GreyLayer(const PhaseFunction& phase, double depth, double albedo);

/// Optical depths of a layer from a point.
struct BeamDepths {
  double to_sun, to_eye;
};

/// The first order of sunlight in a layer. Immutable; safe to use from many threads.
class LayerBeam {
 public:
  /// @param albedo  w, in [0, 1]. A phase function with f below 1e-4 counts as one without a peak.
  LayerBeam(const PhaseFunction& phase, double albedo);

  /// Returns s, the factor on optical depths with which light in the forward peak counts as not
  /// scattered.
  [[nodiscard]] double peak_scale() const { return peak_scale_; }
  /// Returns 1 - f, the fraction of the scattered light that is not in the peak.
  [[nodiscard]] double beside_peak() const { return peak_ ? 1.0 - peak_->fraction() : 1.0; }
  /// Returns x, the optical depth of the peak, for an optical depth of the layer.
  [[nodiscard]] double PeakDepth(double depth) const { return (1.0 - peak_scale_) * depth; }

  /// The phase function at one scattering angle.
  class Angle {
   public:
    /// Returns (1 - f) p_eff [1/sr].
    [[nodiscard]] double At(double peak_depth) const;

   private:
    friend class LayerBeam;
    std::optional<ForwardPeak::Angle> peak_;
    double factor_ = 0.0;  // 1 - f; without a peak, the phase function
  };
  [[nodiscard]] Angle AtAngle(double cos_scattering) const;

  /// Returns J / w [1/sr], for a beam of unit irradiance across it. Light from optical depths to the
  /// eye beyond 30 counts as from there, so that nothing overflows.
  [[nodiscard]] double Source(const Angle& angle, const BeamDepths& depths) const;

 private:
  PhaseFunction phase_;
  std::optional<ForwardPeak> peak_;
  double peak_scale_ = 1.0;
};

}  // namespace alpenglow::renderer
