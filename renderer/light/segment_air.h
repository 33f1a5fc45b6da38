// SPDX-License-Identifier: MIT
// Samples of rays that end in the air, before a mountain: few Gauss nodes, by direct integration
// (direct_scattering.h).
//
// A panel has 2 to 7 nodes, as many as the haze and the length of the way ask for, or 14. Columns
// from the eye are differences of columns to space, good to 1e-4 of those, which is enough between
// sun and eye; the last sample, from which the transmittance of a short way is seen, has them by
// integration.
#pragma once

#include "atmosphere/ray/direct_scattering.h"
#include "renderer/layer.h"
#include "renderer/shadow/sunlit_path.h"

namespace alpenglow::renderer {

/// Immutable, safe to share between threads. Refers to what it was made from.
class SegmentAir {
 public:
  explicit SegmentAir(const AirIntegrator<float>& air);

  /// The panels of a ray, dark ones too. What follows is only for rays whose extent then ends with
  /// their length, and which have panels.
  [[nodiscard]] DirectRay Place(const ViewRay& ray) const;

  /// Light scattered once.
  /// @param sunlit  null: unbroken.
  [[nodiscard]] ScatteredOnce<float> Once(const ViewRay& ray, const DirectRay& placed,
                                          const SunlitPath* sunlit, int most_nodes) const;

  /// Returns that with its samples, of which the last has no weight and lies at the end of the ray.
  /// RaySamples::lit is the sunlight that the panels' polynomials need (aerial_perspective.h).
  [[nodiscard]] SampledLight Sample(const ViewRay& ray, const DirectRay& placed,
                                    const SunlitPath* sunlit, int most_nodes) const;

 private:
  /// A ray with its nodes and the sunlight at them.
  struct Lit {
    DirectRay placed;
    bool unbroken;
    LaneLight light;  // unless unbroken

    [[nodiscard]] const LaneLight* sunlight() const { return unbroken ? nullptr : &light; }
  };
  [[nodiscard]] Lit LightOf(const ViewRay& ray, const DirectRay& placed, const SunlitPath* sunlit,
                            int most_nodes) const;
  [[nodiscard]] int NodesFor(const DirectPanel& panel, bool shafts) const;
  [[nodiscard]] int NodesFor(const DirectRay& placed, bool shafts) const;
  [[nodiscard]] ColumnSet<float> ColumnsAlong(const ViewRay& ray, const DirectRay& placed) const;

  const AirIntegrator<float>& air_;
  DirectScattering direct_;
  float haze_share_;  // of the extinction at altitude 0, largest of any band
  float rayleigh_height_km_, mie_height_km_;
};

}  // namespace alpenglow::renderer
