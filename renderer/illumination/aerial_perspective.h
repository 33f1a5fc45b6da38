// SPDX-License-Identifier: MIT
// This header computes aerial perspective: the light that the air between an eye and a surface
// scatters towards the eye, and its transmittance, in every band. Terrain may shade parts of the
// ray.
//
// The ray is cut into panels at its perigee and at the planet's shadow. Each panel has N Gauss
// nodes in a mapped distance v, dense at its lower end: that of ray_map.glsl, or, if the ray ends
// in the air, that of direct integration (direct_scattering.h). With the Legendre polynomials P_n
// on [0, 1] and the sunlight S(v), in [0, 1], that terrain lets through, the weight of direct light
// at node j is the weight of the node times
//
//   sum over n < N of (2 n + 1) P_n(v_j) m_n,      m_n = integral of P_n(v) S(v) dv.
//
// This integrates S times the polynomial through the nodes. The factor is 1 in full light and
// exactly 0 in full shade. Any number of light shafts needs no additional node, and no terms of
// similar size are subtracted. Multiple scattering is evaluated at the same nodes, in the shade
// too.
//
// A panel is any stretch of a ray with a map from v in [0, 1] to the distance from the eye [m]:
//
//   begin_m, end_m       its ends
//   DistanceAt(v)        the map
//   CoordinateAt(d)      its inverse
//
// SegmentAir samples rays that end in the air, for example at a mountain, with few Gauss nodes. A
// panel has 2 to 7 nodes, depending on the haze and the length of the ray, or else 14. Columns from
// the eye are differences of columns to space. Their error is 1e-4 of the columns to space, which
// is enough for the paths from sun to eye. The last sample, which gives the transmittance of a
// short ray, integrates its columns directly.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>

#include "atmosphere/math/numerics.h"
#include "atmosphere/ray/direct_scattering.h"
#include "atmosphere/ray/single_scattering.h"
#include "lut/multiple_scattering/multiple_scattering.h"
#include "renderer/layer.h"
#include "renderer/visibility/sunlit_path.h"

namespace alpenglow::renderer {

inline constexpr int kMostShaftNodes = 16;

/// Values by node or by degree; unused entries are 0.
using ShaftNodes = std::array<double, kMostShaftNodes>;

/// Calls visit(n, P_n) for n < count at v, with Legendre polynomials on [0, 1].
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

/// Returns factors of the nodes of a Gauss rule on [0, 1] from the moments of sunlight.
/// @param nodes  in [1, kMostShaftNodes].
[[nodiscard]] ShaftNodes FactorsFromMoments(int nodes, const ShaftNodes& moments);

/// Returns the part of a piece between two distances; it has length 0 if they do not overlap.
[[nodiscard]] SunlitPiece Clipped(const SunlitPiece& piece, double begin_m, double end_m);

/// Adds the moments of a piece of sunlight that lies within the panel. Eight nodes are exact for
/// full light, and penumbrae are smooth enough for them; three are enough for a short piece, over
/// which polynomials turn less than once: their zeros at the ends are 1 / nodes^2 apart. Clouds cut
/// a ray into a hundred short pieces.
template <typename Panel>
void AddMoments(const Panel& panel, const SunlitPiece& piece, int nodes, ShaftNodes& moments) {
  static const GaussRule& many = GaussLegendre(8);
  static const GaussRule& few = GaussLegendre(3);
  constexpr double kShort = 4.0;
  const double from = panel.CoordinateAt(piece.begin_m);
  const double to = panel.CoordinateAt(piece.end_m);
  const GaussRule& rule = std::abs(to - from) * nodes * nodes < kShort ? few : many;
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

/// Returns the sunlight at the nodes of a panel, as factors of their weights.
template <typename Panel>
[[nodiscard]] ShaftNodes SunlightAtNodes(const Panel& panel, int nodes, const SunlitPath& sunlit) {
  ShaftNodes moments{};
  for (const SunlitPiece& piece : sunlit) {
    const SunlitPiece within = Clipped(piece, panel.begin_m, panel.end_m);
    if (within.length_m() > 0.0) AddMoments(panel, within, nodes, moments);
  }
  return FactorsFromMoments(nodes, moments);
}

/// Returns whether a piece in full light covers a whole panel.
template <typename Panel>
[[nodiscard]] bool LightUnbroken(const Panel& panel, const SunlitPath& sunlit) {
  return std::any_of(sunlit.begin(), sunlit.end(), [&](const SunlitPiece& piece) {
    return piece.begin_x >= 1.0 && piece.end_x >= 1.0 && piece.begin_m <= panel.begin_m &&
           piece.end_m >= panel.end_m;
  });
}

/// Samples of air along rays that end in the air. Immutable, safe to share between threads. Refers
/// to the arguments of its constructor.
class SegmentAir {
 public:
  explicit SegmentAir(const SingleScattering<float>& air);

  /// Returns the panels of a ray, including dark ones. The other functions require a ray with
  /// panels whose extent ends at its length.
  [[nodiscard]] DirectRay Place(const ViewRay& ray) const;

  /// Returns single scattering.
  /// @param sunlit  null: unbroken sunlight.
  [[nodiscard]] ScatteredOnce<float> Once(const ViewRay& ray, const DirectRay& placed,
                                          const SunlitPath* sunlit, int most_nodes) const;

  /// Returns single scattering with its samples. The last sample has no weight and lies at the end
  /// of the ray. RaySamples::lit is the sunlight factor for the panels' polynomials (see above).
  [[nodiscard]] SampledLight Sample(const ViewRay& ray, const DirectRay& placed,
                                    const SunlitPath* sunlit, int most_nodes) const;

 private:
  /// A ray with its nodes and the sunlight at them.
  struct Lit {
    DirectRay placed;
    bool unbroken;
    LaneLight light;  // not set if unbroken

    [[nodiscard]] const LaneLight* sunlight() const { return unbroken ? nullptr : &light; }
  };
  [[nodiscard]] Lit LightOf(const ViewRay& ray, const DirectRay& placed, const SunlitPath* sunlit,
                            int most_nodes) const;
  [[nodiscard]] int NodesFor(const DirectPanel& panel, bool shafts) const;
  [[nodiscard]] int NodesFor(const DirectRay& placed, bool shafts) const;
  [[nodiscard]] ColumnSet<float> ColumnsAlong(const ViewRay& ray, const DirectRay& placed) const;

  const SingleScattering<float>& air_;
  DirectScattering direct_;
  float haze_share_;  // fraction of the extinction at altitude 0, largest of any band
  float rayleigh_height_km_, mie_height_km_;
};

/// A stretch of a ray in which air gets other diffuse light than under a clear sky, for example below
/// a layer of clouds.
struct DiffuseStretch {
  double end_m;  // on the ray; the first stretch begins at the eye, others at the end of the last
  Spectrum factor;  // of the light that air scatters more than once, >= 0
};

/// Light and transmittance of the air along a ray, per unit solar irradiance.
struct AirAlongRay {
  Spectrum inscatter;      // [1/sr], all orders
  Spectrum transmittance;  // [1]
  /// Q and U of `inscatter` [1/sr], if requested.
  std::optional<PolarisedLight> polarised = std::nullopt;
};

/// Aerial perspective of one medium. Immutable, safe to share between threads. Refers to the
/// arguments of its constructor.
///
/// Error between mountains up to 100 km apart, in air of optical depth up to 0.3: below 1e-3 (root
/// mean square; 5e-4 in clear air) and 5e-3 (at worst) of single scattering, 3e-7 of transmittance.
class AerialPerspective {
 public:
  AerialPerspective(const SingleScattering<float>& air,
                    const MultipleScattering& multiple_scattering);

  /// Nodes per panel. Rays that end in the air (ViewRay::length_m) choose their number by their
  /// length and the haze.
  struct Nodes {
    int sky = 12;               // for rays that end in space or at the planet's ground, in [2, 16]
    bool higher_orders = true;  // include multiple scattering
    bool polarised = false;     // compute AirAlongRay::polarised, with the signs of PolarisedLight
    /// Cosine between the ray and the visible direction of the sun, the centre of the aureole;
    /// empty: the visible sun is in the direction from which its rays light the air, ViewRay::nu.
    std::optional<double> nu_seen = std::nullopt;
    /// Diffuse light by stretch, in order; the last one ends the ray or lies beyond. Empty: that of a
    /// clear sky. Light in the aureole, which aerosol turns by a few degrees, does not change.
    std::span<const DiffuseStretch> diffuse = {};
  };

  /// Returns the air along a ray in unbroken sunlight.
  [[nodiscard]] AirAlongRay Along(const ViewRay& ray, const Nodes& nodes) const;
  /// Returns the air along a ray that is sunlit on `sunlit`, in distances from the eye [m].
  [[nodiscard]] AirAlongRay Along(const ViewRay& ray, const SunlitPath& sunlit,
                                  const Nodes& nodes) const;

  /// Returns single scattering without phase functions. `sunlit` may be null: unbroken.
  [[nodiscard]] ScatteredOnce<float> Once(const ViewRay& ray, const SunlitPath* sunlit,
                                          const Nodes& nodes) const;

  /// Returns single scattering with its samples; the last sample has no weight and lies at the end
  /// of the ray. RaySamples::lit is the sunlight factor described above.
  [[nodiscard]] SampledLight Sample(const ViewRay& ray, const SunlitPath* sunlit,
                                    const Nodes& nodes) const;

 private:
  /// Samples rays that end in space or at the planet's own ground, or that have no length.
  [[nodiscard]] RaySamples<float> SampleWhole(const ViewRay& ray, const SunlitPath* sunlit,
                                              int nodes) const;
  /// Returns b of the map of a panel whose lower end, at altitude low_m, is at a distance from the
  /// eye.
  [[nodiscard]] double StretchOf(const ViewRay& ray, double length_m, double at_low_m,
                                 double low_m) const;
  template <typename OfSegment, typename OfWhole>
  [[nodiscard]] auto OfRay(const ViewRay& ray, const OfSegment& of_segment,
                           const OfWhole& of_whole) const;
  [[nodiscard]] AirAlongRay Sum(const SampledLight& light, const ViewRay& ray,
                                const Nodes& nodes) const;
  [[nodiscard]] PolarisedLight Polarised(const RaySamples<float>& samples, const ViewRay& ray,
                                         const ScatteredOnce<float>& once,
                                         const Nodes& nodes) const;
  /// Adds what Nodes::diffuse changes. @param light  returns a part of the light of higher orders
  ///     along sampled rays.
  template <typename Light>
  void ChangeDiffuse(const RaySamples<float>& samples, const ViewRay& ray, const Nodes& nodes,
                     const Light& light, Spectrum& sum) const;

  const SingleScattering<float>& air_;
  const MultipleScattering& multiple_scattering_;
  SegmentAir segments_;
  double rayleigh_per_m_ = 0.0, mie_per_m_ = 0.0;  // largest extinction of any band at altitude 0
};

}  // namespace alpenglow::renderer
