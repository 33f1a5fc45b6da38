// SPDX-License-Identifier: MIT
// Light along rays in a field of clouds that is the same at every place: a plane-parallel layer.
//
// Vertical optical depths take the place of altitudes. Light of higher orders is that of discrete
// ordinates in 12 streams over black ground (layers/layer_field.h), and sunlight that is scattered once
// has the forward peak of all orders (layers/layer_beam.h):
//
//   L_1 = integral of  w (1 - f) p_eff(nu, w f (tau_s + t)) e^(-s (tau_s + t)) dt,   s = 1 - w f
//
// over the optical depth t to the eye, with the optical depth tau_s to the sun. It has 16 Gauss nodes,
// even in e^(-s (tau_s + t)). Light of higher orders between the depths a of the eye and b of the end
// of a ray is L(a) - T' L(b), with the scaled transmittance T' = e^(-s t_b).
//
// A sun below 3 degrees stands over a round planet. From above the horizontal it lights the top as a
// sun of its elevation at the place would, and from below it lights the base, dimmed by what its beam
// meets on its way there (cloud_low_sun.h). The beam is straight within the layer.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "renderer/cloud_light/cloud_gather.h"
#include "renderer/cloud_light/cloud_optics.h"
#include "renderer/cloud_light/cloud_sun_depths.h"
#include "renderer/cloud_light/cloud_tracking.h"
#include "renderer/clouds/cloud_field.h"
#include "renderer/clouds/plane_parallel_depths.h"
#include "renderer/layers/layer_beam.h"
#include "renderer/layers/layer_field.h"
#include "renderer/layers/layer_stack.h"

namespace alpenglow::renderer {

/// The layer and its light of sky and ground. Immutable; safe to use from many threads.
class PlaneParallelCloud {
 public:
  PlaneParallelCloud(const CloudField& field, const CloudOptics& optics);
  PlaneParallelCloud(const PlaneParallelCloud&) = delete;
  PlaneParallelCloud& operator=(const PlaneParallelCloud&) = delete;

  [[nodiscard]] const PlaneParallelDepths& depths() const { return depths_; }
  [[nodiscard]] const LayerStack& stack() const { return stack_; }
  [[nodiscard]] const LayerBeam& beam() const { return beam_; }
  [[nodiscard]] double albedo() const { return albedo_; }

  /// A part of a ray in the layer.
  struct Crossing {
    double begin_m, end_m;
    double from, to;      // vertical optical depths below the top
    double along = 0.0;   // optical depth of the part
    double scaled = 0.0;  // the same after delta-M
  };
  /// Returns nothing for a ray that misses the layer.
  [[nodiscard]] std::optional<Crossing> CrossingOf(const CloudRay& ray, double length_m) const;

  /// Returns the light of sky and ground, the transmittances and the mean distance.
  [[nodiscard]] CloudRayParts Unlit(const CloudRay& ray, const Crossing& crossing) const;
  /// Returns the same along a ray.
  [[nodiscard]] CloudRayParts UnlitAlong(const CloudRay& ray, double length_m) const;
  /// Returns mean fluxes for unit radiance of the sky.
  [[nodiscard]] LayerFluxes SkyAtTop() const { return sky_.Fluxes(0.0); }
  [[nodiscard]] LayerFluxes SkyAtBase() const { return sky_.Fluxes(depths_.whole()); }

 private:
  [[nodiscard]] double MeanDistance_m(const CloudRay& ray, const Crossing& crossing) const;

  PlaneParallelDepths depths_;
  double albedo_;
  LayerBeam beam_;
  LayerStack stack_;
  LayerField sky_, ground_;
};

/// The light of a sun in the layer. Immutable; safe to use from many threads. Refers to the layer.
///
/// Radiances are within 1 % (root mean square) of 48 streams with the exact first order, from 3 degrees
/// around the sun on.
class PlaneParallelSun {
 public:
  PlaneParallelSun(std::shared_ptr<const PlaneParallelCloud> cloud, const CloudSunDepths& to_sun);

  /// Returns the light along a ray. That of the sun of higher orders is in the first hat.
  [[nodiscard]] CloudRayParts Along(const CloudRay& ray, double length_m) const;
  /// Returns the light of higher orders that the layer adds along a part of a ray.
  [[nodiscard]] double HigherOrders(const CloudRay& ray,
                                    const PlaneParallelCloud::Crossing& crossing) const;

  /// Diffuse light through top and base, for unit irradiance across the beam.
  [[nodiscard]] double UpAtTop() const;
  [[nodiscard]] double DownAtBase() const;

 private:
  /// Returns a part of a ray with depths below the lit side.
  [[nodiscard]] PlaneParallelCloud::Crossing BelowLitSide(
      PlaneParallelCloud::Crossing crossing) const;
  /// Returns the cosine of the direction of light that reaches the eye, > 0 towards the lit side.
  [[nodiscard]] double MuOf(const CloudRay& ray) const {
    return is_from_below_ ? ray.direction.z : -ray.direction.z;
  }
  /// @param lit  the part, with depths below the lit side.
  void AddScatteredOnce(const CloudRay& ray, const PlaneParallelCloud::Crossing& lit,
                        CloudRayParts& parts) const;

  std::shared_ptr<const PlaneParallelCloud> cloud_;
  glm::dvec3 to_sun_;
  bool is_from_below_;
  double mu_s_;       // between the beam and the vertical, > 0
  double left_;       // of the beam where it enters
  LayerField field_;  // under a sun above the lit side
};

}  // namespace alpenglow::renderer
