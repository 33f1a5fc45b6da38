// SPDX-License-Identifier: MIT
// The air between an eye and what it looks at, where terrain lets the sun in: light scattered
// towards the eye and transmittance, in every band.
//
// The ray is cut into panels at its perigee and at the planet's shadow; in each, N Gauss nodes in
// the mapped distance v of ray_map.glsl, or, where the ray ends in the air, of direct integration
// (segment_air.h); both are dense at the lower end. With P_n the Legendre polynomials
// on [0, 1] and S(v) the sunlight, in [0, 1], that terrain lets through, the weight of direct light
// at node j is that of the node times
//
//   sum over n < N of (2 n + 1) P_n(v_j) m_n,      m_n = integral of P_n(v) S(v) dv:
//
// the integral of S times the polynomial that goes through the nodes. It is 1 in full light and
// exactly 0 in full shade; any number of shafts costs no further node, and nothing is subtracted
// from anything of its own size. Light scattered more than once is taken from the same nodes, in
// the shade too.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "atmosphere/ray/single_scattering.h"
#include "lut/diffuse/multiple_scattering.h"
#include "renderer/layer.h"
#include "renderer/light/segment_air.h"
#include "renderer/shadow/sunlit_path.h"

namespace alpenglow::renderer {

/// Air along a ray, per unit solar irradiance.
struct AirAlongRay {
  Bands<float> inscatter;      // [1/sr], all orders
  Bands<float> transmittance;  // [1]
  /// Q and U of `inscatter` [1/sr], where they are asked for.
  std::optional<PolarisedLight> polarised = std::nullopt;
};

/// Immutable, safe to share between threads. Refers to what it was made from.
///
/// Error between mountains up to 100 km apart, in air of optical depth up to 0.3: below 1e-3 (root
/// mean square; 5e-4 in clear air) and 5e-3 (at worst) of the light scattered once, 3e-7 of
/// transmittance.
class AerialPerspective {
 public:
  AerialPerspective(const AirIntegrator<float>& air, const DiffuseLight& diffuse);

  /// Nodes of a panel. Rays that end in the air (ViewRay::length_m) get as many as their length and
  /// the haze ask for.
  struct Nodes {
    int sky = 12;               // rays that end in space or at the planet's own ground, in [2, 16]
    bool higher_orders = true;  // light scattered more than once
    bool polarised = false;     // AirAlongRay::polarised, with the signs of PolarisedLight
    /// Cosine between the ray and where the sun is seen, about which the aureole lies; null: it is seen
    /// where its rays light the air from, ViewRay::nu.
    std::optional<double> nu_seen = std::nullopt;
  };

  /// A ray in unbroken sunlight.
  [[nodiscard]] AirAlongRay Along(const ViewRay& ray, const Nodes& nodes) const;
  /// A ray that terrain lets into the sun on `sunlit`, as distances from the eye [m].
  [[nodiscard]] AirAlongRay Along(const ViewRay& ray, const SunlitPath& sunlit,
                                  const Nodes& nodes) const;

  /// Light scattered once, without phase functions. `sunlit` may be null: unbroken.
  [[nodiscard]] ScatteredOnce<float> Once(const ViewRay& ray, const SunlitPath* sunlit,
                                          const Nodes& nodes) const;

  /// Returns that with its samples; the last one has no weight and lies at the end of the ray.
  /// RaySamples::lit is the sunlight as above.
  [[nodiscard]] SampledLight Sample(const ViewRay& ray, const SunlitPath* sunlit,
                                    const Nodes& nodes) const;

 private:
  /// Samples rays that end in space or at the planet's own ground, or that have no length.
  [[nodiscard]] RaySamples<float> SampleWhole(const ViewRay& ray, const SunlitPath* sunlit,
                                              int nodes) const;
  /// b of the map of a panel whose lower end, of altitude low_m, lies at a distance from the eye.
  [[nodiscard]] double StretchOf(const ViewRay& ray, double length_m, double at_low_m,
                                 double low_m) const;
  template <typename OfSegment, typename OfWhole>
  [[nodiscard]] auto OfRay(const ViewRay& ray, const OfSegment& of_segment,
                           const OfWhole& of_whole) const;
  [[nodiscard]] AirAlongRay Sum(const SampledLight& light, const ViewRay& ray,
                                const Nodes& nodes) const;
  [[nodiscard]] PolarisedLight Polarised(const RaySamples<float>& samples, const ViewRay& ray,
                                         const ScatteredOnce<float>& once,
                                         bool higher_orders) const;

  const AirIntegrator<float>& air_;
  const DiffuseLight& diffuse_;
  SegmentAir segments_;
  double rayleigh_per_m_ = 0.0, mie_per_m_ = 0.0;  // largest extinction of any band at altitude 0
};

}  // namespace alpenglow::renderer
