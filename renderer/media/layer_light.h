// SPDX-License-Identifier: MIT
// The light that a layer over the lowest ground, such as fog, scatters to all orders under sun and
// sky. The layer is grey.
//
// Radiances follow from EddingtonSlab. The first order is exact, except for light in the forward
// peak, which is scattered by a lobe with the same mean cosine; higher orders are w (I0 + chi_1 I1
// mu). Compared with a path tracer, over layers of optical depth 0.5 to 8 with g = 0.8, the sun at
// 9 and 37 degrees and a view from outside, the relative error is 0.35 root mean square; the result
// is 0.4 to 2.5 of the value at worst (tests/renderer/media/eddington_slab_test.cpp). It
// approximates the light that single scattering omits where that is most of the light.
//
//   J = w [ p(cos) S e^-tau_s                      sun: first order
//         + p'(cos) S (e^-tau_s' - e^-tau_s)       sun: light in the forward peak
//         + sum chi_l L_lm Y_lm  e^(-tau' / 0.6)   sky: first order
//         + I0 + chi_1 I1 mu ]                     all higher orders (EddingtonSlab)
//
// with the optical depth tau_s towards the sun, tau' without the forward peak, and a lobe p' with
// the same mean cosine as p. Light that the ground reflects under a clear sky is removed from the
// moments L_lm, because the layer has its own ground.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <vector>

#include "lut/tables/table_axes.h"
#include "renderer/illumination/lighting.h"
#include "renderer/illumination/sky_moments.h"
#include "renderer/media/exponential_layer.h"

namespace alpenglow::renderer {

/// Light scattered by a layer for one position of the sun, per unit solar irradiance. Immutable.
/// Refers to the layer.
class LayerLight {
 public:
  /// @param in_air  transmittance of the air at the layer for the light, while it is above the
  ///   horizon.
  LayerLight(const ExponentialLayer& layer, const MultipleScattering& diffuse,
             const LightDirection& light, const Spectrum& in_air);

  /// Precomputed values of a ray through the layer.
  struct Look {
    double phase, broad_phase;  // p and p' towards the sun [1/sr]
    double down;                // downward cosine of the arriving light: the look's zenith cosine
    std::vector<Spectrum> sky;  // SkyMoments::Towards
  };
  [[nodiscard]] Look LookAlong(const glm::dvec3& look) const;

  /// Returns the light scattered per unit of scattering [1/sr]: from the sun with its glow in the
  /// layer, and from the sky.
  /// @param sun  transmittance of air, terrain and volumes for sunlight.
  /// @param lit  the same without the air, in [0, 1].
  /// @param slant_depth  of the layer towards the sun.
  struct Scattered {
    Spectrum of_sun, of_sky;
  };
  [[nodiscard]] Scattered At(const Look& look, double altitude_m, const Spectrum& sun,
                             const Spectrum& lit, double slant_depth) const;

  /// Returns the factor on optical depths with which light in the forward peak counts as not
  /// scattered.
  [[nodiscard]] double peak_scale() const { return peak_scale_; }
  /// Returns the transmittance of skylight from above to an altitude, with the light in the forward
  /// peak.
  [[nodiscard]] float SkyLeft(double altitude_m) const;

  /// Returns the irradiance of a surface by the layer's own light [1].
  /// @param cos_up  of its normal's zenith angle.
  [[nodiscard]] Spectrum OnSurface(double altitude_m, double cos_up) const;

 private:
  struct Glow {
    std::vector<Spectrum> mean, slope;  // at depth (i / last)^4 of the layer's [1/sr]
  };
  [[nodiscard]] double DepthAbove(double altitude_m) const;
  [[nodiscard]] AxisPosition PlaceOf(double altitude_m) const;
  [[nodiscard]] static Spectrum At(const std::vector<Spectrum>& nodes, const AxisPosition& place);
  /// Returns the diffuse light scattered at a place, at least 0.
  /// @param tilt  the mean cosine of the phase function times Look::down.
  [[nodiscard]] static Spectrum Field(const Glow& glow, const AxisPosition& place, float tilt);
  void Solve(double albedo, double mu0, const Spectrum& sun, const Spectrum& sky,
             const std::vector<double>& ground_albedo);

  const ExponentialLayer& layer_;
  glm::dvec3 to_light_;
  std::vector<double> chi_;
  PhaseFunction broad_;
  double extinction_per_m_, depth_;
  double peak_scale_;
  SkyMoments sky_;   // without the ground
  Spectrum ground_;  // radiance of the ground under a clear sky
  Glow of_sun_, of_sky_;
};

}  // namespace alpenglow::renderer
