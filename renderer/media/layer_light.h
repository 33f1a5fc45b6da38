// SPDX-License-Identifier: MIT
// The light that a layer over the lowest ground, such as fog, scatters to all orders under sun and
// sky. The layer is grey.
//
// The first order of sunlight has the phase function with the forward peak of all orders, along the
// true way to the sun (layer_beam.h). All else is that of a plane layer in 12 streams
// (layers/layer_field.h), as a source for rays that are attenuated by the whole optical depth
// (layer_glow.h).
//
//   J = w [ J_beam(nu, tau_s, tau_e) + J_sun + J_sky ]
//
// Terrain shades J_beam and J_sun at a point.
//
// In plane layers of optical depth 0.5 to 8, with lobes of g = 0.75 and 0.85 and droplets, relative
// errors of radiances are below 0.01 (root mean square) and 0.04 (99 of 100 directions), those of the
// aureole of droplets 0.1 to 15 degrees from the sun below 0.035, and those of fluxes below 0.0015 of
// the incident flux (tests/renderer/media/layer_glow_test.cpp). MarchMedia takes a ray for opaque
// beyond the optical depth 13.9, so that e^(-13.9 s) of a deep layer's first order is missing. The sky
// over the layer is that on the lowest ground without the layer, past clouds with their mean light.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <vector>

#include "lut/tables/table_axes.h"
#include "renderer/illumination/lighting.h"
#include "renderer/illumination/sky_moments.h"
#include "renderer/media/exponential_layer.h"
#include "renderer/layers/layer_beam.h"
#include "renderer/media/layer_glow.h"
#include "renderer/media/lit_medium.h"

namespace alpenglow::renderer {

/// Light scattered by a layer for one position of the sun, per unit solar irradiance. Immutable.
/// Refers to the layer.
class LayerLight {
 public:
  /// @param in_air  transmittance of the air at the layer for the light, while it is above the
  ///   horizon. @param past  clouds, at the lowest ground.
  LayerLight(const ExponentialLayer& layer, const MultipleScattering& diffuse,
             const LightDirection& light, const Spectrum& in_air, LightPastClouds past);

  /// Precomputed values of a ray through the layer.
  struct Look {
    LayerBeam::Angle beam;
    std::vector<Spectrum> of_sun, of_sky;  // J at the nodes of LayerGlow [1/sr]
  };
  [[nodiscard]] Look LookAlong(const glm::dvec3& look) const;

  /// Returns the light of higher orders that is scattered per unit of scattering [1/sr]: from the sun
  /// without terrain and other media, and from the sky.
  struct Glow {
    Spectrum of_sun, of_sky;
  };
  [[nodiscard]] Glow GlowAt(const Look& look, double altitude_m) const;

  [[nodiscard]] const LayerBeam& beam() const { return layer_.beam(); }

  /// Returns the transmittance of skylight from above to an altitude, with the light in the forward
  /// peak.
  [[nodiscard]] float SkyLeft(double altitude_m) const;

  /// Returns the irradiance of a surface by the layer's own light [1].
  /// @param cos_up  of its normal's zenith angle.
  [[nodiscard]] Spectrum OnSurface(double altitude_m, double cos_up) const;

 private:
  /// Adds a share of the light that travels in a direction.
  void AddGlow(const LightWay& way, double share, Look& seen) const;

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
  double extinction_per_m_, depth_, albedo_;
  GlowNodes nodes_;
  SkyMoments sky_;                 // without the ground
  std::vector<double> all_of_it_;  // of each of its degrees
  Spectrum ground_;                // radiance of the ground under a clear sky
  LightPastClouds past_;
  Spectrum skylight_;  // irradiance of level ground by the sky past clouds
  std::vector<Band> bands_;
};

}  // namespace alpenglow::renderer
