// SPDX-License-Identifier: MIT
// The two-stream method of the literature for a stack of plane-parallel layers: the delta-Eddington
// approximation, beside which the report puts discrete ordinates.
//
//   I(tau, mu) = I0(tau) + I1(tau) mu                     mu > 0 downwards
//   dI1/dtau / 3 = -(1 - w) I0 + w / 4 pi  e^(-tau / mu_s)
//   dI0/dtau     = -(1 - w g) I1 + 3 w g mu_s / 4 pi  e^(-tau / mu_s)
//
// in every layer after delta-M with f = chi_2 (layer_optics.h): Joseph, Wiscombe and Weinman (1976), J.
// Atmos. Sci. 33, 2452. I0 and I1 are continuous; no diffuse light comes from above, and the ground is
// Lambertian: Shettle and Weinman (1970), J. Atmos. Sci. 27, 1048. A radiance is the integral of the
// source function w (I0 + g I1 mu) along the line of sight, with the exact phase function for light
// of the first order (TMS of Nakajima and Tanaka 1988, J. Quant. Spectrosc. Radiat. Transf. 40, 51).
#pragma once

#include <cstddef>
#include <vector>

#include "renderer/layer.h"
#include "renderer/layers/first_order.h"
#include "renderer/layers/layer_field.h"
#include "renderer/layers/layer_optics.h"

namespace alpenglow::renderer {

/// The light of one sun in a stack, for unit irradiance across its beam. Immutable.
class EddingtonStack {
 public:
  /// @param layers  from the top to the bottom. @param ground_albedo  in [0, 1].
  /// @param mu_s  cosine of the sun's zenith angle, in (0, 1].
  EddingtonStack(const std::vector<LayerOptics>& layers, double ground_albedo, double mu_s);

  /// @param depth  optical depth below the top, in [0, that of the stack].
  [[nodiscard]] LayerFluxes Fluxes(double depth) const;
  /// Returns the radiance of diffuse light [1/sr], at least 0. @param way  not horizontal.
  [[nodiscard]] double Radiance(double depth, const LightWay& way) const;

 private:
  /// A layer after delta-M, with I0 = falling e^(-k t) + rising e^(-k (T - t)) + own e^(-t / mu_s) at
  /// the depth t below its top.
  struct Layer {
    double above, scaled_above;  // optical depths of all layers above
    double scale, depth;         // of the layer: tau' / tau, T
    double albedo, g, own_once;  // w', g', and w / (1 - w f)
    double k, slope;             // and I1 of e^(-k t), relative to I0
    double own, own_slope;       // particular solution, with the beam at the top
    double falling = 0.0, rising = 0.0;
    std::vector<double> chi;
  };
  struct Field {
    double mean, slope;  // I0, I1
  };
  /// The interval of a layer on a line of sight, in depths of the whole stack after delta-M.
  struct Part {
    double from, to;
  };
  void AddLayer(const LayerOptics& optics);
  void Solve();
  [[nodiscard]] const Layer& LayerAt(double depth) const;
  [[nodiscard]] Field In(const Layer& layer, double below_top) const;
  [[nodiscard]] double InPart(const Layer& layer, const Part& part, double eye,
                              const LightWay& way) const;

  double ground_albedo_, mu_s_;
  std::vector<Layer> layers_;
};

}  // namespace alpenglow::renderer
