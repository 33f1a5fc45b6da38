// SPDX-License-Identifier: MIT
// Sunlight at the Gauss nodes of a panel of a ray, where terrain shades parts of it: the factors
// that aerial_perspective.h describes.
//
// A panel is any stretch of a ray with a map from v in [0, 1] to the distance from the eye [m]:
//
//   begin_m, end_m       its ends
//   DistanceAt(v)        the map
//   CoordinateAt(d)      its inverse
//
// Samples of rays that end in the air, before a mountain: few Gauss nodes, by direct integration
// (direct_scattering.h).
//
// A panel has 2 to 7 nodes, as many as the haze and the length of the way ask for, or 14. Columns
// from the eye are differences of columns to space, good to 1e-4 of those, which is enough between
// sun and eye; the last sample, from which the transmittance of a short way is seen, has them by
// integration.
//
// The air between an eye and what it looks at, where terrain lets the sun in: light scattered
// towards the eye and transmittance, in every band.
//
// The ray is cut into panels at its perigee and at the planet's shadow; in each, N Gauss nodes in
// the mapped distance v of ray_map.glsl, or, where the ray ends in the air, of direct integration
// (aerial_perspective.h); both are dense at the lower end. With P_n the Legendre polynomials
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

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>

#include "atmosphere/number/numerics.h"
#include "atmosphere/ray/direct_scattering.h"
#include "atmosphere/ray/single_scattering.h"
#include "lut/diffuse/multiple_scattering.h"
#include "renderer/layer.h"
#include "renderer/shadow/sunlit_path.h"

namespace alpenglow::renderer {

inline constexpr int kMostShaftNodes = 16;

/// By node or by degree; the rest is 0.
using ShaftNodes = std::array<double, kMostShaftNodes>;

/// Calls visit(n, P_n) for n < count at v, Legendre polynomials on [0, 1].
template <typename Visit>
void VisitLegendre(int count, double v, const Visit& visit) {
  const double x = 2.0 * v - 1.0;
  double last = 0.0;
  double p = 1.0;
  for (int n = 0; n < count; ++n) {
    visit(n, p);
    const double next = ((2.0 * n + 1.0) * x * p - n * last) / (n + 1.0);
    last = p;
    p = next;
  }
}

/// Factors of the nodes of a Gauss rule on [0, 1] from the moments of sunlight.
/// @param nodes  in [1, kMostShaftNodes].
[[nodiscard]] ShaftNodes FactorsFromMoments(int nodes, const ShaftNodes& moments);

/// The part of a piece between two distances; nothing left of it has no length.
[[nodiscard]] SunlitPiece Clipped(const SunlitPiece& piece, double begin_m, double end_m);

/// Adds the moments of a piece of sunlight, which lies within the panel. Eight nodes are exact for
/// full light, and half shade is smooth.
template <typename Panel>
void AddMoments(const Panel& panel, const SunlitPiece& piece, int nodes, ShaftNodes& moments) {
  static const GaussRule& rule = GaussLegendre(8);
  const double from = panel.CoordinateAt(piece.begin_m);
  const double to = panel.CoordinateAt(piece.end_m);
  const bool full = piece.begin_x >= 1.0 && piece.end_x >= 1.0;
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    const double v = from + (to - from) * rule.node[i];
    double light = std::abs(to - from) * rule.weight[i];
    if (!full) {
      const double share = (panel.DistanceAt(v) - piece.begin_m) / piece.length_m();
      light *= SunlightOverEdge(piece.begin_x + share * (piece.end_x - piece.begin_x));
    }
    VisitLegendre(nodes, v,
                  [&](int n, double p) { moments[static_cast<std::size_t>(n)] += light * p; });
  }
}

/// Sunlight at the nodes of a panel, as factors of their weights.
template <typename Panel>
[[nodiscard]] ShaftNodes SunlightAtNodes(const Panel& panel, int nodes, const SunlitPath& sunlit) {
  ShaftNodes moments{};
  for (const SunlitPiece& piece : sunlit) {
    const SunlitPiece within = Clipped(piece, panel.begin_m, panel.end_m);
    if (within.length_m() > 0.0) AddMoments(panel, within, nodes, moments);
  }
  return FactorsFromMoments(nodes, moments);
}

/// Returns whether a piece in full light covers all of a panel.
template <typename Panel>
[[nodiscard]] bool LightUnbroken(const Panel& panel, const SunlitPath& sunlit) {
  return std::any_of(sunlit.begin(), sunlit.end(), [&](const SunlitPiece& piece) {
    return piece.begin_x >= 1.0 && piece.end_x >= 1.0 && piece.begin_m <= panel.begin_m &&
           piece.end_m >= panel.end_m;
  });
}

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
