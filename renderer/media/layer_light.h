// SPDX-License-Identifier: MIT
// The light that a layer over the lowest ground, such as fog, scatters to all orders under sun and
// sky. The layer is grey.
//
// Higher orders are those of a plane layer in 8 streams (layers/layer_field.h), prepared for rays
// that are attenuated by the whole optical depth (layer_glow.h). The first order of sunlight has the
// exact phase function. Light that the forward peak has turned on its way to a point counts as light
// of the sun's own direction.
//
//   J = w [ p(cos) S e^-tau_s'        sun: first order, tau_s' without the forward peak
//         + J_sun + J_sky ]           all else (LayerGlow)
//
// In plane layers of optical depth 0.5 to 8 relative errors of radiances are below 0.03 (root mean
// square) and 0.1 for lobes with g = 0.75, and below 0.05 and 0.15 for droplets at more than 30
// degrees from the sun. Light of droplets of 14 um is up to 0.35 too dark 2 to 8 degrees from the sun
// (tests/renderer/media/layer_glow_test.cpp), and too bright within a degree. The sky over the layer
// is that on the lowest ground without the layer.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <vector>

#include "lut/tables/table_axes.h"
#include "renderer/illumination/lighting.h"
#include "renderer/illumination/sky_moments.h"
#include "renderer/media/exponential_layer.h"
#include "renderer/media/layer_glow.h"

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
    double phase;                          // p towards the sun [1/sr]
    std::vector<Spectrum> of_sun, of_sky;  // J at the nodes of LayerGlow [1/sr]
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
  /// The plane layer in one band.
  struct Band {
    LayerStack stack;
    LayerGlow of_sun, of_sky;
    double sun, sky;  // irradiance across the beam; factor of of_sky
  };

  [[nodiscard]] double DepthAbove(double altitude_m) const;
  [[nodiscard]] AxisPosition PlaceOf(double altitude_m) const;
  [[nodiscard]] static Spectrum At(const std::vector<Spectrum>& nodes, const AxisPosition& place);
  /// Returns the radiance of the sky in the direction from which light travels, for all bands.
  [[nodiscard]] Spectrum SkyFrom(const LightWay& way) const;
  [[nodiscard]] Band Solved(std::size_t band, double mu_s, double sun, double sky,
                            double ground_albedo) const;

  const ExponentialLayer& layer_;
  glm::dvec3 to_light_;
  std::vector<double> chi_;
  double extinction_per_m_, depth_, albedo_;
  double peak_scale_;
  SkyMoments sky_;      // without the ground
  Spectrum ground_;     // radiance of the ground under a clear sky
  Spectrum clear_sky_;  // irradiance of level ground under it
  std::vector<Band> bands_;
};

}  // namespace alpenglow::renderer
